#pragma once

#include <string>
#include <string_view>

namespace lrb::render {

/// Escapes text for SVG and HTML, for elements and for quoted attributes.
std::string escape_markup(std::string_view text);

}  // namespace lrb::render

#pragma once

#include <string>
#include <string_view>

namespace lrb::render {

/// Text as it stands in SVG and HTML, in elements and in quoted attributes.
std::string escape_markup(std::string_view text);

}  // namespace lrb::render

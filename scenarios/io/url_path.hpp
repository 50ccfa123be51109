#pragma once

#include <string>

namespace lrb::io {

/// Returns a path as a relative address: what addresses do not take as it is becomes %XX.
std::string url_path(const std::string& path);

}  // namespace lrb::io

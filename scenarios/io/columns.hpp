#pragma once
/// Tables as text.

#include <cstddef>
#include <string>
#include <vector>

namespace lrb::io {

/// Returns rows as lines of columns that are two spaces apart: the first `left` aligned left, the others
/// right. The last cell of a row with more or fewer cells than the first row may exceed its column.
std::string in_columns(const std::vector<std::vector<std::string>>& rows, std::size_t left = 1);

}  // namespace lrb::io

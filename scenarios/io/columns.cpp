#include "scenarios/io/columns.hpp"

#include <algorithm>

namespace lrb::io {

std::string in_columns(const std::vector<std::vector<std::string>>& rows, std::size_t left) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i + (row.size() == rows[0].size() ? 0 : 1) < row.size(); ++i)
      widths[i] = std::max(widths[i], row[i].size());
  }
  std::string out;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string room(widths[i] - std::min(widths[i], row[i].size()), ' ');
      out += (i > 0 ? "  " : "") + (i < left ? row[i] + room : room + row[i]);
    }
    out.erase(out.find_last_not_of(' ') + 1) += "\n";
  }
  return out;
}

}  // namespace lrb::io

#include "scenarios/stability/table.hpp"

#include <algorithm>
#include <sstream>

namespace lrb::stability {
namespace {

/// Returns the first setting at which something fails, or -1.
int first_failure(const Cell& c) {
  for (int d = 0; d < kDialSettings; ++d)
    if (c.wrong[d] + c.crashed[d] + c.timed_out[d] > 0) return d;
  return -1;
}

std::string cell_text(const workers::MethodColumn& method, const Cell& c) {
  if (!method.present) return "absent";
  if (Cell::sum(c.cases) == 0) return "";
  if (c.answered() == 0) return "refused";
  std::string text = std::to_string(c.failures()) + "/" + std::to_string(c.answered());
  if (const int from = first_failure(c); from >= 0) text += " @" + std::to_string(from);
  return text;
}

using Counts = std::array<std::uint64_t, kDialSettings>;

std::string total(const Grid& grid, std::size_t method, Counts Cell::*counts) {
  std::uint64_t n = 0;
  for (std::size_t f = 0; f < grid.families.size(); ++f) n += Cell::sum(grid.at(f, method).*counts);
  return std::to_string(n);
}

std::vector<std::vector<std::string>> rows_of(const Grid& grid) {
  std::vector<std::vector<std::string>> rows(1, {"family"});
  for (const workers::MethodColumn& m : grid.methods) rows[0].push_back(m.name);
  for (std::size_t f = 0; f < grid.families.size(); ++f) {
    rows.push_back({grid.families[f].name});
    for (std::size_t m = 0; m < grid.methods.size(); ++m)
      rows.back().push_back(cell_text(grid.methods[m], grid.at(f, m)));
  }
  const std::pair<const char*, Counts Cell::*> sums[] = {{"all: wrong", &Cell::wrong},
                                                         {"all: crashed", &Cell::crashed},
                                                         {"all: timed out", &Cell::timed_out},
                                                         {"all: refused", &Cell::refused},
                                                         {"all: cases", &Cell::cases}};
  for (const auto& [name, counts] : sums) {
    rows.push_back({name});
    for (std::size_t m = 0; m < grid.methods.size(); ++m)
      rows.back().push_back(grid.methods[m].present ? total(grid, m, counts) : "absent");
  }
  return rows;
}

}  // namespace

std::string table(const Grid& grid) {
  const auto rows = rows_of(grid);
  std::vector<std::size_t> width(rows[0].size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  std::ostringstream out;
  out.exceptions(std::ios::badbit);
  for (const auto& row : rows) {
    std::string line = row[0] + std::string(width[0] - row[0].size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i)
      line += std::string(2 + width[i] - row[i].size(), ' ') + row[i];
    out << line.substr(0, line.find_last_not_of(' ') + 1) << "\n";
  }
  out << "\nIn each cell: failures/cases answered, @ the first setting of the dial (0 benign, "
      << kDialSettings - 1 << " degenerate) with a failure.\n";
  for (const workers::MethodColumn& m : grid.methods)
    out << "  " << m.name << ": " << m.title << ". " << m.remark << "\n";
  return out.str();
}

}  // namespace lrb::stability

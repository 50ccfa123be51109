#include "scenarios/stability/outcome_grid.hpp"

#include <algorithm>
#include <tuple>

namespace lrb::stability {
namespace {

/// Returns how bad a record is, for comparison.
auto badness(const Record& r) {
  const int kind = r.outcome == Outcome::crashed ? 2 : r.outcome == Outcome::timed_out ? 1 : 0;
  return std::tuple(kind, r.missed + r.extra, -r.dial);
}

void count(Cell& cell, const Record& r) {
  ++cell.cases[r.dial];
  if (r.outcome == Outcome::right) return;
  auto& counted = r.outcome == Outcome::wrong     ? cell.wrong
                  : r.outcome == Outcome::refused ? cell.refused
                  : r.outcome == Outcome::crashed ? cell.crashed
                                                  : cell.timed_out;
  ++counted[r.dial];
  if (r.outcome == Outcome::refused) return;
  if (!cell.worst || badness(r) > badness(*cell.worst)) cell.worst = r;
}

}  // namespace

Grid count_grid(std::vector<workers::MethodColumn> methods, std::vector<FamilyRow> families,
                const std::vector<Record>& records) {
  Grid grid;
  grid.methods = std::move(methods);
  grid.families = std::move(families);
  grid.cells.resize(grid.families.size() * grid.methods.size());
  for (const Record& r : records) {
    const auto family = std::find_if(grid.families.begin(), grid.families.end(),
                                     [&](const FamilyRow& f) { return f.name == r.family; });
    const auto method = std::find_if(grid.methods.begin(), grid.methods.end(),
                                     [&](const workers::MethodColumn& m) { return m.name == r.method; });
    if (family == grid.families.end() || method == grid.methods.end()) continue;
    const auto row = static_cast<std::size_t>(family - grid.families.begin());
    const auto column = static_cast<std::size_t>(method - grid.methods.begin());
    count(grid.cells[row * grid.methods.size() + column], r);
  }
  return grid;
}

std::uint64_t Cell::sum(const std::array<std::uint64_t, cases::kDialSettings>& counts) {
  std::uint64_t n = 0;
  for (const std::uint64_t c : counts) n += c;
  return n;
}

Grid present_part(const Grid& grid) {
  Grid out;
  out.families = grid.families;
  out.quantity = grid.quantity;
  out.command = grid.command;
  out.seconds = grid.seconds;
  for (const workers::MethodColumn& m : grid.methods)
    if (m.present) out.methods.push_back(m);
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    if (grid.methods[i % grid.methods.size()].present) out.cells.push_back(grid.cells[i]);
  return out;
}

std::string absent_words(const Grid& grid) {
  std::string names;
  std::size_t absent = 0;
  for (const workers::MethodColumn& m : grid.methods)
    if (!m.present) names += (absent++ > 0 ? ", " : "") + m.title;
  if (absent == 0) return {};
  return std::to_string(absent) + (absent == 1 ? " method is" : " methods are") +
         " not installed here: " + names + ".";
}

std::vector<FamilyRow> family_rows() {
  std::vector<FamilyRow> rows;
  for (const cases::Family& f : cases::all_families()) {
    rows.push_back({f.name, f.what, f.benign, f.degenerate});
    for (int d = 0; f.value != nullptr && d < kDialSettings; ++d)
      rows.back().values.push_back(f.value(cases::dial_value(d)));
  }
  return rows;
}

}  // namespace lrb::stability

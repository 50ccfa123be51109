#include "bench/stability/outcome_grid.hpp"

#include <algorithm>
#include <sstream>
#include <tuple>

#include "bench/workers/worker_json.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::stability {
namespace {

/// Returns a key that orders records by severity of their failure.
auto badness(const Record& r) {
  const int kind = r.outcome == Outcome::crashed ? 2 : r.outcome == Outcome::timed_out ? 1 : 0;
  return std::tuple(kind, r.missed + r.extra, -r.difficulty);
}

void count(Cell& cell, const Record& r) {
  ++cell.of(r.outcome)[static_cast<std::size_t>(r.difficulty)];
  if (r.outcome == Outcome::right || r.outcome == Outcome::rejected) return;
  if (!cell.worst || badness(r) > badness(*cell.worst)) cell.worst = r;
}

}  // namespace

Record with_case(Record r, const Record& of) {
  r.family = of.family;
  r.difficulty = of.difficulty;
  r.case_index = of.case_index;
  r.seed = of.seed;
  return r;
}

Grid count_grid(std::vector<methods::MethodInfo> methods, std::vector<FamilyRow> families,
                const std::vector<Record>& records) {
  Grid grid;
  grid.methods = std::move(methods);
  grid.families = std::move(families);
  grid.cells.resize(grid.families.size() * grid.methods.size());
  for (const Record& r : records) {
    const auto family = std::find_if(grid.families.begin(), grid.families.end(),
                                     [&](const FamilyRow& f) { return f.name == r.family; });
    const auto method = std::find_if(grid.methods.begin(), grid.methods.end(),
                                     [&](const methods::MethodInfo& m) { return m.name == r.method; });
    if (family == grid.families.end() || method == grid.methods.end()) continue;
    const auto row = static_cast<std::size_t>(family - grid.families.begin());
    const auto column = static_cast<std::size_t>(method - grid.methods.begin());
    count(grid.cells[row * grid.methods.size() + column], r);
  }
  return grid;
}

std::uint64_t Cell::cases(std::size_t difficulty) const {
  std::uint64_t n = 0;
  for (const Counts& c : counts) n += c[difficulty];
  return n;
}

std::uint64_t Cell::failures(std::size_t difficulty) const {
  return cases(difficulty) - of(Outcome::right)[difficulty] - of(Outcome::rejected)[difficulty];
}

std::uint64_t Cell::cases() const {
  std::uint64_t n = 0;
  for (std::size_t d = 0; d < kDifficulties; ++d) n += cases(d);
  return n;
}

std::uint64_t Cell::failures() const {
  return cases() - sum(Outcome::right) - sum(Outcome::rejected);
}

int Cell::first_failing() const {
  for (std::size_t d = 0; d < kDifficulties; ++d)
    if (failures(d) > 0) return static_cast<int>(d);
  return -1;
}

int Cell::level() const {
  if (failures() == 0) return 0;
  const double share = static_cast<double>(failures()) / static_cast<double>(answered());
  return share < 0.01 ? 1 : share < 0.1 ? 2 : share < 0.5 ? 3 : 4;
}

Cell sum_of_column(const Grid& grid, std::size_t method) {
  Cell sum;
  for (std::size_t f = 0; f < grid.families.size(); ++f)
    for (std::size_t o = 0; o < sum.counts.size(); ++o)
      for (std::size_t d = 0; d < kDifficulties; ++d) sum.counts[o][d] += grid.at(f, method).counts[o][d];
  return sum;
}

Grid present_part(const Grid& grid) {
  Grid out;
  out.families = grid.families;
  out.quantity = grid.quantity;
  out.command = grid.command;
  out.seconds = grid.seconds;
  for (const methods::MethodInfo& m : grid.methods)
    if (m.present) out.methods.push_back(m);
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    if (grid.methods[i % grid.methods.size()].present) out.cells.push_back(grid.cells[i]);
  return out;
}

std::string absent_text(const Grid& grid) {
  std::string names;
  std::size_t absent = 0;
  for (const methods::MethodInfo& m : grid.methods)
    if (!m.present) names += (absent++ > 0 ? ", " : "") + m.name;
  if (absent == 0) return {};
  return std::to_string(absent) + (absent == 1 ? " method is" : " methods are") +
         " not installed here: " + names + ".";
}

std::vector<FamilyRow> family_rows() {
  std::vector<FamilyRow> rows;
  for (const cases::Family& f : cases::all_families()) {
    rows.push_back({f.name, f.what, f.benign, f.degenerate});
    for (int d = 0; f.value != nullptr && d < kDifficulties; ++d)
      rows.back().values.push_back(f.value(cases::scaled_difficulty(d)));
  }
  return rows;
}

}  // namespace lrb::stability

namespace lrb {

template <>
inline constexpr auto kFields<stability::Record> =
    std::tuple{field("family", &stability::Record::family),
               field("method", &stability::Record::method),
               field("dial", &stability::Record::difficulty),
               field("case", &stability::Record::case_index),
               field("seed", &stability::Record::seed),
               field("outcome", &stability::Record::outcome),
               field("expected", &stability::Record::expected),
               field("missed", &stability::Record::missed),
               field("extra", &stability::Record::extra),
               field("relation", &stability::Record::relation),
               field("expected_relation", &stability::Record::expected_relation),
               field("us", &stability::Record::microseconds),
               field("message", &stability::Record::message)};
static_assert(covers_all_fields<stability::Record>);

}  // namespace lrb

namespace lrb::stability {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json to_json(const Record& r) {
  return io::record_to_json(r);
}

Record record_from(const json& value) {
  try {
    const auto r = io::record_from_json<Record>(value);
    if (r.outcome == Outcome::answered) throw InputError("expected a judged answer");
    if (r.difficulty < 0 || r.difficulty >= kDifficulties)
      throw InputError("difficulty " + std::to_string(r.difficulty) + ": expected 0 to " +
                       std::to_string(kDifficulties - 1));
    return r;
  } catch (const InputError& e) {
    throw InputError(std::string("not a record of lrbscope stability: ") + e.what());
  }
}

std::string to_lines(const std::vector<Record>& records) {
  std::string out;
  for (const Record& r : records) out += workers::line_of(to_json(r));
  return out;
}

namespace {

std::string cell_text(const methods::MethodInfo& method, const Cell& c) {
  if (!method.present) return "absent";
  if (c.cases() == 0) return "";
  if (c.answered() == 0) return "refused";
  std::string text = std::to_string(c.failures()) + "/" + std::to_string(c.answered());
  if (const int from = c.first_failing(); from >= 0) text += " @" + std::to_string(from);
  return text;
}

}  // namespace

report::Table table_of(const Grid& grid) {
  report::Table table{"", {"family"}};
  for (const methods::MethodInfo& m : grid.methods) table.columns.push_back(m.name);
  std::vector<std::vector<std::string>>& rows = table.rows;
  for (std::size_t f = 0; f < grid.families.size(); ++f) {
    rows.push_back({grid.families[f].name});
    for (std::size_t m = 0; m < grid.methods.size(); ++m)
      rows.back().push_back(cell_text(grid.methods[m], grid.at(f, m)));
  }
  const auto add_sums = [&](const std::string& name, const auto& number) {
    rows.push_back({"all: " + name});
    for (std::size_t m = 0; m < grid.methods.size(); ++m)
      rows.back().push_back(grid.methods[m].present ? std::to_string(number(sum_of_column(grid, m)))
                                                    : "absent");
  };
  for (const Outcome o : kNotRight)
    add_sums(io::in_words(name_of(o)), [o](const Cell& c) { return c.sum(o); });
  add_sums("cases", [](const Cell& c) { return c.cases(); });
  return table;
}

std::string csv_of(const Grid& grid) {
  report::Table table{
      "", {"family", "method", "difficulty", "cases", "wrong", "crashed", "timed_out", "refused"}};
  for (std::size_t f = 0; f < grid.families.size(); ++f)
    for (std::size_t m = 0; m < grid.methods.size(); ++m)
      for (std::size_t d = 0; d < kDifficulties; ++d) {
        const Cell& c = grid.at(f, m);
        if (c.cases(d) == 0) continue;
        table.rows.push_back(
            {grid.families[f].name, grid.methods[m].name, std::to_string(d), std::to_string(c.cases(d))});
        for (const Outcome o : kNotRight) table.rows.back().push_back(std::to_string(c.of(o)[d]));
      }
  return report::csv(table);
}

std::string table(const Grid& grid) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);
  out << report::in_columns(table_of(grid));
  out << "\nIn each cell: failures/cases answered, @ the lowest difficulty (0 benign, " << kDifficulties - 1
      << " degenerate) with a failure.\n";
  for (const methods::MethodInfo& m : grid.methods)
    out << "  " << m.name << ": " << m.title << ". " << m.remark << "\n";
  return out.str();
}

}  // namespace lrb::stability

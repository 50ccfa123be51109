#include "bench/stability/outcome_grid.hpp"

#include <algorithm>
#include <sstream>
#include <tuple>

#include "scenarios/io/files.hpp"
#include "trace/json_records.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::stability {
namespace {

/// Returns a key that orders records by severity of their failure.
auto badness(const Record& r) {
  const int kind = r.outcome == Outcome::crashed ? 2 : r.outcome == Outcome::timed_out ? 1 : 0;
  return std::tuple(kind, r.missed + r.extra, -r.difficulty);
}

void count(Cell& cell, const Record& r) {
  ++cell.cases[r.difficulty];
  if (r.outcome == Outcome::right) return;
  auto& counted = r.outcome == Outcome::wrong      ? cell.wrong
                  : r.outcome == Outcome::rejected ? cell.rejected
                  : r.outcome == Outcome::crashed  ? cell.crashed
                                                   : cell.timed_out;
  ++counted[r.difficulty];
  if (r.outcome == Outcome::rejected) return;
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

std::uint64_t Cell::sum(const Counts& counts) {
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

std::string absent_text(const Grid& grid) {
  std::string names;
  std::size_t absent = 0;
  for (const workers::MethodColumn& m : grid.methods)
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
  for (const Record& r : records)
    out += to_json(r).dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  return out;
}

std::vector<Record> read_records(const std::string& path) {
  std::istringstream in(io::read_text(path));
  std::vector<Record> records;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    const json value = json::parse(line, nullptr, false);
    try {
      if (value.is_discarded()) throw InputError("not JSON; expected one record per line");
      records.push_back(record_from(value));
    } catch (const InputError& e) {
      throw InputError(printable_name(path) + ":" + std::to_string(number) + ": " + e.what());
    }
  }
  return records;
}

namespace {

std::string cell_text(const workers::MethodColumn& method, const Cell& c) {
  if (!method.present) return "absent";
  if (Cell::sum(c.cases) == 0) return "";
  if (c.answered() == 0) return "refused";
  std::string text = std::to_string(c.failures()) + "/" + std::to_string(c.answered());
  if (const int from = summarise(c).first_failing; from >= 0) text += " @" + std::to_string(from);
  return text;
}

}  // namespace

report::Table table_of(const Grid& grid) {
  report::Table table{"", {"family"}};
  for (const workers::MethodColumn& m : grid.methods) table.columns.push_back(m.name);
  std::vector<std::vector<std::string>>& rows = table.rows;
  for (std::size_t f = 0; f < grid.families.size(); ++f) {
    rows.push_back({grid.families[f].name});
    for (std::size_t m = 0; m < grid.methods.size(); ++m)
      rows.back().push_back(cell_text(grid.methods[m], grid.at(f, m)));
  }
  const std::pair<const char*, Cell::Counts Cell::*> sums[] = {{"all: wrong", &Cell::wrong},
                                                               {"all: crashed", &Cell::crashed},
                                                               {"all: timed out", &Cell::timed_out},
                                                               {"all: refused", &Cell::rejected},
                                                               {"all: cases", &Cell::cases}};
  for (const auto& [name, counts] : sums) {
    rows.push_back({name});
    for (std::size_t m = 0; m < grid.methods.size(); ++m)
      rows.back().push_back(
          grid.methods[m].present ? std::to_string(Cell::sum(sum_of_column(grid, m).*counts)) : "absent");
  }
  return table;
}

std::string csv_of(const Grid& grid) {
  report::Table table{
      "", {"family", "method", "difficulty", "cases", "wrong", "crashed", "timed_out", "refused"}};
  for (std::size_t f = 0; f < grid.families.size(); ++f)
    for (std::size_t m = 0; m < grid.methods.size(); ++m)
      for (std::size_t d = 0; d < kDifficulties; ++d) {
        const Cell& c = grid.at(f, m);
        if (c.cases[d] == 0) continue;
        table.rows.push_back({grid.families[f].name, grid.methods[m].name, std::to_string(d)});
        for (const std::uint64_t n : {c.cases[d], c.wrong[d], c.crashed[d], c.timed_out[d], c.rejected[d]})
          table.rows.back().push_back(std::to_string(n));
      }
  return report::csv(table);
}

std::string table(const Grid& grid) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);
  out << report::in_columns(table_of(grid));
  out << "\nIn each cell: failures/cases answered, @ the lowest difficulty (0 benign, " << kDifficulties - 1
      << " degenerate) with a failure.\n";
  for (const workers::MethodColumn& m : grid.methods)
    out << "  " << m.name << ": " << m.title << ". " << m.remark << "\n";
  return out.str();
}

}  // namespace lrb::stability

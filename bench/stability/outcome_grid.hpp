#pragma once
/// The stability experiment: the answers of every method to every case of every family, and the grid of
/// families x methods counted from them.
///
/// The raw records (JSON Lines, one per case and method) are written first. Grid, page and pictures are
/// computed from them alone.

#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/cases/families.hpp"
#include "bench/methods/method.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/enum_names.hpp>

namespace lrb::stability {

using cases::kDifficulties;
using methods::Outcome, methods::Quantity;

/// Those of a case that is not right, in the order of tables, bars and legends.
inline constexpr std::array<Outcome, 4> kNotRight = {Outcome::wrong, Outcome::crashed, Outcome::timed_out,
                                                     Outcome::rejected};

struct FamilyRow {
  std::string name, what;
  std::string benign, degenerate;        ///< meaning of difficulties 0 and 10: "gap 1e-1", "gap 1 ulp"
  std::vector<std::string> values = {};  ///< (kDifficulties) parameter of each difficulty, "1e-6"; or empty
};

struct Record {
  std::string family, method;
  int difficulty = 0;  ///< difficulty, 0 .. kDifficulties - 1
  std::uint64_t case_index = 0, seed = 0;
  Outcome outcome = Outcome::right;
  std::uint64_t expected = 0;  ///< number of intersecting pairs, by exact brute force
  std::uint64_t missed = 0, extra = 0;
  std::string relation, expected_relation;  ///< empty: not reported by the method
  double microseconds = 0;                  ///< time of the query alone
  std::string message;                      ///< of a rejection or a crash
};

/// Returns the record with the case of another: its family, difficulty, number and seed.
Record with_case(Record r, const Record& of);

/// The results of one method on one family.
struct Cell {
  using Counts = std::array<std::uint64_t, kDifficulties>;
  std::array<Counts, kEnumNames<Outcome>.size()> counts{};  ///< by outcome and difficulty
  std::optional<Record> worst;                              ///< a failure of the lowest difficulty

  Counts& of(Outcome o) { return counts[static_cast<std::size_t>(o)]; }
  const Counts& of(Outcome o) const { return counts[static_cast<std::size_t>(o)]; }
  std::uint64_t sum(Outcome o) const { return std::accumulate(of(o).begin(), of(o).end(), std::uint64_t{0}); }
  /// Returns the number of cases at a difficulty, or at all.
  std::uint64_t cases(std::size_t difficulty) const;
  std::uint64_t cases() const;
  /// Returns the number of failures. Rejections do not count, because they give no wrong answer; they have
  /// their own mark.
  std::uint64_t failures(std::size_t difficulty) const;
  std::uint64_t failures() const;
  std::uint64_t answered() const { return cases() - sum(Outcome::rejected); }
  /// Returns the lowest difficulty with a failure, or -1.
  int first_failing() const;
  /// Returns the severity, from 0 (no failure) to 4; see kLevelNames.
  int level() const;
  bool only_rejected() const { return failures() == 0 && sum(Outcome::rejected) > 0; }
};

inline constexpr std::array<const char*, 5> kLevelNames = {"none fails", "under 1 %", "under 10 %",
                                                           "under half", "half or more"};

struct Grid {
  std::vector<methods::MethodInfo> methods;
  std::vector<FamilyRow> families;
  std::vector<Cell> cells;              ///< (|families| x |methods|), row by row
  Quantity quantity = Quantity::pairs;  ///< the queried quantity
  std::string command;                  ///< the command that produced the grid
  double seconds = 0;

  const Cell& at(std::size_t family, std::size_t method) const {
    return cells[family * methods.size() + method];
  }
};

/// Counts records. Skips records of other methods and families.
Grid count_grid(std::vector<methods::MethodInfo> methods, std::vector<FamilyRow> families,
                const std::vector<Record>& records);

/// Returns the grid without the methods that are absent from this build.
Grid present_part(const Grid& grid);
/// Returns a sentence that names the absent methods, or an empty string if none is absent.
std::string absent_text(const Grid& grid);

/// Returns the families of all_families(), in their order.
std::vector<FamilyRow> family_rows();

// Records as JSON Lines: the output of the experiment, and the source of all other results.

nlohmann::ordered_json to_json(const Record& r);
/// Reads a record. Throws InputError, which describes the error in the value, if it is invalid.
Record record_from(const nlohmann::json& value);

/// Returns the records, one per line.
std::string to_lines(const std::vector<Record>& records);

/// Returns the sum of a method's cells over all families.
Cell sum_of_column(const Grid& grid, std::size_t method);

/// Returns the grid as a table: a row per family; in each cell failures/answered and the lowest difficulty
/// with a failure.
report::Table table_of(const Grid& grid);
/// Returns that table as text, then the meaning of the columns.
std::string table(const Grid& grid);
/// Returns the counts of every family, method and difficulty as CSV.
std::string csv_of(const Grid& grid);

}  // namespace lrb::stability

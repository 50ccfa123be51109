#pragma once
/// The stability experiment: what every method answered to every case of every family, and the grid of
/// families x methods that is counted from it.
///
/// Raw records come first (JSON Lines, one for each case and method); grid, page and pictures are made from
/// nothing else.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/enum_words.hpp"
#include "engine/query/collide.hpp"
#include "scenarios/cases/families.hpp"
#include "scenarios/methods/quantity.hpp"
#include "scenarios/workers/workers.hpp"

namespace lrb::stability {

using cases::kDialSettings;
using methods::Quantity;

/// What became of one case that was put to one method.
enum class Outcome : std::uint8_t {
  right,      ///< all that the method answers is right
  wrong,      ///< pairs missed or too many, or a wrong relation
  refused,    ///< it said that it cannot answer
  crashed,    ///< its process died
  timed_out,  ///< it did not answer in time
};
constexpr auto words_of(Outcome) {
  return std::to_array<EnumWord<Outcome>>({{Outcome::right, "right"},
                                           {Outcome::wrong, "wrong"},
                                           {Outcome::refused, "refused"},
                                           {Outcome::crashed, "crashed"},
                                           {Outcome::timed_out, "timed_out"}});
}

struct FamilyRow {
  std::string name, what;
  std::string benign, degenerate;        ///< what the ends of the dial mean: "gap 1e-1", "gap 1 ulp"
  std::vector<std::string> values = {};  ///< (kDialSettings) what each setting means, "1e-6"; or empty
};

struct Record {
  std::string family, method;
  int dial = 0;  ///< 0 .. kDialSettings - 1
  std::uint64_t case_index = 0, seed = 0;
  Outcome outcome = Outcome::right;
  std::uint64_t expected = 0;  ///< number of pairs that meet, by exact brute force
  std::uint64_t missed = 0, extra = 0;
  std::string relation, expected_relation;  ///< empty: the method gives none
  double microseconds = 0;                  ///< time of the query alone
  std::string message;                      ///< of a refusal or a crash
};

/// One family put to one method.
struct Cell {
  std::array<std::uint64_t, kDialSettings> cases{}, wrong{}, refused{}, crashed{}, timed_out{};
  std::optional<Record> worst;  ///< one of those that failed, with the lowest dial setting

  static std::uint64_t sum(const std::array<std::uint64_t, kDialSettings>& counts);
  /// Returns the number of failures; refusals are none.
  std::uint64_t failures() const { return sum(wrong) + sum(crashed) + sum(timed_out); }
  /// Returns the number of cases that were not refused.
  std::uint64_t answered() const { return sum(cases) - sum(refused); }
};

struct Grid {
  std::vector<workers::MethodColumn> methods;
  std::vector<FamilyRow> families;
  std::vector<Cell> cells;              ///< (|families| x |methods|), row by row
  Quantity quantity = Quantity::pairs;  ///< what was asked for
  std::string command;                  ///< the command that made it
  double seconds = 0;

  const Cell& at(std::size_t family, std::size_t method) const {
    return cells[family * methods.size() + method];
  }
};

/// Counts records; skips those of other methods and families.
Grid count_grid(std::vector<workers::MethodColumn> methods, std::vector<FamilyRow> families,
                const std::vector<Record>& records);

/// Returns the grid without the methods that are absent from this build.
Grid present_part(const Grid& grid);
/// Names these in a sentence; empty: none is absent.
std::string absent_words(const Grid& grid);

/// Returns the families of all_families(), in their order.
std::vector<FamilyRow> family_rows();

}  // namespace lrb::stability

#pragma once
/// Shrinks a case on which a method fails to the fewest triangles and bits on which it still fails: delta
/// debugging (A. Zeller, R. Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", IEEE
/// Transactions on Software Engineering 28(2), 2002).

#include <array>
#include <cstdint>
#include <functional>

#include "bench/stability/case_meshes.hpp"
#include "bench/stability/stability_experiment.hpp"
#include <lrbscope/enum_names.hpp>

namespace lrb::stability {

/// How a method fails. A case is shrunk only to cases that fail in the same way.
enum class FailureKind : std::uint8_t {
  none,             ///< right, or rejected
  misses_crossing,  ///< misses a pair whose simplices pass through each other
  misses_touching,  ///< misses only pairs that touch: in boundaries, or in one plane
  adds,             ///< misses no pair, but returns one that does not intersect
  relation,         ///< only the relation of the bodies is wrong
  crashes,
  times_out,
};
constexpr auto enum_names(FailureKind) {
  return std::to_array<EnumName<FailureKind>>({{FailureKind::none, "none"},
                                               {FailureKind::misses_crossing, "misses_crossing"},
                                               {FailureKind::misses_touching, "misses_touching"},
                                               {FailureKind::adds, "adds"},
                                               {FailureKind::relation, "relation"},
                                               {FailureKind::crashes, "crashes"},
                                               {FailureKind::times_out, "times_out"}});
}

/// Returns how the answer to a case fails.
FailureKind failure_of(const cases::Case& c, const Replay& answer);

/// Returns the pair that shows the failure best: for missed pairs one that crosses, if there is any. Returns
/// nullopt if no pair is wrong.
std::optional<SimplexPair> failing_pair(const cases::Case& c, const Replay& answer);

/// The size of a case, in the order of importance.
struct CaseSize {
  int poses = 0;                ///< number of poses that are not the identity
  std::uint64_t simplices = 0;  ///< of both bodies
  std::uint64_t vertices = 0;   ///< of both bodies
  std::uint64_t bits = 0;       ///< sum of bits_of() over all coordinates
  double largest = 0;           ///< absolute value of a coordinate
  friend auto operator<=>(const CaseSize&, const CaseSize&) = default;
};
CaseSize size_of(const CaseMeshes& c);

/// Returns the number of bits of a number in binary notation, without leading and trailing zeros, and one for
/// a minus: 0 for 0, 1 for 1 and 1/2, 2 for 2, 3, 3/4 and -1, 54 for 2^53, 53 for 2^-53.
int bits_of(double x);

using AskCase = std::function<Replay(const CaseMeshes&)>;

struct MinimiseOptions {
  std::uint64_t max_calls = 30000;  ///< a time-out counts as kCallsOfTimeout
  /// Asks about a case without regard to earlier ones, as in a new process; null: `ask` does. A case is taken
  /// only if it fails in both: answers of some engines depend on what their memory held before.
  AskCase confirm = {};
  std::function<void(std::uint64_t calls, const CaseSize& size)> progress = {};
};
inline constexpr std::uint64_t kCallsOfTimeout = 100;

struct Minimised {
  CaseMeshes meshes;
  FailureKind kind = FailureKind::none;
  Replay answer;
  CaseSize before, after;
  std::uint64_t calls = 0;
  bool complete = false;  ///< nothing can be shrunk further; false: max_calls was reached
};

/// Shrinks a case. Throws InputError if the method does not fail on it.
Minimised minimise(const CaseMeshes& start, const AskCase& ask, const MinimiseOptions& options = {});

}  // namespace lrb::stability

#pragma once
/// The time of impact of two moving bodies: an interval of t that is proven to contain the first contact.
///
/// Contact means that the surfaces have a common point, as for collide(). A body inside another without
/// touching it is not in contact with it. The answer holds for two things at once:
/// - the exact motions, functions of real numbers (motion.hpp): the surfaces do not intersect at any real t
///   before t0;
/// - their evaluation in doubles: for no double t before t0 does collide() find a contact at Motion::at(t).
/// At t1 collide() finds one.
///
/// Algorithm:
/// 1. One traversal of the BVHs finds the pairs of simplices that can collide in a time interval; intervals
///    without such pairs are skipped.
/// 2. Each pair advances by conservative steps (conservative advancement: Mirtich, "Impulse-based Dynamic
///    Simulation", 1996): as long as a separating slab is proven to separate the two, given a bound on their
///    motion along its normal (Tang, Kim and Manocha, "C2A", 2009; motion_bounds.hpp). Steps towards a
///    contact shrink as in Newton's method.
/// 3. t0 is the minimum of the times that pairs reach. The exact query decides there.
///
/// Every search terminates. Its steps count: a time interval, a pair found in it, an advancement of a pair,
/// an exact query and each pair of simplices that it tests, a distance query and every 8 pairs that it
/// measures, every 16 pairs of nodes of either; 16 for two simplices compared in integers. With n simplices
/// in both bodies, p pieces of their motions (mean of A's and B's) and r revolutions in these, of which at
/// most 16 in a piece count, there are at most
///     (8192 + 512 n) (p + r)
/// steps, plus the cost of one exact query or distance. If a search reaches this limit, the interval is
/// reported as unresolved. Cut a motion of many revolutions along a small clearance into more pieces.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/motion.hpp>

namespace lrb {

struct FirstContactRequest {
  /// Maximum width of the interval in t, in (0, 1]. Rounding, and the spacing of doubles next to t, keep the
  /// interval wider below about 1e-14 of the bodies' sizes divided by their speed.
  double tolerance = 1e-9;
  /// Maximum number of steps; 0: only the limit above. A step searches the pairs of a time interval, advances
  /// a pair, or runs the exact query.
  std::uint64_t max_steps = 10'000'000;
  bool relation = true;  ///< determine the relation at the start for bodies that are not in contact there
  bool history = false;  ///< record FirstContactResult::history
};

enum class MotionOutcome : std::uint8_t {
  contact,
  never,      ///< proven: no contact at any t in [0, 1]
  undecided,  ///< the bodies come too close to each other to decide in doubles, or max_steps was reached
};
constexpr auto enum_names(MotionOutcome) {
  return std::to_array<EnumName<MotionOutcome>>({{MotionOutcome::contact, "contact"},
                                                 {MotionOutcome::never, "never"},
                                                 {MotionOutcome::undecided, "undecided"}});
}

/// The reason why an interval is wider than requested or undecided.
enum class Unresolved : std::uint8_t {
  nothing,   ///< it is resolved
  rounding,  ///< the distance of the bodies is within rounding
  steps,     ///< a limit on steps was reached: that of the request, or the built-in one
};
constexpr auto enum_names(Unresolved) {
  return std::to_array<EnumName<Unresolved>>(
      {{Unresolved::nothing, "nothing"}, {Unresolved::rounding, "rounding"}, {Unresolved::steps, "steps"}});
}

/// A time interval, in t.
struct TimeSpan {
  double begin = 0, end = 0;
  friend bool operator==(const TimeSpan&, const TimeSpan&) = default;
};

/// The work done by the search.
struct FirstContactCounters {
  std::uint64_t spans = 0;          ///< time intervals searched for pairs that can collide
  std::uint64_t pairs = 0;          ///< pairs found in them
  std::uint64_t steps = 0;          ///< advancements of pairs
  std::uint64_t exact_queries = 0;  ///< exact queries at one t
  friend bool operator==(const FirstContactCounters&, const FirstContactCounters&) = default;
};

struct FirstContactResult {
  MotionOutcome outcome = MotionOutcome::never;
  /// contact: no contact before t0, and contact at t1. undecided: no contact before t0 and after t1, unknown
  /// in between. never: both 1.
  double t0 = 1, t1 = 1;
  bool at_start = false;  ///< in contact at t = 0; t0 = t1 = 0
  /// The interval is wider than requested, because before t1 there are time intervals (`ambiguous`) in which
  /// the distance is within rounding and no contact was found: tangential contact.
  bool grazing = false;
  /// A contact by t1 is proven by continuity, but not at t1: the surfaces pass through each other between two
  /// adjacent doubles, as parallel sheets do.
  bool passed = false;
  bool finished = true;  ///< false: a limit on steps was reached
  Unresolved unresolved = Unresolved::nothing;
  /// The relation at the start. For bodies in contact there it is derived from the first pair found, as for
  /// Mode::any_pair. `undefined` if not requested, or for bodies that are not closed.
  Relation at_begin = Relation::undefined;
  /// The ambiguous time intervals, ascending.
  std::vector<TimeSpan> ambiguous;

  /// contact: a pair that intersects at t1 (passed: that has collided by then). kNull otherwise.
  SimplexPair pair{kNull, kNull};
  /// The closest features of the pair at t0, just before contact. At the start: the features in contact.
  std::array<Witness, 2> witness;
  /// Contact normal at the witnesses, unit length, from A to B; 0 at the start, and if rounding hides it.
  Eigen::Vector3d normal{0, 0, 0};
  /// Approach speed of the witness points along the normal, per unit of t.
  double speed = 0;

  /// If requested: time intervals in the order of the search, with the results for each.
  struct Event {
    TimeSpan span;
    /// Pairs that can collide in it; if there are too many, the number found before the search was stopped.
    std::uint64_t pairs = 0;
    double free_until = 0;  ///< no contact before this t
  };
  std::vector<Event> history;
  FirstContactCounters counters;

  bool is_contact() const { return outcome == MotionOutcome::contact; }
};

/// Returns the time of impact of bodies `a` and `b`. Throws InputError unless both are 3D or both 2D and
/// world coordinates are finite, and for an invalid request.
FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request = {});

/// Throws InputError for a request that first_contact() rejects: a tolerance outside (0, 1].
void check_request(const FirstContactRequest& request);

/// Returns the first contacts for several motions of B, in their order. The result does not depend on
/// `threads` (0: all cores).
std::vector<FirstContactResult> first_contacts(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                               std::span<const Motion> motions_b,
                                               const FirstContactRequest& request = {}, unsigned threads = 0);

// Observing a search for a first contact: derive from FirstContactProbe and pass it to first_contact(). The
// answer is the same with and without a probe. Each report takes one more distance query.

/// Bounds of a first contact after some work.
struct ContactBounds {
  std::uint64_t work = 0;  ///< sum of spans, steps and exact_queries of FirstContactCounters so far
  double t0 = 0;           ///< no contact before this, except in ambiguous intervals
  /// In contact by this time; infinite if no contact is known.
  double t1 = std::numeric_limits<double>::infinity();
  /// Bounds of the distance of the surfaces at t0, to about 1 %.
  double lower = 0, upper = 0;
  friend bool operator==(const ContactBounds&, const ContactBounds&) = default;
};

class FirstContactProbe {
 public:
  virtual ~FirstContactProbe() = default;
  /// t0 increased, or a contact or an earlier one was found. Called in the order of the work.
  virtual void bounds(const ContactBounds& known) = 0;
};

/// Records all bounds.
class FirstContactHistory final : public FirstContactProbe {
 public:
  void bounds(const ContactBounds& known) override { history.push_back(known); }
  std::vector<ContactBounds> history;
};

/// Returns the same as first_contact() without a probe, and reports the bounds while they converge.
FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request,
                                 FirstContactProbe& probe);

}  // namespace lrb

#pragma once
/// When two moving bodies first meet: an interval of t that is proved to hold the first contact.
///
/// Bodies meet where their surfaces have a point in common, as for collide(): a body that is inside another
/// without touching it does not meet it. What holds is said of two things at once:
/// - the exact motions, functions of real numbers (motion.hpp): for no real t before t0 do the surfaces meet;
/// - their doubles: for no double t before t0 does collide() find a contact at Motion::at(t).
/// At t1 collide() finds one.
///
/// Spans of time in which no pair of simplices can meet are passed in one walk of the trees
/// (pair_motion.hpp). Where there are pairs that may meet, each advances by conservative steps: as long as
/// the slab that parts the two is proved to do so for a bound on their motion along its normal
/// (pair_motion.hpp; Mirtich, "Impulse-based Dynamic Simulation", 1996, has conservative advancement; Tang,
/// Kim and Manocha, "C2A", 2009, bounds along the direction between two parts). Steps towards a contact
/// shrink as Newton's do. The least of the times that pairs come to is t0; the exact query decides what is
/// there.
///
/// Every search ends. Its steps are counted: a span, a pair that is found in it, a pair that moves, an exact
/// query and each pair of simplices that it compares, a distance and every 8 pairs that it measures, every 16
/// pairs of nodes of either; 16 for two simplices that are compared in integers. With n simplices in both
/// bodies, p pieces of their motions (the mean of A's and B's) and r turns in these, there are no more than
///     (8192 + 512 n) (p + r)
/// steps, and what one exact query or distance takes. Where they end, the interval is said to be unresolved.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/enum_words.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/motion.hpp>

namespace lrb {

struct FirstContactRequest {
  /// The widest interval, in t. More than 0, at most 1. Below about 1e-14 of the bodies' sizes divided by
  /// their speed rounding keeps the interval wider, and so do the doubles next to t.
  double tolerance = 1e-9;
  /// The largest number of steps; 0: no limit but the one above. A step looks for the pairs of a span, moves
  /// a pair, or asks the exact query.
  std::uint64_t max_steps = 10'000'000;
  bool relation = true;  ///< find out how bodies lie at the start that do not meet there
  bool history = false;  ///< write FirstContactResult::history
};

enum class MotionOutcome : std::uint8_t {
  contact,
  never,      ///< proved: they do not meet for any t from 0 to 1
  undecided,  ///< they come too near each other for doubles to tell, or max_steps were reached
};
constexpr auto words_of(MotionOutcome) {
  return std::to_array<EnumWord<MotionOutcome>>({{MotionOutcome::contact, "contact"},
                                                 {MotionOutcome::never, "never"},
                                                 {MotionOutcome::undecided, "undecided"}});
}

/// Why an interval is wider than asked, or nobody knows whether the bodies meet in it.
enum class Unresolved : std::uint8_t {
  nothing,   ///< it is not
  rounding,  ///< the bodies are as near each other as rounding
  steps,     ///< the limit on steps was reached: that of the request, or the one above
};
constexpr auto words_of(Unresolved) {
  return std::to_array<EnumWord<Unresolved>>(
      {{Unresolved::nothing, "nothing"}, {Unresolved::rounding, "rounding"}, {Unresolved::steps, "steps"}});
}

/// A span of t.
struct TimeSpan {
  double begin = 0, end = 0;
  friend bool operator==(const TimeSpan&, const TimeSpan&) = default;
};

/// The work that it took.
struct FirstContactCounters {
  std::uint64_t spans = 0;          ///< of time, for which pairs that may meet were looked for
  std::uint64_t pairs = 0;          ///< that were found there
  std::uint64_t steps = 0;          ///< in which pairs moved
  std::uint64_t exact_queries = 0;  ///< that asked whether the bodies meet at one t
  friend bool operator==(const FirstContactCounters&, const FirstContactCounters&) = default;
};

struct FirstContactResult {
  MotionOutcome outcome = MotionOutcome::never;
  /// contact: they do not meet before t0, and meet at t1. undecided: the same, but nobody knows whether they
  /// meet from t0 to t1; after t1 they do not. never: both 1.
  double t0 = 1, t1 = 1;
  bool at_start = false;  ///< they meet at t = 0, and t0 = t1 = 0
  /// The interval is wider than asked, because before t1 there are spans (`doubtful`) in which bodies are as
  /// near each other as rounding, and no contact was found: they graze.
  bool grazing = false;
  /// They have met by t1, which is proved by an argument of continuity, though not at t1: for surfaces that
  /// pass through each other in less time than there is between two doubles, as parallel sheets do.
  bool passed = false;
  bool finished = true;  ///< false: a limit on steps was reached
  Unresolved unresolved = Unresolved::nothing;
  /// How the bodies lie at the start; of bodies that meet there, what the first pair found shows, as for
  /// Mode::any_pair. `undefined` if not asked for, or for bodies that are not closed.
  Relation at_begin = Relation::undefined;
  /// The spans in which nothing is known, ascending.
  std::vector<TimeSpan> doubtful;

  /// contact: a pair that meets at t1 (passed: that has met by then); kNull: none.
  SimplexPair pair{kNull, kNull};
  /// The features of the two that are nearest at t0, just before they meet. At the start: where they meet.
  std::array<Witness, 2> witness;
  Eigen::Vector3d normal{
      0, 0, 0};  ///< there, from A to B, of length 1; 0 at the start, and where rounding hides it
  double speed =
      0;  ///< at which the witness points come nearer to each other along the normal, per unit of t

  /// If asked for: spans in the order in which they were looked at, and what is known since.
  struct Event {
    TimeSpan span;
    std::uint64_t pairs =
        0;                  ///< that may meet in it; if there are too many, as many as were found until then
    double free_until = 0;  ///< no contact before this
  };
  std::vector<Event> history;
  FirstContactCounters counters;

  bool is_contact() const { return outcome == MotionOutcome::contact; }
};

/// Returns when bodies `a` and `b` first meet; both must be 3D, or both 2D, and world coordinates finite.
/// Throws InputError for these, and for a request that cannot be answered.
FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request = {});

/// Throws InputError for a request that first_contact() rejects: a tolerance that is not in (0, 1].
void check_request(const FirstContactRequest& request);

/// Returns the first contacts for some motions of B, in their order; the same for any number of threads (0:
/// all cores).
std::vector<FirstContactResult> first_contacts(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                               std::span<const Motion> motions_b,
                                               const FirstContactRequest& request = {}, unsigned threads = 0);

// Watching a search for a first contact, from outside the engine: derive from FirstContactProbe and give it
// to first_contact(). The answer is the same as without; each time something is told the distance of the
// bodies is measured once more.

/// What is known of a first contact after some work.
struct ContactBounds {
  std::uint64_t work = 0;  ///< the sum of FirstContactCounters' spans, steps and exact_queries until then
  double t0 = 0;           ///< the bodies do not meet before, but in what is doubtful
  double t1 =
      std::numeric_limits<double>::infinity();  ///< they have met by then; infinite: no contact is known
  double lower = 0,
         upper = 0;  ///< hold the distance of the surfaces at t0, to about a hundredth of it
  friend bool operator==(const ContactBounds&, const ContactBounds&) = default;
};

class FirstContactProbe {
 public:
  virtual ~FirstContactProbe() = default;
  /// t0 rose, or a contact was found, or an earlier one than before: in the order of the work.
  virtual void bounds(const ContactBounds& known) = 0;
};

/// Keeps what it is told.
class FirstContactCourse final : public FirstContactProbe {
 public:
  void bounds(const ContactBounds& known) override { course.push_back(known); }
  std::vector<ContactBounds> course;
};

/// Does what first_contact() in first_contact.hpp does, and tells the probe what is known, after more and
/// more work.
FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request,
                                 FirstContactProbe& probe);

}  // namespace lrb

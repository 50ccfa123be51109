#pragma once
/// One search for a first contact, with reusable buffers. Internal: users of the installed engine include
/// first_contact.hpp.

#include <limits>
#include <optional>
#include <vector>

#include "engine/distance/distance_context.hpp"
#include "engine/motion/motion_bounds.hpp"
#include <lrbscope/first_contact.hpp>

namespace lrb {

/// Number of node pairs that count as one step, and number of steps that one exact test counts as.
inline constexpr std::uint64_t kNodePairsOfStep = 16, kStepsOfExact = 16;

/// Buffers of a search; one for each thread.
struct FirstContactContext {
  DistanceContext distance;
  std::vector<SimplexPair> pairs, stuck;
};

/// Finds the first contact as first_contact() in first_contact.hpp does. probe: null, or notified of bounds.
FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request,
                                 FirstContactContext& context, FirstContactProbe* probe = nullptr);

/// One search. The bodies are proven separate from 0 to free_until_, except in the intervals of `ambiguous`.
class FirstContactSearch {
 public:
  FirstContactSearch(const LrbRep& a, const Motion& motion_a, const LrbRep& b, const Motion& motion_b,
                     const FirstContactRequest& request, FirstContactContext& context,
                     FirstContactProbe* probe);
  FirstContactResult run();

 private:
  QueryContext& query() { return context_.distance.query; }
  bool is_over() const { return is_done_ || is_spent() || is_out_of_steps(); }
  bool is_spent() const { return spent_ >= most_; }
  /// Returns true if the search has taken many steps, and many for each pair, so that more expensive but
  /// longer steps are worth their cost.
  bool is_long() const {
    const FirstContactCounters& c = result_.counters;
    return c.steps > most_ / 8 && c.steps > 8 * c.pairs;
  }
  bool is_out_of_steps() const;
  std::optional<SimplexPair> meets_at(double t);
  bool meets_at_start();
  void write_start(SimplexPair pair);
  bool find_pairs(TimeSpan span, std::uint64_t most);

  void search_piece(const MovingBody& a, const MovingBody& b, double end);
  void search_swept(double end);
  void search_by_distance(double end);
  double rejected_by_distance(double t);
  bool suits_all_pairs() const;
  double advance(SimplexPair pair, const PieceState& at_a, const PieceState& at_b, TimeSpan span,
                 double least);
  double advance_all(TimeSpan span, double least);
  double look_closer(double t, double end);
  bool meets_right_after(TimeSpan span);
  double advance_stuck(TimeSpan span);
  double look_further(double t, double end);
  bool goes_on_from(TimeSpan span);
  TimeSpan shortened(TimeSpan span, double too_short);
  bool has_passed(TimeSpan span);
  bool found_between(TimeSpan span);
  void contact_at_last(TimeSpan span, SimplexPair pair);
  void contact_in(TimeSpan span, SimplexPair pair);
  void doubt(TimeSpan span);
  void write_features(double t, SimplexPair pair);
  double step_tolerance() const;
  std::uint64_t work() const;
  void notify(double t0, double t1 = std::numeric_limits<double>::infinity());
  FirstContactResult finish();

  const LrbRep* rep_[2];
  const Motion* motion_[2];
  const FirstContactRequest& request_;
  FirstContactContext& context_;
  FirstContactProbe* probe_;
  ContactBounds reported_;                  ///< last reported bounds
  std::optional<DistanceContext> to_tell_;  ///< buffers for the reported distances
  FirstContactResult result_;
  const MovingBody *a_ = nullptr, *b_ = nullptr;  ///< in the current piece
  double free_until_ = 0;
  Eigen::Vector3d hint_{0, 0, 0};  ///< the last direction that separated a pair
  bool is_swept_ = true;           ///< sweeps find the pairs; otherwise advance by distances
  bool is_done_ = false;
  double tolerance_;                    ///< the request's, but at least the resolution of doubles
  std::uint64_t spent_ = 0, most_ = 0;  ///< steps as counted by first_contact.hpp, and their maximum
};

}  // namespace lrb

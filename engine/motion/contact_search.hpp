#pragma once
/// One search for a first contact, with memory that the next one can use again: for code of ours. Users of
/// the installed engine have first_contact.hpp.

#include <limits>
#include <optional>
#include <vector>

#include "engine/distance/distance_context.hpp"
#include "engine/motion/pair_motion.hpp"
#include <lrbscope/first_contact.hpp>

namespace lrb {

/// Pairs of nodes that count as one step, and steps that one comparison in integers counts as.
inline constexpr std::uint64_t kNodePairsOfStep = 16, kStepsOfExact = 16;

/// Memory of a search; one for each thread.
struct FirstContactContext {
  DistanceContext distance;
  std::vector<SimplexPair> pairs, stuck;
};

/// Answers as first_contact() in first_contact.hpp does. probe: null, or told what is known.
FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request,
                                 FirstContactContext& context, FirstContactProbe* probe = nullptr);

/// One search. free_until(): the bodies are proved not to meet from 0 to there, but in what is doubtful.
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
  /// Returns true if so many steps were taken, and so many of each pair, that longer ones are worth their
  /// while.
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
  double parted_by_distance(double t);
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
  void tell(double t0, double t1 = std::numeric_limits<double>::infinity());
  FirstContactResult finish();

  const LrbRep* rep_[2];
  const Motion* motion_[2];
  const FirstContactRequest& request_;
  FirstContactContext& context_;
  FirstContactProbe* probe_;
  ContactBounds told_;                      ///< last
  std::optional<DistanceContext> to_tell_;  ///< memory of the distances that are told
  FirstContactResult result_;
  const MovingBody *a_ = nullptr, *b_ = nullptr;  ///< in the piece that is searched
  double free_until_ = 0;
  Eigen::Vector3d hint_{0, 0, 0};  ///< the direction that parted a pair last
  bool is_swept_ = true;           ///< sweeps find the pairs; else distances tell how long there are none
  bool is_done_ = false;
  double tolerance_;                    ///< the request's, but no less than doubles can resolve
  std::uint64_t spent_ = 0, most_ = 0;  ///< steps as first_contact.hpp counts them, and the most there may be
};

}  // namespace lrb

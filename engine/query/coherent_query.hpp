#pragma once
/// Two bodies again and again, as they move by little from one query to the next (the paper's future work).
///
/// Kept from one query to the next: the wrappers, and a list of the pairs of simplices that were not proved
/// further apart than a margin at one pose. While no point of B is further than that margin from where it was
/// then, seen from A, no other pair can meet. Of the list, those pairs are tested that were no further apart
/// than B has moved since: eight at a time in float arithmetic, exactly where that is not certain.
///
/// While B keeps its course, seen from A, a list is made for where it will be some steps ahead: then it
/// serves on the way there and beyond. What moved means, and what it allows for, is in course.hpp. Matrices
/// further from rotations than kRigid are queried from scratch.
///
/// The answers are those of collide(): pairs, meets and relation always; what was opened, and the counters,
/// tell of this query's own work. In first_pair mode it may be another pair; in any_pair mode, too, and the
/// relation, which is what that one pair tells, another with it. All requests that are not plain
/// (paper's recursions, floating predicates, coarse queries, separation) are passed on to collide().

#include "engine/query/collide.hpp"
#include "engine/query/course.hpp"
#include "engine/query/near_pairs.hpp"
#include "engine/query/query_context.hpp"

namespace lrb {

class CoherentQuery {
 public:
  /// When lists are made: where they turned out to be faster than queries from scratch, by the clock; or
  /// whenever it can be done (for tests). The answers do not depend on it.
  enum class Lists : std::uint8_t { as_it_pays, always };

  /// Keeps references to the bodies, which must outlive it.
  CoherentQuery(const LrbRep& a, const LrbRep& b, const CollideRequest& request = {},
                Lists lists = Lists::as_it_pays);

  /// The answer for these poses, good until the next call. Throws InputError as collide() does.
  const CollideResult& collide(const Pose& pose_a, const Pose& pose_b);

  /// What it has done so far.
  struct Statistics {
    std::uint64_t from_list = 0;     ///< queries answered from the list as it was
    std::uint64_t lists_made = 0;    ///< queries that made a new one
    std::uint64_t from_scratch = 0;  ///< queries as if there had been none before
    std::uint64_t tests_saved = 0;   ///< pairs of the list that needed no test
  };
  const Statistics& statistics() const { return statistics_; }

 private:
  void answer(const Pose& pose_a, const Pose& pose_b);
  void query_from_scratch();
  void time_scratch();
  bool still_crosses();
  bool make_list();
  void answer_from_list(const TreeKernel& k, double moved);
  void list_answer();
  void show_opened();
  void note_step(double step);
  bool list_pays();

  const LrbRep &a_, &b_;
  CollideRequest request_;
  Lists lists_;
  QueryContext context_;
  CollideResult result_;
  Statistics statistics_;
  bool plain_;  ///< the request is one that a list can answer
  Course course_;

  bool at_work_ = false;   ///< a call has begun and not ended
  double usual_step_ = 0;  ///< the longest of late, but for jumps
  bool jumped_ = false;

  bool has_list_ = false;
  RelativePose list_at_;     ///< the pose for which it was made
  double valid_to_ = 0;      ///< it is complete while B is no further from there
  NearPairs near_;           ///< the list
  std::size_t tested_ = 0;   ///< of the list, in the last query from it
  bool has_answer_ = false;  ///< result_ holds the answer of the last query from this list

  double steps_a_list_ = 8, ceiling_ = 64;    ///< aimed at, and at most
  bool last_paid_ = false;                    ///< the list before the one at hand
  double list_time_ = 0, step_time_ = 0;      ///< seconds: for the list, and for the steps since
  double scratch_time_ = 0;                   ///< of a query from scratch, the last one
  std::uint64_t scratch_tests_ = 0;           ///< its face tests
  bool gave_up_ = false;                      ///< the list became too long
  std::uint32_t steps_ = 0;                   ///< since the list was made
  double too_long_ = 0;                       ///< a step for which a list did not pay
  std::uint32_t pause_ = 0, next_pause_ = 4;  ///< queries from scratch before the next list is tried
  std::uint32_t pauses_ = 0;                  ///< since the last try
};

}  // namespace lrb

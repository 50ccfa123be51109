#pragma once
/// Two bodies again and again, as they move by little from one query to the next (the paper's future work).
///
/// Kept from one query to the next: the wrappers, and a list of the pairs of simplices that were not proved
/// further apart than a margin at one pose. While no point of B is further than that margin from where it was
/// then, seen from A, no other pair can meet. Of the list, those pairs are tested that were no further apart
/// than B has moved since: eight at a time in float arithmetic, exactly where that is not certain.
///
/// Motion. With (m, t) as in set_up_kernel() the points of B, on A's axes, are m x + t. From one pose to the
/// next they move by at most |dm c + dt| + |dm| R, where c and R are the middle and radius of B. |dm|^2 is
/// half the sum of the squares of dm's entries, both m being rotations. Rounding of world coordinates and of
/// all this is covered by wrapper_margin(), taken off every gap and added to every motion. Matrices that are
/// further from rotations than rounding (kRigid) are queried from scratch.
///
/// The answers are those of collide(): pairs, meets and relation always; what was opened, and the counters,
/// tell of this query's own work. In first_pair mode it may be another pair; in any_pair mode, too, and the
/// relation, which is what that one pair tells, another with it. All requests that are not plain
/// (paper's recursions, floating predicates, coarse queries, separation) are passed on to collide().

#include "engine/query/collide.hpp"
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
  /// B seen from A.
  struct Relative {
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    Eigen::Vector3d t = Eigen::Vector3d::Zero();
  };
  void answer(const Pose& pose_a, const Pose& pose_b);
  bool is_rigid(const Pose& pose_a, const Pose& pose_b) const;
  double motion(const Relative& from, const Relative& to) const;
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
  bool plain_;                       ///< the request is one that a list can answer
  Eigen::Vector3d middle_{0, 0, 0};  ///< of B
  double radius_ = 0;                ///< of B about it

  bool at_work_ = false;  ///< a call has begun and not ended
  bool has_last_ = false;
  Relative last_;
  double usual_step_ = 0;  ///< the longest of late, but for jumps
  bool jumped_ = false;
  double rounding_ = 0;  ///< wrapper_margin() of the query at hand

  bool has_list_ = false;
  Relative list_at_;         ///< the pose at which it was made
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

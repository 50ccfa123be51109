#pragma once
/// The candidate cache: the pairs of simplices that may intersect along a sweep of B, or near a fixed pose
/// (cf. Verlet's neighbour lists). At a pose in that range only some of them are tested, eight at a time:
/// along a sweep the pairs that may intersect at that position, near a fixed pose the pairs no further apart
/// than B has moved from it.

#include <bit>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/collide/pair_order.hpp"
#include "engine/collide/relative_motion.hpp"
#include "engine/tree/tree_kernel.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb {

// Decides when a coherent query makes a candidate cache, and for how many steps, from measured times: the
// cost of caches against the cost of queries from scratch. The answers do not depend on it.

class CachePolicy {
 public:
  /// The range of a cache: a sweep of B, or the neighbourhood of a fixed pose. The number of steps is tuned
  /// for each kind separately.
  enum class Kind : std::uint8_t { swept, fixed };

  /// Starts a query. Returns true during a pause after caches that did not pay, when B's motion need not be
  /// tracked. Returns false for the last few queries of a pause, because a cache can be made only once the
  /// motion is known.
  bool rests();
  /// Returns true during a pause: the query must be answered from scratch.
  bool must_wait() const { return pause_ > 0; }

  struct Plan {
    Kind kind;
    double steps;  ///< number of steps for which the cache is made
  };
  /// Returns the cache to make now, or nullopt if none would pay, given the cost of the last one. is_steady:
  /// see RelativeMotion::is_kept(). step: displacement of B per query; radius: of B; both in mesh units.
  std::optional<Plan> next(bool is_steady, double step, double radius);
  /// Number of steps of the first caches, before it is tuned.
  static constexpr double kFirstSteps = 8;

  /// Returns the time limit for making a cache, in seconds.
  double time_limit() const;

  // Report the time of an entire query in seconds: one from scratch, one that made a cache, one answered from
  // it.
  void scratch_took(double time);
  void build_took(Kind kind, double time);
  void step_took(double time);
  /// Ignores the cost of the last cache, because it ended for other reasons than its length. Applies at most
  /// once until the next cache is rated.
  void forgive() {
    if (!std::exchange(forgave_, true)) build_time_ = 0;
  }

 private:
  struct Aim {
    double steps = kFirstSteps;
    double cost = 0;  ///< recent cost per query, relative to a query from scratch; 0: unknown
    /// The next cache is for more steps while that makes queries faster; else for fewer.
    bool is_growing = true;
  };
  Aim& aim(Kind kind) { return aim_[static_cast<int>(kind)]; }
  double cost() const;  ///< cost of a query with the current cache, relative to a query from scratch
  double growth(Aim& used, double now) const;
  void take_stock();
  void rest();

  Aim aim_[2] = {{}, {.cost = 0.6}};       ///< fixed caches are tried if swept ones cost more than this
  bool has_memory_ = false;                ///< a cache was made before
  Kind kind_ = Kind::swept;                ///< kind of the current cache
  double build_time_ = 0, step_time_ = 0;  ///< time to make it, and total time of the steps since
  std::uint32_t steps_ = 0;                ///< number of these steps
  double scratch_time_ = 0;
  bool is_fresh_ = false;                     ///< scratch_time_ is newer than the cache
  bool forgave_ = false;                      ///< forgive() was called since the last take_stock()
  std::uint32_t failures_ = 0;                ///< number of successive caches that did not pay
  double too_long_ = 0;                       ///< a step length for which a cache did not pay, mesh units
  std::uint32_t pause_ = 0, next_pause_ = 4;  ///< queries from scratch before the next attempt
  std::uint32_t pauses_ = 0;                  ///< number of pauses since the last attempt
};

/// The simplices of one body that occur in cached pairs.
class CandidateSimplices {
 public:
  void begin(const LrbRep& rep, double unit);
  /// Returns the index of a simplex in data(); writes it there if it is new.
  std::uint32_t place_of(SimplexId s);
  const CachedSimplex* data() const { return written_.data(); }

  /// Returns the origin of their frame, one of their corners; query units.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// Returns the radius of a ball about the origin that contains all first corners; query units.
  float radius() const;

 private:
  void write(SimplexId s);

  struct Slot {
    std::uint32_t epoch = 0, place = 0;
  };
  const LrbRep* rep_ = nullptr;
  double per_unit_ = 1;
  std::vector<Slot> slots_;  ///< (simplices of the body) valid if `epoch` is the current one
  std::uint32_t epoch_ = 0;
  std::vector<CachedSimplex> written_;
  Eigen::Vector3d origin_{0, 0, 0};
  double farthest_sq_ = 0;
};

/// Extends a kernel that is set up at the middle of a sweep so that it finds all pairs that may intersect in
/// the sweep. `rounding`: bound for world coordinates; `unit`: the query's; both in mesh units.
void aim_at(const Sweep& sweep, double rounding, double unit, TreeKernel& k);

class CandidateCache {
 public:
  void clear() { pairs_.clear(); }
  void add(SimplexPair p) { pairs_.push_back(p); }
  /// Returns the pairs, which are ascending after arrange().
  const std::vector<SimplexPair>& pairs() const { return pairs_; }

  /// Sorts the added pairs, which must include every pair that may intersect in the sweep, and drops those
  /// that prove disjoint throughout. `k`: the kernel that found them, set up at the middle of the sweep.
  /// `rounding`: bound for world coordinates, mesh units.
  void arrange(const LrbRep& a, const LrbRep& b, const TreeKernel& k, const Sweep& sweep, double rounding,
               PairOrder& order);

  /// Selects the pairs that may intersect with B at this position in the sweep. Returns their number.
  std::size_t choose(const SweepPoint& where);

  /// Returns true if no pair can intersect on the path between two positions in the sweep.
  bool none_between(const SweepPoint& current, const SweepPoint& there) const;

  /// An observer of update() that ignores all events.
  struct Unseen {
    void operator()(SimplexPair, exact::Meet, bool) const {}
  };
  /// Determines the Meet of each chosen pair at the pose of k; all other pairs are disjoint. Calls
  /// exact(pair) where floats do not decide, and visit(pair, meet, is_certain) for each chosen pair, in
  /// order. Returns true if the set of intersecting pairs or a Meet changed since the last update.
  template <class Exact, class Visit = Unseen>
  bool update(const TreeKernel& k, Exact&& exact, Visit&& visit = {});

  /// Appends the intersecting pairs, ascending.
  void append_meeting(CollideResult& result) const;

 private:
  struct Meeting {
    std::uint32_t pair;
    exact::Meet meet;
    friend bool operator==(const Meeting&, const Meeting&) = default;
  };
  void place_pairs(const LrbRep& a, const LrbRep& b);
  void find_spans(const TreeKernel& k, const Sweep& sweep);
  template <class Keep>
  void drop_unless(Keep&& keep);
  float length_of(double distance) const;
  float position_of(const SweepPoint& where) const;
  float span_rounding() const { return is_swept_ ? kSpanRounding : 0; }
  PairKernel kernel_at(const TreeKernel& k, const std::vector<CachedPair>& pairs) const;

  /// Interval ends of a sweep lie between -1 and 1, and are rounded by 2^-20 near these limits.
  static constexpr float kSpanRounding = 0x1p-16f;

  CandidateSimplices of_[2];
  std::vector<SimplexPair> pairs_;
  std::vector<CachedPair> places_;  ///< (|pairs_|, padded to a multiple of 8)
  /// (|pairs_|, padded to a multiple of 8) intervals in which they may intersect, see PairKernel.
  std::vector<float> from_, to_;
  bool is_swept_ = false;
  double unit_ = 1;      ///< the query's unit, in mesh units
  double rounding_ = 0;  ///< tolerance added to lengths, mesh units

  std::vector<std::uint32_t> chosen_;      ///< indices of pairs; sized for all
  std::vector<CachedPair> chosen_places_;  ///< the same pairs, padded to a multiple of 8
  std::size_t chosen_count_ = 0;
  std::vector<PairVerdicts> verdicts_;     ///< (blocks of eight pairs)
  std::vector<Meeting> meeting_, before_;  ///< ascending: at the last update, and at the one before
};

template <class Exact, class Visit>
bool CandidateCache::update(const TreeKernel& k, Exact&& exact, Visit&& visit) {
  constexpr bool kIsSeen = !std::is_same_v<std::remove_cvref_t<Visit>, Unseen>;
  PairKernel kernel = kernel_at(k, chosen_places_);
  kernel.block_count = static_cast<std::uint32_t>((chosen_count_ + 7) / 8);
  kernel.verdicts = verdicts_.data();
  run_pair_kernel(kernel);
  meeting_.swap(before_);
  meeting_.clear();
  for (std::size_t i = 0; i < chosen_count_; i += 8) {
    const unsigned present = chosen_count_ - i < 8 ? (1u << (chosen_count_ - i)) - 1 : 255u;
    const PairVerdicts v = verdicts_[i / 8];
    const unsigned looked_at = kIsSeen ? present : present & ~unsigned{v.disjoint};
    for (unsigned left = looked_at; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const std::uint32_t pair = chosen_[i + static_cast<std::size_t>(lane)];
      const bool crosses = (v.cross >> lane & 1) != 0, rejected = kIsSeen && (v.disjoint >> lane & 1) != 0;
      const exact::Meet meet = crosses    ? exact::Meet::cross
                               : rejected ? exact::Meet::disjoint
                                          : exact(pairs_[pair]);
      visit(pairs_[pair], meet, crosses || rejected);
      if (meet != exact::Meet::disjoint) meeting_.push_back({pair, meet});
    }
  }
  return meeting_ != before_;
}

}  // namespace lrb

#pragma once
/// The candidate cache: the pairs of simplices that are near each other along a sweep of B, or about a fixed
/// pose. They are kept so that it costs little to find out how they meet at a pose there: only those pairs
/// are tested that may meet at that point of the sweep, or that are no further apart than B has moved from
/// the fixed pose, and eight pairs at a time.

#include <bit>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/collide/pair_order.hpp"
#include "engine/collide/relative_motion.hpp"
#include "engine/tree/pair_kernel.hpp"
#include "engine/tree/tree_kernel.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb {

// Decides when a coherent query makes a candidate cache, and for how many steps: by the clock, comparing
// what caches cost with what queries from scratch cost. The answers do not depend on it.

class CachePolicy {
 public:
  /// What a cache covers: a sweep of B, or the surroundings of a fixed pose. Each kind has a number of steps
  /// that suits it.
  enum class Kind : std::uint8_t { swept, fixed };

  /// Starts a query. Returns true while the policy pauses after caches that did not pay: B's motion need not
  /// be watched then. For the last few queries of a pause returns false, because a cache can be made only
  /// once the motion is known.
  bool rests();
  /// Returns true during a pause: the query is to be answered from scratch.
  bool must_wait() const { return pause_ > 0; }

  struct Plan {
    Kind kind;
    double steps;  ///< number of steps that the cache is to serve for
  };
  /// Returns the cache that should be made now, if any. is_steady: B's motion is steady
  /// (RelativeMotion::is_kept()); step: how far B moves at a time; radius: B's (both in the mesh's unit).
  /// Takes into account what the last cache cost.
  std::optional<Plan> next(bool is_steady, double step, double radius);
  /// The number of steps that caches are made for before it is known what suits.
  static constexpr double kFirstSteps = 8;

  /// Returns the time in seconds after which making a cache is given up.
  double patience() const;

  // Report the time that a whole query took, in seconds: one from scratch, one that made a cache, one
  // answered from it.
  void scratch_took(double time);
  void build_took(Kind kind, double time);
  void step_took(double time);
  /// Ignores what the last cache cost, because it ended for reasons of its own; does so only once until the
  /// next cache is accounted for.
  void forgive() {
    if (!std::exchange(forgave_, true)) build_time_ = 0;
  }

 private:
  struct Aim {
    double steps = kFirstSteps;
    double cost = 0;  ///< recent cost of a query with such caches, in queries from scratch; 0: not known
    /// The next cache is for more steps, as long as that makes queries faster; else for fewer.
    bool is_growing = true;
  };
  Aim& aim(Kind kind) { return aim_[static_cast<int>(kind)]; }
  double cost() const;  ///< cost of a query with the current cache, in queries from scratch
  double growth(Aim& used, double now) const;
  void take_stock();
  void rest();

  Aim aim_[2] = {{}, {.cost = 0.6}};       ///< fixed caches are tried where swept ones cost more than this
  bool has_memory_ = false;                ///< a cache has been made before
  Kind kind_ = Kind::swept;                ///< kind of the current cache
  double build_time_ = 0, step_time_ = 0;  ///< times of making it, and of the steps since
  std::uint32_t steps_ = 0;                ///< number of these steps
  double scratch_time_ = 0;
  bool is_fresh_ = false;                     ///< scratch_time_ is newer than the cache
  bool forgave_ = false;                      ///< forgive() was called since the last take_stock()
  std::uint32_t failures_ = 0;                ///< number of caches in a row that did not pay
  double too_long_ = 0;                       ///< a step for which a cache did not pay, mesh's unit
  std::uint32_t pause_ = 0, next_pause_ = 4;  ///< queries from scratch before the next cache is tried
  std::uint32_t pauses_ = 0;                  ///< number of pauses since the last try
};

/// The simplices of one body that occur in cached pairs.
class CandidateSimplices {
 public:
  void begin(const LrbRep& rep, double unit);
  /// Returns the index of a simplex in data(); writes it there if it is new.
  std::uint32_t place_of(SimplexId s);
  const CachedSimplex* data() const { return written_.data(); }

  /// Returns the origin of their frame, a corner among them; query units.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// Returns the radius of a ball about the origin that holds all first corners; query units.
  float radius() const;

 private:
  void write(SimplexId s);

  struct Slot {
    std::uint32_t epoch = 0, place = 0;
  };
  const LrbRep* rep_ = nullptr;
  double per_unit_ = 1;
  std::vector<Slot> slots_;  ///< (simplices of the body) valid where `epoch` is the current one
  std::uint32_t epoch_ = 0;
  std::vector<CachedSimplex> written_;
  Eigen::Vector3d origin_{0, 0, 0};
  double farthest_sq_ = 0;
};

/// Makes a kernel that is set up at the middle of a sweep find all pairs that may meet in the sweep.
/// `rounding`: of world coordinates; `unit`: the query's; both in the mesh's unit.
void aim_at(const Sweep& sweep, double rounding, double unit, TreeKernel& k);

class CandidateCache {
 public:
  void clear() { pairs_.clear(); }
  void add(SimplexPair p) { pairs_.push_back(p); }
  /// Returns the pairs; ascending, once they are arranged.
  const std::vector<SimplexPair>& pairs() const { return pairs_; }

  /// Sorts the pairs that were added, which must be all that may meet in the sweep, and drops those that turn
  /// out not to. The kernel is the one that found them, at the middle of the sweep. `rounding`: of world
  /// coordinates, mesh's unit.
  void arrange(const LrbRep& a, const LrbRep& b, const TreeKernel& k, const Sweep& sweep, double rounding,
               PairOrder& order);

  /// Chooses the pairs that may meet with B at this point of the sweep. Returns their number.
  std::size_t choose(const SweepPoint& where);

  /// Returns true if no pair may meet on the way from here to there, both in the sweep.
  bool none_between(const SweepPoint& here, const SweepPoint& there) const;

  /// Stands for an observer of update() that does not look.
  struct Unseen {
    void operator()(SimplexPair, exact::Meet, bool) const {}
  };
  /// Finds out how the chosen pairs meet at the pose of k; the others do not meet. Calls exact(pair) where
  /// floats are not certain, and see(pair, meet, is_certain) for each chosen pair, in order. Returns true if
  /// anything has changed since the last update.
  template <class Exact, class See = Unseen>
  bool update(const TreeKernel& k, Exact&& exact, See&& see = {});

  /// Appends the pairs that meet, ascending.
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

  /// Spans of a sweep lie between -1 and 1, and are rounded by 2^-20 near these ends.
  static constexpr float kSpanRounding = 0x1p-16f;

  CandidateSimplices of_[2];
  std::vector<SimplexPair> pairs_;
  std::vector<CachedPair> places_;  ///< (|pairs_|, padded to a multiple of 8)
  /// (|pairs_|, padded to a multiple of 8) where they may meet, see PairKernel.
  std::vector<float> from_, to_;
  bool is_swept_ = false;
  double unit_ = 1;      ///< the query's unit, in the mesh's
  double rounding_ = 0;  ///< allowed for in lengths, mesh's unit

  std::vector<std::uint32_t> chosen_;      ///< indices of pairs, with room for all
  std::vector<CachedPair> chosen_places_;  ///< the same pairs, padded to a multiple of 8
  std::size_t chosen_count_ = 0;
  std::vector<PairVerdicts> verdicts_;     ///< (blocks of eight pairs)
  std::vector<Meeting> meeting_, before_;  ///< ascending; now, and before the last update
};

template <class Exact, class See>
bool CandidateCache::update(const TreeKernel& k, Exact&& exact, See&& see) {
  constexpr bool kIsSeen = !std::is_same_v<std::remove_cvref_t<See>, Unseen>;
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
      const bool crosses = (v.cross >> lane & 1) != 0, parted = kIsSeen && (v.disjoint >> lane & 1) != 0;
      const exact::Meet meet = crosses  ? exact::Meet::cross
                               : parted ? exact::Meet::disjoint
                                        : exact(pairs_[pair]);
      see(pairs_[pair], meet, crosses || parted);
      if (meet != exact::Meet::disjoint) meeting_.push_back({pair, meet});
    }
  }
  return meeting_ != before_;
}

}  // namespace lrb

#pragma once
/// The candidate cache: the pairs of simplices that are near each other along a sweep of B, or about a fixed
/// pose. They are kept so that it costs little to find out how they meet at a pose there: only those pairs
/// are tested that may meet at that point of the sweep, or that are no further apart than B has moved from
/// the fixed pose, and eight pairs at a time.

#include <bit>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "engine/exact/simplex_test.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/query/coherent/relative_motion.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/walk/pair_order.hpp"
#include "engine/tree/pair_kernel.hpp"
#include "engine/tree/tree_kernel.hpp"

namespace lrb {

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

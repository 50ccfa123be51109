#pragma once
/// The pairs of simplices that are near each other along a stretch of B's course, or about one place, kept so
/// that how they meet at a pose there takes little: of the list those are tested that may meet at that point
/// of the stretch, or are no further apart than B has moved from the place, corners eight abreast.

#include <bit>
#include <cstdint>
#include <vector>

#include "engine/exact/simplex_test.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/query/coherent/relative_motion.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/walk/pair_order.hpp"
#include "engine/tree/pair_kernel.hpp"
#include "engine/tree/tree_kernel.hpp"

namespace lrb {

/// The simplices of one body that occur in pairs.
class CandidateSimplices {
 public:
  void begin(const LrbRep& rep, double unit);
  /// The place of a simplex in what follows; written there if it is new.
  std::uint32_t place_of(SimplexId s);
  const CachedSimplex* data() const { return written_.data(); }

  /// Origin of their frame: a corner amid them, query units.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// Of a ball about the origin that holds all first corners.
  float radius() const;

 private:
  void write(SimplexId s);

  struct Slot {
    std::uint32_t list = 0, place = 0;
  };
  const LrbRep* rep_ = nullptr;
  double per_unit_ = 1;
  std::vector<Slot> slots_;  ///< (simplices of the body) good where `list` is this one
  std::uint32_t list_ = 0;
  std::vector<CachedSimplex> written_;
  Eigen::Vector3d origin_{0, 0, 0};
  double farthest_sq_ = 0;
};

/// Has a kernel at the middle of a stretch find all pairs that may meet in it. `rounding`: of world
/// coordinates; `unit`: the query's; both in the mesh's.
void aim_at(const Sweep& stretch, double rounding, double unit, TreeKernel& k);

class CandidateCache {
 public:
  void clear() { pairs_.clear(); }
  void add(SimplexPair p) { pairs_.push_back(p); }
  /// Ascending, once they are arranged.
  const std::vector<SimplexPair>& pairs() const { return pairs_; }

  /// Puts the pairs that were added in order: all that may meet in the stretch. Drops those that turn out not
  /// to. The kernel is the one that found them, at the middle of the stretch. `rounding`: of world
  /// coordinates, mesh's unit.
  void arrange(const LrbRep& a, const LrbRep& b, const TreeKernel& k, const Sweep& stretch, double rounding,
               PairOrder& order);

  /// Chooses the pairs that may meet where B is, in the stretch. How many they are.
  std::size_t choose(const SweepPoint& where);

  /// Whether none may meet on the way from here to there, both in the stretch.
  bool none_between(const SweepPoint& here, const SweepPoint& there) const;

  /// Finds out how the chosen pairs meet at the pose of k; the others do not. exact(pair) is asked where
  /// floats are not certain. True if anything is not as it was.
  template <class Exact>
  bool update(const TreeKernel& k, Exact&& exact);

  /// The pairs that meet, ascending.
  void append_meeting(CollideResult& result) const;

 private:
  struct Meeting {
    std::uint32_t pair;
    exact::Meet meet;
    friend bool operator==(const Meeting&, const Meeting&) = default;
  };
  void place_pairs(const LrbRep& a, const LrbRep& b);
  void find_spans(const TreeKernel& k, const Sweep& stretch);
  template <class Keep>
  void drop_unless(Keep&& keep);
  float length_of(double distance) const;
  float place_of(const SweepPoint& where) const;
  float span_rounding() const { return is_swept_ ? kSpanRounding : 0; }
  PairKernel kernel_at(const TreeKernel& k, const std::vector<CachedPair>& pairs) const;

  /// Spans of a sweep are from -1 to 1, and rounded by 2^-20 near there.
  static constexpr float kSpanRounding = 0x1p-16f;

  CandidateSimplices of_[2];
  std::vector<SimplexPair> pairs_;
  std::vector<CachedPair> places_;  ///< (|pairs_|, filled up to eights)
  std::vector<float> from_, to_;    ///< (|pairs_|, filled up to eights) where they may meet, see PairKernel
  bool is_swept_ = false;
  double unit_ = 1;      ///< the query's, in the mesh's
  double rounding_ = 0;  ///< to be taken off lengths, mesh's unit

  std::vector<std::uint32_t> chosen_;      ///< numbers of pairs, room for all
  std::vector<CachedPair> chosen_places_;  ///< the same, filled up to eights
  std::size_t chosen_count_ = 0;
  std::vector<PairVerdicts> verdicts_;     ///< (eights)
  std::vector<Meeting> meeting_, before_;  ///< ascending; now, and before the last update
};

template <class Exact>
bool CandidateCache::update(const TreeKernel& k, Exact&& exact) {
  PairKernel kernel = kernel_at(k, chosen_places_);
  kernel.block_count = static_cast<std::uint32_t>((chosen_count_ + 7) / 8);
  kernel.verdicts = verdicts_.data();
  run_pair_kernel(kernel);
  meeting_.swap(before_);
  meeting_.clear();
  for (std::size_t i = 0; i < chosen_count_; i += 8) {
    const unsigned present = chosen_count_ - i < 8 ? (1u << (chosen_count_ - i)) - 1 : 255u;
    const PairVerdicts v = verdicts_[i / 8];
    for (unsigned left = present & ~unsigned{v.disjoint}; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const std::uint32_t pair = chosen_[i + static_cast<std::size_t>(lane)];
      const bool crosses = (v.cross >> lane & 1) != 0;
      const exact::Meet meet = crosses ? exact::Meet::cross : exact(pairs_[pair]);
      if (meet != exact::Meet::disjoint) meeting_.push_back({pair, meet});
    }
  }
  return meeting_ != before_;
}

}  // namespace lrb

#pragma once
/// The pairs of simplices that are near each other at one pose of B seen from A, kept so that how they meet
/// at another pose close by takes little: corners eight abreast, the pairs that are least apart first.

#include <bit>
#include <cstdint>
#include <vector>

#include "engine/exact/simplex_test.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/pair_kernel.hpp"
#include "engine/query/tree_kernel.hpp"

namespace lrb {

class NearPairs {
 public:
  void clear() { pairs_.clear(); }
  void add(SimplexPair p) { pairs_.push_back(p); }
  std::size_t size() const { return pairs_.size(); }
  SimplexPair operator[](std::size_t i) const { return pairs_[i]; }

  /// Puts the pairs that were added in order, at the pose of k. Drops those that are apart by more than
  /// `margin`. `rounding`: of world coordinates. Both in the mesh's unit.
  void arrange(const LrbRep& a, const LrbRep& b, const TreeKernel& k, double margin, double rounding);

  /// So many pairs, the first ones, may meet, or come to, while no point of B is further than `distance` from
  /// where it was at that pose, seen from A. `distance` <= `margin`, in the mesh's unit.
  std::size_t within(double distance) const;

  /// Finds out how the first `count` pairs meet at the pose of k, no point of B being further than `moved`
  /// from where it was; the others do not meet. exact(pair) is asked where floats are not certain. True if
  /// anything is not as it was.
  template <class Exact>
  bool update(const TreeKernel& k, double moved, std::size_t count, Exact&& exact);

  /// The pairs that meet, in no order.
  void list_meeting(CollideResult& result) const;

 private:
  struct Meeting {
    std::uint8_t cross = 0, touch = 0;  ///< a bit for each pair of a block
    friend bool operator==(const Meeting&, const Meeting&) = default;
  };
  /// Of a pair, for the block that it comes to.
  struct Size {
    float edge_a, edge_b, reach;
  };
  void fill_blocks(const LrbRep& a, const LrbRep& b, const TreeKernel& k);
  int shell_of(std::size_t i, double margin, double rounding) const;
  void sort_by_shell(double margin, double rounding);
  /// Of the frame of B's corners, seen from that of A's; query units.
  Eigen::Vector3d offset_at(const TreeKernel& k) const;
  PairKernel kernel_at(const TreeKernel& k, double moved, std::size_t count);

  std::vector<SimplexPair> pairs_, sorted_;
  std::vector<PairBlock> blocks_, sorted_blocks_;
  std::vector<Size> sizes_;             ///< (|pairs|) in the order in which they came
  std::vector<PairVerdicts> verdicts_;  ///< (|blocks|)
  std::vector<Meeting> meeting_;        ///< (|blocks|)
  std::vector<float> gaps_;             ///< (8 |blocks|)
  std::size_t meeting_blocks_ = 0;      ///< of those beyond none meets

  /// Shell i is apart by i - 1 widths at least. The first two are those that cross, and the rest of what may
  /// meet at the pose of the list: blocks of the same kind take less.
  static constexpr int kShells = 33;
  std::size_t shell_end_[kShells] = {};  ///< pairs in shells up to this one
  double shell_width_ = 0;
  double unit_ = 1;            ///< the query's
  Eigen::Vector3d middle_[2];  ///< origins of the frames of A's and B's corners, query units
  float radius_[2] = {};
};

template <class Exact>
bool NearPairs::update(const TreeKernel& k, double moved, std::size_t count, Exact&& exact) {
  run_pair_kernel(kernel_at(k, moved, count));
  const std::size_t blocks = (count + 7) / 8;
  bool changed = false;
  for (std::size_t i = 0; i < blocks; ++i) {
    const unsigned present = count - 8 * i < 8 ? (1u << (count - 8 * i)) - 1 : 255u;
    const PairVerdicts v = verdicts_[i];
    Meeting now{static_cast<std::uint8_t>(v.cross & present), 0};
    for (unsigned open = present & ~unsigned{v.cross} & ~unsigned{v.disjoint}; open != 0; open &= open - 1) {
      const int lane = std::countr_zero(open);
      const exact::Meet meet = exact(pairs_[8 * i + static_cast<std::size_t>(lane)]);
      now.cross |= static_cast<std::uint8_t>((meet == exact::Meet::cross) << lane);
      now.touch |= static_cast<std::uint8_t>((meet == exact::Meet::touch) << lane);
    }
    changed |= now != meeting_[i];
    meeting_[i] = now;
  }
  for (std::size_t i = blocks; i < meeting_blocks_; ++i) {
    changed |= meeting_[i] != Meeting{};
    meeting_[i] = {};
  }
  meeting_blocks_ = blocks;
  return changed;
}

}  // namespace lrb

#pragma once
/// Where to cut ranges of simplices in two so that the boxes that fit the halves are small.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/tree/obb_tree.hpp"
#include "engine/tree/soup.hpp"

namespace lrb {

/// Returns the number of leaves that hold some simplices: all but the last are full.
inline std::uint32_t leaves_for(std::uint32_t simplices) {
  return (simplices + kTreeWidth - 1) / kTreeWidth;
}

/// Returns how many of some simplices are on the larger side of a cut: the fewer, the more even it is.
inline std::uint32_t larger_side(std::uint32_t left, std::uint32_t all) {
  return std::max(left, all - left);
}

/// How many cuts of a range to compare.
struct CutEffort {
  int principal;        ///< across how many of the range's principal axes, the longest first; 0 to 3
  std::uint32_t tried;  ///< number of cuts for which the boxes are found, at least 1; more in large ranges
};

/// Some simplices, ordered along the coordinate axes, that are cut into ranges and those again, down to
/// leaves.
///
/// All cuts of a range across the coordinate axes and some principal axes are ranked by how the points of the
/// halves are spread. Of the first ones that one is taken whose halves have the smallest boxes, each on its
/// own axes as in fit_frame(): the sum of box_cost(), each times the number of leaves in it (the surface area
/// heuristic, of boxes as the query will see them). Of cuts that rank or cost the same, the most even one
/// comes first, so that simplices at one point are halved.
class FittedCuts {
 public:
  /// Nothing is cut yet: the one range is [0, simplices.size()). `soup` must outlive this.
  FittedCuts(const Soup& soup, std::span<const std::uint32_t> simplices, CutEffort effort);

  struct Halves {
    std::uint32_t middle;          ///< where the range is cut: a multiple of kTreeWidth after its beginning
    double left_cost, right_cost;  ///< box_cost() of the boxes that fit
  };
  /// Cuts a range of more than kTreeWidth simplices that nothing has cut yet, in two ranges.
  Halves cut(std::uint32_t begin, std::uint32_t end);

  /// Returns box_cost() of the box that fits all simplices.
  double whole_cost() const { return whole_cost_; }

  /// Returns the simplices, range by range.
  std::vector<std::uint32_t> order() const;

 private:
  struct Cut {
    float cost;            ///< rounded: what differs by rounding errors alone mostly costs the same
    std::uint32_t larger;  ///< larger_side()
    int way;               ///< the direction it is across
    std::uint32_t left;    ///< number of simplices on its left
    bool operator<(const Cut& y) const;
  };

  std::span<const std::uint32_t> along(int way) const;
  void measure();
  void order_along_principal(int k, const Eigen::Vector3d& direction);
  void rank(int way);
  Halves measured(const Cut& cut, float most) const;
  double fitted_box_cost(std::span<const std::uint32_t> some) const;
  void part(const Cut& cut);

  const Soup& soup_;
  const CutEffort effort_;
  double whole_cost_ = 0;
  std::vector<std::uint32_t> simplices_;  ///< in order; below, simplices go by their place here
  std::vector<Spread> spread_;            ///< of each simplex; in a range, from one origin and at one scale
  std::array<std::vector<std::uint32_t>, 3> coordinate_;  ///< range by range, ordered along an axis in each

  // The range that is being cut.
  std::uint32_t begin_ = 0, size_ = 0;
  Spread all_;
  std::array<std::vector<std::uint32_t>, 3> principal_;  ///< ordered along its principal axes
  std::vector<Cut> cuts_;
  std::vector<std::uint8_t> is_left_;  ///< for each simplex

  // Memory that is kept from one use to the next.
  std::vector<std::uint64_t> places_;
  std::vector<std::uint32_t> right_;
};

}  // namespace lrb

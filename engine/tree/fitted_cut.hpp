#pragma once
/// Where to cut a range of simplices in two so that the boxes that fit the halves are small.

#include <cstdint>
#include <span>

#include "engine/tree/obb_tree.hpp"
#include "engine/tree/soup.hpp"

namespace lrb {

/// Returns the number of leaves that hold some simplices: all but the last are full.
inline std::uint32_t leaves_for(std::uint32_t simplices) {
  return (simplices + kTreeWidth - 1) / kTreeWidth;
}

/// How many cuts to look at.
struct CutEffort {
  int principal;        ///< across how many of the range's principal axes, the longest first; 0 to 3
  std::uint32_t tried;  ///< number of cuts for which the boxes are found, at least; more in large ranges
};

/// Orders a range of more than kTreeWidth simplices, and returns how many of them to put on the left: a
/// multiple of kTreeWidth; 0 if all are at one point, so that no cut is better than another.
///
/// All cuts across the coordinate axes and some principal axes are ranked by how the points of the halves are
/// spread. Of the first ones that one is taken whose halves have the smallest boxes, each on its own axes as
/// in fit_frame(): the sum of their surfaces, each times the number of leaves in it (the surface area
/// heuristic, of boxes as the query will see them).
std::uint32_t cut_by_fitted_boxes(const Soup& soup, std::span<std::uint32_t> range, CutEffort effort);

}  // namespace lrb

#pragma once
/// Parts of a 2D outline that enclose nothing visible: the outline runs along a line and back, closer than
/// pixels. Wrappers have them where lids of overlapping extent are almost collinear.

#include <array>
#include <vector>

#include <Eigen/Core>

namespace lrb::render {

using Segment2d = std::array<Eigen::Vector3d, 2>;  ///< directed; z is not used

/// Returns the parts of the segments that remain without hairs: where segments within `width` of each other
/// cancel, because as many run one way as the other, they are left out. Segments without hairs are returned
/// unchanged, in order.
std::vector<Segment2d> without_hairs(const std::vector<Segment2d>& segments, double width);

}  // namespace lrb::render

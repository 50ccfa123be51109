#pragma once
/// Poses of a body beside another: random ones, the search for those of the highest cost, and poses that are
/// hard in floating point.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/core/random.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::engines {

/// A pose of B relative to A.
struct Placement {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  /// From the centre of A's box to that of B's; 1 is the mean of both boxes' diagonals.
  Eigen::Vector3d offset{0, 0, 0};
};

/// Maps placements to poses. The same seed gives the same poses on every machine.
class PoseSpace {
 public:
  PoseSpace(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b)
      : a_(a.center()), b_(b.center()), unit_((a.diagonal().norm() + b.diagonal().norm()) / 2) {}

  /// Length of a unit of offsets.
  double unit() const { return unit_; }
  Pose pose(const Placement& at) const {
    const Eigen::Matrix3d r = at.turn.toRotationMatrix();
    return {r, a_ + unit_ * at.offset - r * b_};
  }

 private:
  Eigen::Vector3d a_, b_;
  double unit_;
};

/// Returns a uniformly distributed rotation, and an offset with uniformly distributed direction and length in
/// [0, 1).
Placement random_placement(Random& random);
/// Returns true if two placements differ by less than `angle` (radians) and by less than `distance`.
bool alike(const Placement& p, const Placement& q, double angle = 0.01, double distance = 0.01);

/// A placement with its cost.
struct Trial {
  Placement at;
  double cost = -std::numeric_limits<double>::infinity();
  std::size_t number = 0;  ///< 1, 2, ... in order of the queries
};

/// Returns the cost of each placement; higher is worse.
using CostsOf = std::function<std::vector<double>(std::span<const Placement> placements)>;
using SearchProgress = std::function<void(std::size_t done)>;

struct SearchOptions {
  std::size_t budget = 3000;  ///< number of queries
  std::uint64_t seed = 1;
  double random_share = 0.6;  ///< of the budget; the rest improves the best of these
  std::size_t starts = 8;     ///< number that are improved
};

/// The trials of a search, in order. `random` of them, the first, are random.
struct Search {
  std::vector<Trial> trials;
  std::size_t random = 0;

  /// Returns at most `most` trials, the worst first, without those that are alike a worse one.
  std::vector<Trial> worst(std::size_t most = 8) const;
};

/// Searches for placements of high cost. A share of the budget is random. The best of those are improved in
/// turn: a step is kept if it raises the cost, and steps grow by 1.5 after a success and shrink by 0.9
/// otherwise (adaptation of the step length by success: Rechenberg's rule for the (1+1) evolution strategy,
/// 1973). Steps of all starts are evaluated together, and depend only on the earlier ones of the same start.
Search search(const SearchOptions& options, const CostsOf& costs, const SearchProgress& progress);
// Hard poses.

enum class Hard : std::uint8_t {
  first_contact,   ///< the last double before the surfaces meet on a straight motion, and the next
  coplanar_faces,  ///< a face of B in the plane of a face of A, with a common point
  parallel_edges,  ///< an edge of B along an edge of A, with a common midpoint
  vertices,        ///< a vertex of B on one of A; axes of B along axes of A
};
constexpr auto enum_names(Hard) {
  return std::to_array<EnumName<Hard>>({{Hard::first_contact, "first_contact"},
                                        {Hard::coplanar_faces, "coplanar_faces"},
                                        {Hard::parallel_edges, "parallel_edges"},
                                        {Hard::vertices, "vertices"}});
}

struct HardPose {
  Hard kind = Hard::first_contact;
  int ulps = 0;  ///< moved by this many units in the last place of the bodies' size
  Pose pose;
};

/// Returns `count` poses: of each kind in turn, and at each of kUlps. Without a first contact on the drawn
/// path another is drawn.
std::vector<HardPose> hard_poses(const LrbRep& a, const LrbRep& b, const PoseSpace& space, std::size_t count,
                                 std::uint64_t seed);
/// Up to the rounding of poses in single precision.
inline constexpr std::array<int, 11> kUlps = {0,          1,       -1,         16,      -16,       1 << 12,
                                              -(1 << 12), 1 << 24, -(1 << 24), 1 << 30, -(1 << 30)};

}  // namespace lrb::engines

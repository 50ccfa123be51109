#pragma once
/// What coarse queries claim, against slow truth.

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/collide/collide_into.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::test {

/// Whether the wrappers of a tolerance are told apart, with nothing asked about the bodies themselves. True
/// must mean that the bodies are separate.
inline bool wrappers_are_disjoint(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                  double tolerance, QueryContext& context) {
  NullProbe probe;
  const LrbRep* const reps[2] = {&a, &b};
  const Pose* const poses[2] = {&pose_a, &pose_b};
  for (int side = 0; side < 2; ++side) {
    QueryBody& body = context.body[side];
    body.begin(*reps[side], *poses[side], WrapperMode::regularised);
    if (const WrapperLevel* const level = reps[side]->levels().within(tolerance)) body.query_level(*level);
  }
  WrapperRules<> rules;
  rules.margin = wrapper_margin(pose_a, context.body[0].tree(), pose_b, context.body[1].tree());
  CollideResult found;
  const CollideRequest request;
  TreeQuery<NullProbe, WrapperRules<>> query(context, request, found, probe, rules);
  query.run();
  return found.pairs.empty() && !query.rules().near &&
         wrappers_nested(
             context, [] { return true; }, [](Side, VertexId, Where) {}) == false;
}

/// The real faces of two bodies in the world, to measure from points.
class RealSurfaces {
 public:
  RealSurfaces(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b)
      : a_(a),
        pose_a_(pose_a),
        b_(b),
        pose_b_(pose_b),
        of_{real_simplices(a, pose_a), real_simplices(b, pose_b)} {}

  /// Returns how far a pair of an answer is off the bodies, both together: the most over the corners of where
  /// its simplices meet. 0 where they only come within rounding of each other.
  double off(const SimplexPair& pair) const {
    const Points p = simplex_points(a_, pose_a_, pair.a), q = simplex_points(b_, pose_b_, pair.b);
    const auto pp = pointers(p), qq = pointers(q);
    const exact::PairContact c = a_.dim() == 3 ? exact::contact_of_triangles(pp.data(), qq.data())
                                               : exact::contact_of_segments(pp.data(), qq.data());
    double most = 0;
    for (std::uint8_t i = 0; i < c.corner_count; ++i)
      most = std::max(most, distance(c.corners[i].x, 0) + distance(c.corners[i].x, 1));
    return most;
  }

  double distance(const Eigen::Vector3d& x, int side) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Points& s : of_[side]) {
      if ((s[0] - x).norm() - reach(s) >= least) continue;
      least = std::min(least, s.size() == 3 ? point_triangle(x, s) : point_segment(x, s[0], s[1]));
    }
    return least;
  }

  /// Of surfaces that do not meet.
  double between() const { return surface_distance(of_[0], of_[1]); }

 private:
  const LrbRep& a_;
  Pose pose_a_;
  const LrbRep& b_;
  Pose pose_b_;
  std::vector<Points> of_[2];
};

}  // namespace lrb::test

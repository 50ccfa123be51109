// FCL as packaged: distance() of two BVHModels, continuousCollide() with each solver that supports them, the
// maximum penetration depth of collide()'s contacts, and near pairs by the traversal of distance(), which is
// kept from stopping at pairs that are farther than the nearest, but within the distance.

#include "bench/methods/method.hpp"

#ifdef LRB_HAS_FCL

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/traversal_recurse.h>
#include <fcl/narrowphase/distance.h>

#include "bench/methods/fcl_models.hpp"

namespace lrb::methods {
namespace {

fcl::Transform3d moved(const Eigen::Vector3d& by) {
  return transform<double>(Pose::translation(by));
}

template <class Volume>
fcl::BVHModel<Volume> model(const LrbRep& rep, const Eigen::Vector3d& by = {0, 0, 0}) {
  return model_of<Volume>(triangles_of(rep), by);
}

/// FCL rejects a pair only if it is within both the absolute and the relative error. The relative error is at
/// most 1.
template <class Volume>
Answer fcl_distance(const Question& q, Setting tolerance) {
  const auto a = model<Volume>(q.a), b = model<Volume>(q.b);
  fcl::DistanceRequestd request;
  request.abs_err = tolerance.value_or(0) * q.size;
  request.rel_err = request.abs_err > 0 ? 1 : 0;
  fcl::DistanceResultd result;
  const Stopwatch watch;
  const double d = fcl::distance(&a, moved({0, 0, 0}), &b, moved({0, 0, 0}), request, result);
  const double us = watch.microseconds(), least = std::max(0.0, d);  // -1: the surfaces intersect
  return number_answer(least, least, us);
}

/// B is FCL's first body, because its conservative advancement ignores a second body that approaches. The
/// polynomial solver uses vertices without their poses, so B's vertices are those at the start of the motion.
template <class Volume>
Answer fcl_first_contact(const Question& q, fcl::CCDSolverType solver, std::size_t iterations) {
  const bool in_place = solver == fcl::CCDC_POLYNOMIAL_SOLVER;
  const Eigen::Vector3d none(0, 0, 0), begin = in_place ? q.from : none;
  const auto a = model<Volume>(q.a), b = model<Volume>(q.b, begin);
  fcl::ContinuousCollisionRequestd request;
  request.ccd_solver_type = solver;
  request.num_max_iterations = iterations;
  fcl::ContinuousCollisionResultd result;
  const Stopwatch watch;
  fcl::continuousCollide<double>(&b, moved(q.from - begin), moved(q.to - begin), &a, moved(none), moved(none),
                                 request, result);
  const double t = result.is_collide ? result.time_of_contact : kNever;
  return number_answer(t, t, watch.microseconds());
}

Answer fcl_depth(const Question& q, Setting) {
  const auto a = model<fcl::OBBRSSd>(q.a), b = model<fcl::OBBRSSd>(q.b);
  const fcl::CollisionRequestd request(std::size_t{1} << 20, true);
  fcl::CollisionResultd result;
  const Stopwatch watch;
  fcl::collide(&a, moved({0, 0, 0}), &b, moved({0, 0, 0}), request, result);
  double depth = 0;
  for (std::size_t i = 0; i < result.numContacts(); ++i)
    depth = std::max(depth, result.getContact(i).penetration_depth);
  return number_answer(depth, depth, watch.microseconds());
}

/// S: float or double.
template <class S>
class NearNode : public fcl::detail::MeshDistanceTraversalNodeOBBRSS<S> {
 public:
  NearNode(S within, Answer& answer) : within_(within), answer_(answer) {}
  bool canStop(S bound) const override { return bound > within_; }
  void leafTesting(int b1, int b2) const override {
    const int i = this->model1->getBV(b1).primitiveId(), j = this->model2->getBV(b2).primitiveId();
    const fcl::Triangle &s = this->tri_indices1[i], &t = this->tri_indices2[j];
    const fcl::Vector3<S>*p = this->vertices1, *q = this->vertices2;
    fcl::Vector3<S> on_a, on_b;
    const S d = fcl::detail::TriangleDistance<S>::triDistance(p[s[0]], p[s[1]], p[s[2]], q[t[0]], q[t[1]],
                                                              q[t[2]], this->tf, on_a, on_b);
    if (d <= within_) add_near(answer_, {static_cast<SimplexId>(i), static_cast<SimplexId>(j)}, d);
  }

 private:
  S within_;
  Answer& answer_;
};

template <class S>
Answer fcl_near(const Question& q, Setting) {
  const auto a = model<fcl::OBBRSS<S>>(q.a), b = model<fcl::OBBRSS<S>>(q.b);
  const fcl::DistanceRequest<S> request;
  fcl::DistanceResult<S> result;
  Answer out;
  NearNode<S> node(static_cast<S>(q.within), out);
  const fcl::Transform3<S> none = fcl::Transform3<S>::Identity();
  const Stopwatch watch;
  fcl::detail::initialize(node, a, none, b, none, request, result);
  fcl::detail::distanceRecurse<S>(&node, 0, 0, nullptr);
  out.microseconds = watch.microseconds();
  sort_near(out);
  return out;
}

MethodEntry fcl_method(const char* name, const char* what, const char* remark, Quantity quantity, Ask ask,
                       MethodStyle style, const char* parameter = "", std::vector<double> settings = {}) {
  return {{.name = name,
           .title = std::string("FCL " FCL_VERSION ", ") + what,
           .remark = remark,
           .parameter = parameter,
           .settings = std::move(settings),
           .style = std::move(style),
           .rank = 20,
           .quantity = quantity},
          nullptr,
          std::move(ask)};
}

Ask sweep(fcl::CCDSolverType solver, std::size_t iterations) {
  return [=](const Question& q, Setting steps) {
    return fcl_first_contact<fcl::OBBRSSd>(q, solver, steps ? static_cast<std::size_t>(*steps) : iterations);
  };
}

}  // namespace

std::vector<MethodEntry> fcl_numbers_methods() {
  const std::vector<double> tolerances = {0.1, 0.01, 1e-3, 0};
  return {
      fcl_method("fcl-rss", "distance, RSS", "distance() of two BVHModel<RSS>.", Quantity::distance,
                 fcl_distance<fcl::RSSd>, {"FCL, RSS", "#d55e00", "rect"}, "tolerance", tolerances),
      fcl_method("fcl-obbrss", "distance, OBBRSS", "distance() of two BVHModel<OBBRSS>.", Quantity::distance,
                 fcl_distance<fcl::OBBRSSd>, {"FCL, OBBRSS", "#a3132f", "triangle"}, "tolerance", tolerances),
      fcl_method(
          "fcl-naive", "continuousCollide, naive",
          "Its default solver: the first of N equally spaced times at which the bodies collide; N is 1000 "
          "by default.",
          Quantity::first_contact, sweep(fcl::CCDC_NAIVE, 1000), {"FCL, naive", "#d55e00", "rect"}, "times",
          {10, 100, 1000}),
      fcl_method("fcl-advancement", "continuousCollide, advancement", "Conservative advancement.",
                 Quantity::first_contact, sweep(fcl::CCDC_CONSERVATIVE_ADVANCEMENT, 10),
                 {"FCL, conservative advancement", "#a3132f", "triangle"}),
      fcl_method("fcl-polynomials", "continuousCollide, polynomials", "Its polynomial solver.",
                 Quantity::first_contact, sweep(fcl::CCDC_POLYNOMIAL_SOLVER, 10),
                 {"FCL, polynomials", "#8a5a2b", "star"}),
      fcl_method("fcl-contacts", "collide, contacts", "The largest penetration depth of its contacts.",
                 Quantity::depth, fcl_depth, {"FCL, contacts", "#d55e00", "rect"}),
      fcl_method("fcl-near", "traversal of distance, double",
                 "All pairs: the traversal of distance() of two BVHModel<OBBRSS>, bounded by the given "
                 "distance; triDistance() at its leaves.",
                 Quantity::near_pairs, fcl_near<double>, {"FCL, double", "#a3132f", "triangle"}),
      fcl_method("fcl-near-float", "traversal of distance, float", "The same in float.", Quantity::near_pairs,
                 fcl_near<float>, {"FCL, float", "#d55e00", "rect"})};
}

}  // namespace lrb::methods

#else

namespace lrb::methods {
std::vector<MethodEntry> fcl_numbers_methods() {
  return {};
}
}  // namespace lrb::methods

#endif

/// Signed distances of points; point_distance.hpp names the method.

#include <array>
#include <string>

#include "engine/collide/collide_into.hpp"
#include "engine/collide/relation.hpp"
#include "engine/distance/distance_context.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/point_distance.hpp>

namespace lrb {
namespace {

/// Returns a body of one simplex whose corners are all in the origin. A translation moves it to any point
/// without rounding.
LrbRep body_of_one_point(int dim) {
  Mesh mesh;
  mesh.dim = dim;
  mesh.vertices.assign(static_cast<std::size_t>(dim), Eigen::Vector3d::Zero());
  const std::array<VertexId, 3> corners{VertexId(0), VertexId(1), VertexId(2)};
  mesh.add_face(std::span(corners).first(static_cast<std::size_t>(dim)));
  return LrbRep::without_regions(mesh, false, false);
}

}  // namespace

std::vector<PointDistance> point_distances(const LrbRep& body, const Pose& pose,
                                           std::span<const Eigen::Vector3d> points,
                                           const PointDistanceRequest& request, unsigned threads) {
  DistanceRequest ask;
  ask.tolerance = request.tolerance;
  ask.relative_tolerance = request.relative_tolerance;
  ask.relation = false;
  check_request(ask);
  // All points are checked first, so that the message names the first wrong one on any number of threads.
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].head(body.dim()).allFinite())
      throw InputError("point " + std::to_string(i) +
                       ": expected finite coordinates, found a NaN or an infinity");
  const LrbRep point = body_of_one_point(body.dim());
  Workers workers(threads);
  std::vector<DistanceContext> contexts(workers.count());
  std::vector<PointDistance> results(points.size());
  workers.for_each(points.size(), [&](std::size_t i, unsigned worker) {
    DistanceContext& context = contexts[worker];
    Eigen::Vector3d p = points[i];
    if (body.dim() == 2) p.z() = 0;
    const DistanceResult at = distance(body, pose, point, Pose::translation(p), ask, context);
    PointDistance& result = results[i];
    result.lower = at.lower;
    result.upper = at.upper;
    result.closest = at.witness[0];
    if (at.meet)
      result.side = Where::on_surface;
    else if (request.side && body.closed() && !body.tree().empty())
      // The query has left the body at its pose in the context.
      result.side = locate(context.query.body[0], p.data());
  });
  return results;
}

}  // namespace lrb

#include <algorithm>

#include "engine/exact/locate.hpp"
#include "engine/mesh/box_tree.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/float_mode.hpp>

namespace lrb {
namespace {

struct WorldBody {
  WorldBody(const LrbRep& r, const Pose& pose) : rep(r) {
    // World coordinates by the same function as in the query: the exact tests get the same doubles.
    for (const auto& v : r.vertices()) x.push_back(pose.apply(v));
    for (SimplexId s = 0; s < r.real_simplex_count(); ++s) {
      VertexId v[3];
      r.simplex(s, v);
      Box& box = boxes.emplace_back();
      for (int k = 0; k < r.simplex_size(); ++k) box.extend(x[v[k]]);
      whole.extend(box);
    }
  }
  void corners(SimplexId s, const double* out[3]) const {
    VertexId v[3];
    rep.simplex(s, v);
    for (int k = 0; k < rep.simplex_size(); ++k) out[k] = x[v[k]].data();
  }
  bool holds(const double* point) const {
    int crossings = 0;
    const double* c[3];
    // Parity of the crossings of a ray, over all simplices.
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      corners(s, c);
      const exact::RayHit hit =
          rep.dim() == 3 ? exact::ray_crosses(point, c) : exact::ray_crosses_2d(point, c);
      crossings += hit == exact::RayHit::crosses;
    }
    return crossings % 2 != 0;
  }
  const LrbRep& rep;
  std::vector<Eigen::Vector3d> x;
  std::vector<Box> boxes;  ///< (real simplices)
  Box whole;
};

/// Returns how many of the components of `inner` lie in `outer`.
std::size_t held(const WorldBody& inner, const WorldBody& outer) {
  const auto vertices = inner.rep.component_vertices();
  return static_cast<std::size_t>(std::count_if(vertices.begin(), vertices.end(),
                                                [&](VertexId v) { return outer.holds(inner.x[v].data()); }));
}

Relation relation_without_contact(const WorldBody& a, const WorldBody& b) {
  // A surface that is not closed has no inside: only disjoint boxes decide.
  if (!a.rep.closed() || !b.rep.closed())
    return a.whole.intersects(b.whole) ? Relation::undefined : Relation::separate;
  const std::size_t a_in_b = held(a, b), b_in_a = held(b, a);
  // A body that is entirely enclosed takes precedence: A is inside B unless all of B, but not all of A, is
  // enclosed.
  if (a_in_b > 0 &&
      (a_in_b == a.rep.component_vertices().size() || b_in_a != b.rep.component_vertices().size()))
    return Relation::a_inside_b;
  return b_in_a > 0 ? Relation::b_inside_a : Relation::separate;
}

}  // namespace

BruteForceResult brute_force(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  const FloatMode float_mode;
  check_query(a, pose_a, b, pose_b);
  const WorldBody wa(a, pose_a), wb(b, pose_b);
  BruteForceResult result;
  bool crosses = false;
  const double *ca[3], *cb[3];
  // Exact tests of all pairs but those whose boxes are disjoint, which cannot intersect: the boxes are those
  // of the very doubles that the tests get.
  const BoxTree tree(wb.boxes);
  std::vector<std::uint32_t> near;
  for (SimplexId s = 0; s < a.real_simplex_count(); ++s) {
    wa.corners(s, ca);
    near.clear();
    tree.for_each_in(wa.boxes[s], [&](std::uint32_t t) { near.push_back(t); });
    std::sort(near.begin(), near.end());
    for (const std::uint32_t t : near) {
      wb.corners(SimplexId(t), cb);
      const exact::Meet meet = a.dim() == 3 ? exact::meet_triangles(ca, cb) : exact::meet_segments(ca, cb);
      if (meet == exact::Meet::disjoint) continue;
      result.pairs.push_back({s, SimplexId(t)});
      result.meets.push_back(meet);
      if (result.pairs.size() > kMaxPairs) reject_pairs(kMaxPairs);
      crosses |= meet == exact::Meet::cross;
    }
  }
  if (result.pairs.empty())
    result.relation = relation_without_contact(wa, wb);
  else
    result.relation = crosses ? Relation::crossing : Relation::touching;
  return result;
}

}  // namespace lrb

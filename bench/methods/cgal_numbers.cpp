// CGAL, with its kernel of exact predicates and inexact constructions: near pairs by its intersecting boxes,
// of which those of A have grown by the distance, and by an AABB tree queried with such boxes.

#include "bench/methods/method.hpp"

#ifdef LRB_HAS_CGAL

#include <cmath>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/squared_distance_3.h>

#include "bench/methods/triangles.hpp"

namespace lrb::methods {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = Kernel::Triangle_3;
using Iterator = std::vector<Triangle>::const_iterator;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>>;
using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, Iterator>;

std::vector<Triangle> triangles(const LrbRep& rep) {
  const Triangles t = triangles_of(rep);
  const auto point = [&](VertexId v) {
    const Eigen::Vector3d& x = t.vertices[v];
    return Kernel::Point_3(x.x(), x.y(), x.z());
  };
  std::vector<Triangle> out;
  for (const auto& c : t.triangles) out.emplace_back(point(c[0]), point(c[1]), point(c[2]));
  return out;
}

CGAL::Bbox_3 grown(const CGAL::Bbox_3& b, double by) {
  return {b.xmin() - by, b.ymin() - by, b.zmin() - by, b.xmax() + by, b.ymax() + by, b.zmax() + by};
}

void add_if_near(const Question& q, const std::vector<Triangle>& a, Iterator s,
                 const std::vector<Triangle>& b, Iterator t, Answer& out) {
  const double square = CGAL::squared_distance(*s, *t);
  if (square <= q.within * q.within)
    add_near(out, {static_cast<SimplexId>(s - a.cbegin()), static_cast<SimplexId>(t - b.cbegin())},
             std::sqrt(square));
}

template <bool kMeasures>
Answer by_boxes(const Question& q, Setting) {
  const std::vector<Triangle> a = triangles(q.a), b = triangles(q.b);
  Answer out;
  const Stopwatch watch;
  std::vector<Box> boxes_a, boxes_b;
  for (Iterator s = a.cbegin(); s != a.cend(); ++s) boxes_a.emplace_back(grown(s->bbox(), q.within), s);
  for (Iterator t = b.cbegin(); t != b.cend(); ++t) boxes_b.emplace_back(t->bbox(), t);
  CGAL::box_intersection_d(boxes_a.begin(), boxes_a.end(), boxes_b.begin(), boxes_b.end(),
                           [&](const Box& s, const Box& t) {
                             if constexpr (kMeasures)
                               add_if_near(q, a, s.handle(), b, t.handle(), out);
                             else
                               add_near(out,
                                        {static_cast<SimplexId>(s.handle() - a.cbegin()),
                                         static_cast<SimplexId>(t.handle() - b.cbegin())},
                                        0);
                           });
  out.microseconds = watch.microseconds();
  sort_near(out);
  if (!kMeasures) out.distances.clear();
  return out;
}

Answer by_tree(const Question& q, Setting) {
  const std::vector<Triangle> a = triangles(q.a), b = triangles(q.b);
  Tree tree(b.cbegin(), b.cend());
  tree.build();
  Answer out;
  const Stopwatch watch;
  std::vector<Iterator> met;
  for (Iterator s = a.cbegin(); s != a.cend(); ++s) {
    tree.all_intersected_primitives(grown(s->bbox(), q.within), std::back_inserter(met));
    for (const Iterator t : met) add_if_near(q, a, s, b, t, out);
    met.clear();
  }
  out.microseconds = watch.microseconds();
  sort_near(out);
  return out;
}

MethodEntry cgal_method(const char* name, const char* what, const char* remark, Ask ask, MethodStyle style,
                        Traits traits = {Trait::hard_cases}) {
  return {{.name = name,
           .title = std::string("CGAL " CGAL_VERSION_STR ", ") + what,
           .remark = remark,
           .traits = traits,
           .style = std::move(style),
           .rank = 30,
           .quantity = Quantity::near_pairs},
          nullptr,
          std::move(ask)};
}

}  // namespace

std::vector<MethodEntry> cgal_numbers_methods() {
  return {cgal_method("cgal-boxes", "box_intersection_d, distances",
                      "box_intersection_d() of A's boxes grown by the distance and B's; squared_distance() "
                      "of the triangles.",
                      by_boxes<true>, {"CGAL, boxes", "#009e73", "triangle"}),
          cgal_method("cgal-boxes-only", "box_intersection_d", "Boxes only, no distances.", by_boxes<false>,
                      {"CGAL, boxes only", "#8f5bd9", "rectRot"}, {}),
          cgal_method("cgal-tree", "AABB_tree, distances",
                      "all_intersected_primitives() of B's tree for each box of A, grown by the distance; "
                      "squared_distance() of the triangles.",
                      by_tree, {"CGAL, AABB tree", "#4f7942", "star"})};
}

}  // namespace lrb::methods

#else

namespace lrb::methods {
std::vector<MethodEntry> cgal_numbers_methods() {
  return {};
}
}  // namespace lrb::methods

#endif

#include <nlohmann/json.hpp>

#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/properties.hpp"
#include "scenarios/run/explanations.hpp"
#include <lrbscope/explain.hpp>

namespace lrb::python {
namespace {

/// Explanations, with their bodies.
struct OfPair {
  PairExplanation reported;
  std::shared_ptr<const LrbRep> a, b;

  std::string text() const { return run::explanation_text(reported, *a, *b); }
  std::string json() const { return run::explanation_json(reported, *a, *b).dump(); }
};
struct OfWalk {
  WalkExplanation reported;
  std::shared_ptr<const LrbRep> a, b;
  Pose pose_a, pose_b;

  std::string text() const { return run::explanation_text(reported); }
  std::string json() const { return run::explanation_json(reported).dump(); }
};

OfPair explain_pair(const Given& given) {
  const TwoBodies two(given);
  const Integers pair = integers(given["pair"], {2});
  for (const std::int64_t n : {pair.at(0), pair.at(1)})
    if (n < 0 || n > kMaxId)
      throw InputError("pair: expected numbers of triangles, got " + std::to_string(n));
  const SimplexPair of{SimplexId(pair.at(0)), SimplexId(pair.at(1))};
  const py::gil_scoped_release unlocked;
  return {lrb::explain_pair(two.a.rep(), two.pose_a, two.b.rep(), two.pose_b(), of), two.a.shared(),
          two.b.shared()};
}

OfWalk explain_walk(const Given& given) {
  const TwoBodies two(given);
  const py::gil_scoped_release unlocked;
  return {lrb::explain_walk(two.a.rep(), two.pose_a, two.b.rep(), two.pose_b()), two.a.shared(),
          two.b.shared(), two.pose_a, two.pose_b()};
}

/// Returns the points of a contact, or the closest points of disjoint faces.
py::array_t<double> explained_points(const OfPair& e) {
  const PairExplanation& x = e.reported;
  if (x.meet == exact::Meet::disjoint) return column(x.nearest, std::identity());
  return column(std::span(x.contact.corners).first(static_cast<std::size_t>(x.contact.corner_count)),
                &exact::ContactCorner::x);
}

void bind_pair(py::module_& m) {
  py::class_<OfPair> c(
      m, "PairExplanation",
      R"(Why two triangles are in an answer or not. Made by explain_pair(). str() gives the explanation as text.)");
  c.def("__repr__", [](const OfPair& e) {
    return "<lrbscope.PairExplanation " + std::string(name_of(e.reported.meet)) + ", decided by " +
           std::string(name_of(e.reported.decided_by)) + ">";
  });
  const auto of_pair = properties_of(c, &OfPair::reported);
  of_pair("meet", "str: 'disjoint', 'touch' or 'cross'.", &PairExplanation::meet);
  of_pair("decided_by", "str: 'node_boxes', 'node_edges', 'face_boxes', 'planes', 'floats' or 'exact'.",
          &PairExplanation::decided_by);
  of_pair(
      "hidden_by",
      "((i,) uint32, (j,) uint32): the regions that hide the faces of A and B in the outermost wrapper, from the "
      "outside inward.",
      &PairExplanation::hidden_by);
  property(
      c, "points",
      "(c, 3) float64: corners of the triangles' intersection, or (2, 3) their closest points; world frame.",
      &explained_points);
  property(
      c, "distance", "float: of the triangles, in double arithmetic; the world's unit.",
      [](const OfPair& e) { return e.reported.meet == exact::Meet::disjoint ? e.reported.distance : 0.0; });
  define(c, "dict()\n\nReturns everything: a dict with the keys of `lrbscope why --pair --json`.",
         [](const OfPair& e) { return parsed_json(e.json()); });
  c.def("__str__", [](const OfPair& e) { return printable(e.text()); });
}

void bind_walk(py::module_& m) {
  py::class_<OfWalk> c(m, "WalkExplanation",
                       "How a query proceeded, and what proves two bodies separate. Made by explain_walk(). "
                       "str() gives the explanation as text.");
  c.def("__repr__", [](const OfWalk& e) {
    return "<lrbscope.WalkExplanation " + std::string(name_of(e.reported.result.relation)) + ">";
  });
  property(c, "result", "Result: the answer.", [](const OfWalk& e) {
    return Answer{std::make_shared<const CollideResult>(e.reported.result), e.a, e.b, e.pose_a, e.pose_b};
  });
  property(
      c, "plane",
      "((3,) float64, float, float) or None: normal n and numbers f < g with n x <= f for all of A, n x >= g for "
      "all of B.",
      [](const OfWalk& e) -> py::object {
        if (!e.reported.plane) return py::none();
        return py::make_tuple(to_python(e.reported.plane->normal), e.reported.plane->of_a,
                              e.reported.plane->of_b);
      });
  property(
      c, "near_pairs",
      R"((p, 2) uint32: triangle pairs that were compared individually and are disjoint, closest first; at most five.)",
      [](const OfWalk& e) { return column(e.reported.near, kPairOf); });
  define(c, "dict()\n\nReturns everything: a dict with the keys of `lrbscope why --json`.",
         [](const OfWalk& e) { return parsed_json(e.json()); });
  c.def("__str__", [](const OfWalk& e) { return printable(e.text()); });
}

}  // namespace

void bind_explain(py::module_& m) {
  bind_pair(m);
  bind_walk(m);
  define(m, R"(explain_pair(a, b, pair, pose_b=None, pose_a=None)

Explains why two triangles are in an answer or not: the box pairs from the roots of both trees down, then the
test that decides between the triangles.

pair: a triangle of A and one of B, as numbered in Result.pairs; poses: (4, 4). Returns a PairExplanation.

>>> e = explain_pair(cube, cube, (0, 0), shifted(5, 0, 0))
>>> e.meet, e.decided_by, e.distance
('disjoint', 'node_boxes', 5.0))",
         &explain_pair);
  define(m, R"(explain_walk(a, b, pose_b=None, pose_a=None)

Explains how the complete query traverses both trees and, for disjoint bodies, what proves them separate.

Poses: (4, 4). Returns a WalkExplanation.

>>> normal, of_a, of_b = explain_walk(cube, cube, shifted(5, 0, 0)).plane
>>> normal.tolist(), round(of_b - of_a, 9)
([1.0, 0.0, 0.0], 4.0))",
         &explain_walk);
}

}  // namespace lrb::python

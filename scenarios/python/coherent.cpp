#include "scenarios/python/coherent.hpp"

#include <mutex>

#include "engine/query/coherent/coherent_query.hpp"
#include "scenarios/python/answers.hpp"
#include "scenarios/python/request.hpp"

namespace lrb::python {
namespace {

/// A coherent query as Python has it, with its bodies.
struct HeldQuery {
  HeldQuery(BodyPtr of_a, BodyPtr of_b, const CollideRequest& request, CoherentQuery::CacheUse use)
      : a(std::move(of_a)), b(std::move(of_b)), query(a->rep(), b->rep(), request, use) {}

  BodyPtr a, b;
  CoherentQuery query;
  std::mutex mutex;  ///< it is asked by one thread at a time
};
using HeldQueryPtr = std::shared_ptr<HeldQuery>;

HeldQueryPtr make(py::handle a, py::handle b, py::handle mode, py::handle contacts,
                  py::handle interiors_overlap, py::handle max_pairs, py::handle always) {
  const py::none no;
  const CollideRequest request =
      request_of({mode, contacts, interiors_overlap, no, no, no, no, max_pairs, no});
  const auto use =
      flag(always, "always") ? CoherentQuery::CacheUse::always : CoherentQuery::CacheUse::as_it_pays;
  return std::make_shared<HeldQuery>(shared_body(a, "a"), shared_body(b, "b"), request, use);
}

Answer collide_next(HeldQuery& self, py::handle pose_b, py::handle pose_a) {
  const Pose at_a = pose(pose_a, "pose_a"), at_b = pose(pose_b, "pose_b");
  auto result = std::make_shared<CollideResult>();
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard lock(self.mutex);
    *result = self.query.collide(at_a, at_b);
  }
  return {std::move(result), self.a->shared(), self.b->shared()};
}

py::dict statistics(HeldQuery& self) {
  CoherentQuery::Statistics s;
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard lock(self.mutex);
    s = self.query.statistics();
  }
  py::dict d;
  d["from_cache"] = s.from_cache;
  d["caches_made"] = s.caches_made;
  d["swept_caches"] = s.swept_caches;
  d["from_scratch"] = s.from_scratch;
  d["tests_saved"] = s.tests_saved;
  return d;
}

constexpr const char* kCoherentText =
    R"(CoherentQuery(a, b, *, mode='all', contacts=False, interiors_overlap=False, max_pairs=0, always=False)

Asks about two bodies again and again as they move by little from one call to the next: keeps the pairs that may meet near
the last poses, and tests only these. Answers are those of collide(); with mode 'first' or 'any' it may be another pair.

For the options see collide(). always: keep pairs even where queries from scratch are found to be faster (for tests).

>>> q = CoherentQuery(cube, cube)
>>> [q.collide(shifted(x, 0.25, 0.125)).relation for x in (0.5, 0.51, 1.5)]
['crossing', 'crossing', 'separate'])";

}  // namespace

void bind_coherent(py::module_& m) {
  const py::none no;
  py::class_<HeldQuery, HeldQueryPtr> c(m, "CoherentQuery", kCoherentText);
  c.def(py::init(&make), py::arg("a"), py::arg("b"), py::kw_only(), py::arg("mode") = no,
        py::arg("contacts") = no, py::arg("interiors_overlap") = no, py::arg("max_pairs") = no,
        py::arg("always") = no, kCoherentText);
  c.def(
      "collide", &collide_next, py::arg("pose_b") = no, py::arg("pose_a") = no,
      "collide(pose_b=None, pose_a=None)\n\nReturns the Result for these poses, (4, 4); None: the identity.");
  c.def_property_readonly(
      "statistics", &statistics,
      "dict of int: queries answered from_cache, caches_made for a query (swept_caches of them for "
      "a motion),\nqueries from_scratch, tests_saved.");
  c.def_property_readonly(
      "a", [](const HeldQuery& q) { return q.a; }, "Body");
  c.def_property_readonly(
      "b", [](const HeldQuery& q) { return q.b; }, "Body");
}

}  // namespace lrb::python

#include "scenarios/python/distance.hpp"

#include "engine/query/distance/distance_impl.hpp"
#include "scenarios/python/answers.hpp"
#include "scenarios/python/batch.hpp"

namespace lrb::python {
namespace {

using Found = std::shared_ptr<const DistanceResult>;

struct Distance {
  Found result;
};
struct Distances {
  std::shared_ptr<const std::vector<DistanceResult>> all;
  Distance at(std::size_t i) const { return {Found(all, &(*all)[i])}; }
};

DistanceContext& own_context() {
  thread_local DistanceContext context;
  return context;
}

py::object distance(py::handle a, py::handle b, py::handle poses_b, py::handle pose_a, py::handle within,
                    py::handle tolerance, py::handle relative_tolerance, py::handle max_steps,
                    py::handle relation, py::handle threads) {
  const Body &body_a = body(a, "a"), &body_b = body(b, "b");
  const Poses at = poses(poses_b, "poses_b");
  const Pose at_a = pose(pose_a, "pose_a");
  DistanceRequest request;
  if (!within.is_none()) request.within = size(within, "within");
  request.tolerance = size(tolerance, "tolerance");
  request.relative_tolerance = size(relative_tolerance, "relative_tolerance");
  request.max_steps = count(max_steps, "max_steps");
  request.relation = flag(relation, "relation", true);
  if (at.one) {
    auto result = std::make_shared<DistanceResult>();
    {
      const py::gil_scoped_release unlocked;
      *result = lrb::distance(body_a.rep(), at_a, body_b.rep(), at.first, request, own_context());
    }
    return py::cast(Distance{std::move(result)});
  }
  const unsigned n = threads_of(count(threads, "threads"));
  auto results = std::make_shared<std::vector<DistanceResult>>(at.many.size());
  std::vector<DistanceContext> contexts(n);
  run_batch(at.many.size(), n, [&](std::size_t i, unsigned worker) {
    (*results)[i] = lrb::distance(body_a.rep(), at_a, body_b.rep(), at.many[i], request, contexts[worker]);
  });
  return py::cast(Distances{std::move(results)});
}

py::array_t<double> points_of(const DistanceResult& r) {
  py::array_t<double> out({2, 3});
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i < 3; ++i) out.mutable_data()[3 * side + i] = r.witness[side].point[i];
  return out;
}

/// Returns an id as Python has it: None if there is none.
template <class Id>
py::object id_of(Id id) {
  if (id == kNull) return py::none();
  return py::int_(id.value());
}

const char* feature_of(const Witness& w) {
  return w.feature.dim == 0 ? "corner" : w.feature.dim == 1 ? "edge" : "inside";
}

py::array_t<std::uint32_t> corners_of(const Witness& w) {
  return array_of_ids(std::span<const VertexId>(w.corners.data(), static_cast<std::size_t>(w.corner_count)));
}

py::dict counters_of(const DistanceCounters& c) {
  py::dict d;
  d["steps"] = c.steps;
  d["box_tests"] = c.box_tests;
  d["pairs_in_floats"] = c.pairs_in_floats;
  d["pairs_in_doubles"] = c.pairs_in_doubles;
  d["pairs_exact"] = c.pairs_exact;
  return d;
}

std::string shown(const Distance& d) {
  const std::string lower = py::str(py::float_(d.result->lower)),
                    upper = py::str(py::float_(d.result->upper));
  return "<lrbscope.Distance in [" + lower + ", " + upper + "]>";
}

void bind_single_distance(py::module_& m) {
  py::class_<Distance> c(
      m, "Distance",
      "How far two surfaces are apart: an interval that is proved to hold the distance. Made by distance().");
  c.def_property_readonly(
      "lower", [](const Distance& d) { return d.result->lower; }, "float: the world's unit.");
  c.def_property_readonly(
      "upper", [](const Distance& d) { return d.result->upper; }, "float: the world's unit.");
  c.def_property_readonly(
      "solids",
      [](const Distance& d) { return py::make_tuple(d.result->solids_lower(), d.result->solids_upper()); },
      "(float, float): the interval for the solids: 0 also where one body holds the other.");
  c.def_property_readonly(
      "meet", [](const Distance& d) { return d.result->meet; }, "bool: the surfaces have a point in common.");
  c.def_property_readonly(
      "within",
      [](const Distance& d) {
        return d.result->within ? py::object(py::bool_(*d.result->within)) : py::object(py::none());
      },
      "bool or None: the answer to `within`, if it was asked and found.");
  c.def_property_readonly(
      "finished", [](const Distance& d) { return d.result->finished; }, "bool: no limit was reached.");
  c.def_property_readonly(
      "relation", [](const Distance& d) { return py::str(to_string(d.result->relation)); },
      "str: as Result.relation; of surfaces that meet, what the first pair shows.");
  c.def_property_readonly(
      "points", [](const Distance& d) { return points_of(*d.result); },
      "(2, 3) float64: the nearest points of A and of B, world frame.");
  c.def_property_readonly(
      "triangles",
      [](const Distance& d) {
        return py::make_tuple(id_of(d.result->witness[0].simplex), id_of(d.result->witness[1].simplex));
      },
      "(int, int): the triangles that these lie on; None of a body without faces.");
  c.def_property_readonly(
      "faces",
      [](const Distance& d) {
        return py::make_tuple(id_of(d.result->witness[0].face), id_of(d.result->witness[1].face));
      },
      "(int, int): the faces of these.");
  c.def_property_readonly(
      "features",
      [](const Distance& d) {
        return py::make_tuple(feature_of(d.result->witness[0]), feature_of(d.result->witness[1]));
      },
      "(str, str): 'corner', 'edge' or 'inside' of the triangle.");
  c.def_property_readonly(
      "corners",
      [](const Distance& d) {
        return py::make_tuple(corners_of(d.result->witness[0]), corners_of(d.result->witness[1]));
      },
      "((i,) uint32, (j,) uint32): the vertices that span the features.");
  c.def_property_readonly(
      "counters", [](const Distance& d) { return counters_of(d.result->counters); },
      "dict: the work, in numbers of operations.");
  c.def(
      "__float__", [](const Distance& d) { return d.result->upper; }, "The upper end.");
  c.def("__repr__", &shown);
}

py::array_t<double> ends_of(const Distances& d, double DistanceResult::*end) {
  py::array_t<double> out(static_cast<py::ssize_t>(d.all->size()));
  for (std::size_t i = 0; i < d.all->size(); ++i) out.mutable_data()[i] = (*d.all)[i].*end;
  return out;
}

void bind_distances(py::module_& m) {
  py::class_<Distances> c(m, "Distances",
                          "Distances for k poses: a sequence of Distance, in the order of the poses.");
  c.def("__len__", [](const Distances& d) { return d.all->size(); });
  c.def("__getitem__",
        [](const Distances& d, py::ssize_t i) { return d.at(checked_index(i, d.all->size())); });
  c.def_property_readonly(
      "lower", [](const Distances& d) { return ends_of(d, &DistanceResult::lower); }, "(k,) float64");
  c.def_property_readonly(
      "upper", [](const Distances& d) { return ends_of(d, &DistanceResult::upper); }, "(k,) float64");
}

}  // namespace

py::object distance_object(DistanceResult result) {
  return py::cast(Distance{std::make_shared<DistanceResult>(std::move(result))});
}

void bind_distance(py::module_& m) {
  bind_single_distance(m);
  bind_distances(m);
  const py::none no;
  m.def("distance", &distance, py::arg("a"), py::arg("b"), py::arg("poses_b") = no, py::arg("pose_a") = no,
        py::kw_only(), py::arg("within") = no, py::arg("tolerance") = no, py::arg("relative_tolerance") = no,
        py::arg("max_steps") = no, py::arg("relation") = no, py::arg("threads") = no,
        R"(distance(a, b, poses_b=None, pose_a=None, *, within=None, tolerance=0, relative_tolerance=0,
         max_steps=0, relation=True, threads=0)

Finds how far the surfaces of two bodies are apart, as an interval that is proved to hold the distance.

poses_b: (4, 4) float, or (k, 4, 4) for many poses on all cores; pose_a: (4, 4). None: the identity.
within: ask only whether they are this near (the world's unit): Distance.within.
tolerance (the world's unit), relative_tolerance: how wide the interval may be. 0, 0: about 1e-12 of the
bodies' size. max_steps: of the search; 0: no limit. relation: decide how bodies lie whose surfaces do not
meet.

Returns a Distance, or for (k, 4, 4) a Distances.

>>> d = distance(cube, cube, shifted(3, 0, 0))
>>> d.lower <= 2 <= d.upper, d.points[:, 0].tolist()
(True, [1.0, 3.0]))");
}

}  // namespace lrb::python

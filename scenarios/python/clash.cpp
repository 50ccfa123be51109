#include "scenarios/python/clash.hpp"

#include "engine/query/clash/clash.hpp"
#include "scenarios/python/answers.hpp"
#include "scenarios/python/batch.hpp"

namespace lrb::python {
namespace {

py::object clash(py::handle a, py::handle b, py::handle poses_b, py::handle pose_a, py::handle clearance,
                 py::handle along, py::handle depth, py::handle volume, py::handle threads) {
  const Body &body_a = body(a, "a"), &body_b = body(b, "b");
  const Poses at = poses(poses_b, "poses_b");
  const Pose at_a = pose(pose_a, "pose_a");
  ClashRequest request;
  request.clearance = size(clearance, "clearance");
  if (!along.is_none()) request.along = vector(along, "along");
  request.depth = flag(depth, "depth", request.depth);
  request.volume = flag(volume, "volume", request.volume);
  const std::vector<Pose> each = at.to_vector();
  std::vector<ClashResult> results(each.size());
  const unsigned n = at.one ? 1 : threads_of(count(threads, "threads"));
  run_batch(each.size(), n, [&](std::size_t i, unsigned) {
    results[i] = lrb::clash(body_a.rep(), at_a, body_b.rep(), each[i], request);
  });
  if (at.one) return py::cast(std::move(results[0]));
  py::list out;
  for (ClashResult& result : results) out.append(std::move(result));
  return out;
}

py::object ends_of(const std::optional<ProvedInterval>& interval) {
  if (!interval) return py::none();
  return py::make_tuple(interval->lower, interval->upper);
}

py::object overlap_of(const ClashResult& r) {
  if (r.interiors_overlap == lrb::Answer::unknown) return py::none();
  return py::bool_(r.interiors_overlap == lrb::Answer::yes);
}

void bind_result(py::module_& m) {
  py::class_<ClashResult> c(
      m, "Clash",
      "What kind of contact two solids have, and how deep. Lengths are the world's unit; "
      "intervals are proved to\nhold what they say. Made by clash().");
  c.def_property_readonly(
      "kind", [](const ClashResult& r) { return py::str(to_string(r.kind)); },
      "str: 'apart', 'within_clearance', 'touching_point', 'touching_edge', 'touching_face', 'protrudes',\n"
      "'pierces' (A goes through B), 'cuts_through' (A parts B), 'a_inside_b', 'b_inside_a', 'equal',\n"
      "'undecided' (see `reason`).");
  c.def_property_readonly(
      "reason",
      [](const ClashResult& r) -> py::object {
        if (r.reason == ClashReason::none) return py::none();
        return py::str(std::string(name_of(r.reason)));
      },
      "str or None: why the kind is 'undecided', as 'A intersects itself'; None if it is decided.");
  c.def_property_readonly("interiors_overlap", &overlap_of,
                          "bool or None: whether the solids share a volume; None where that is not known.");
  c.def_readonly("shares_faces", &ClashResult::shares_faces,
                 "bool: the surfaces coincide over an area, with both solids on the same side of it.");
  c.def_property_readonly(
      "distance", [](const ClashResult& r) { return ends_of(r.distance); }, "(float, float): of the solids.");
  c.def_property_readonly(
      "depth", [](const ClashResult& r) { return ends_of(r.depth); },
      "(float, float) or None: the length of the shortest way for B after which they share no volume.");
  c.def_property_readonly(
      "translation", [](const ClashResult& r) { return array_of(r.translation); },
      "(3,) float64: moved by this, B is proved to share no volume with A; its length is depth[1].");
  c.def_property_readonly(
      "along", [](const ClashResult& r) { return ends_of(r.along); },
      "(float, float) or None: how far B has to move in the direction that was given.");
  c.def_property_readonly(
      "volume", [](const ClashResult& r) { return ends_of(r.volume); },
      "(float, float) or None: the volume that they share, unit cubed.");
  c.def("__repr__",
        [](const ClashResult& r) { return "<lrbscope.Clash " + std::string(to_string(r.kind)) + ">"; });
}

}  // namespace

void bind_clash(py::module_& m) {
  bind_result(m);
  const py::none no;
  m.def("clash", &clash, py::arg("a"), py::arg("b"), py::arg("poses_b") = no, py::arg("pose_a") = no,
        py::kw_only(), py::arg("clearance") = no, py::arg("along") = no, py::arg("depth") = no,
        py::arg("volume") = no, py::arg("threads") = no,
        R"(clash(a, b, poses_b=None, pose_a=None, *, clearance=0, along=None, depth=True, volume=True,
      threads=0)

Finds what kind of contact two solids have, and how deep it is.

poses_b: (4, 4) float, or (k, 4, 4) for many poses on all cores; pose_a: (4, 4). None: the identity.
clearance: solids that are no further apart are 'within_clearance'; the world's unit.
along: (3,), a direction along which B is to leave A. depth, volume: whether to find these.

Returns a Clash, or for (k, 4, 4) a list of them.

>>> c = clash(cube, cube, shifted(0.75, 0.25, 0.125))
>>> c.kind, c.depth[0] <= 0.25 <= c.depth[1]
('protrudes', True))");
}

}  // namespace lrb::python

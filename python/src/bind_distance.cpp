#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/workspace.hpp>

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
  std::vector<Workspace> workspaces(n);
  run_batch(each.size(), n, [&](std::size_t i, unsigned worker) {
    results[i] =
        std::move(lrb::clash(body_a.rep(), at_a, body_b.rep(), each[i], request, workspaces[worker]).value());
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
      "Kind and depth of the contact of two solids. Lengths are in the world's unit; intervals "
      "are proven\n"
      "bounds. Made by clash().");
  c.def_property_readonly(
      "kind", [](const ClashResult& r) { return py::str(to_string(r.kind)); },
      "str: 'apart' (separate), 'within_clearance', 'touching_point', 'touching_edge', "
      "'touching_face', 'protrudes',\n"
      "'pierces' (A passes through B), 'cuts_through' (A divides B), 'a_inside_b', "
      "'b_inside_a', 'equal',\n"
      "'undecided' (see `reason`).");
  c.def_property_readonly(
      "reason",
      [](const ClashResult& r) -> py::object {
        if (r.reason == ClashReason::none) return py::none();
        return py::str(std::string(name_of(r.reason)));
      },
      "str or None: why the kind is 'undecided', such as 'A intersects itself'; None if it is "
      "decided.");
  c.def_property_readonly("interiors_overlap", &overlap_of,
                          "bool or None: True if the solids share a volume; None if not known.");
  c.def_readonly("shares_faces", &ClashResult::shares_faces,
                 "bool: the surfaces coincide over an area, with both solids on the same side of it.");
  c.def_property_readonly(
      "distance", [](const ClashResult& r) { return ends_of(r.distance); }, "(float, float): of the solids.");
  c.def_property_readonly(
      "depth", [](const ClashResult& r) { return ends_of(r.depth); },
      "(float, float) or None: length of the shortest translation of B after which they share "
      "no volume.");
  c.def_property_readonly(
      "translation", [](const ClashResult& r) { return array_of(r.translation); },
      "(3,) float64: after this translation, B is proven to share no volume with A; its length "
      "is depth[1].");
  c.def_property_readonly(
      "along", [](const ClashResult& r) { return ends_of(r.along); },
      "(float, float) or None: how far B has to move in the given direction.");
  c.def_property_readonly(
      "volume", [](const ClashResult& r) { return ends_of(r.volume); },
      "(float, float) or None: the shared volume, unit cubed.");
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

Finds the kind and depth of the contact of two solids.

poses_b: (4, 4) float, or (k, 4, 4) for many poses on all cores; pose_a: (4, 4). None: the identity.
clearance: solids at this distance or less are 'within_clearance'; the world's unit.
along: (3,), a direction in which B is to leave A. depth, volume: whether to compute them.

Returns a Clash, or for (k, 4, 4) a list of them.

>>> c = clash(cube, cube, shifted(0.75, 0.25, 0.125))
>>> c.kind, c.depth[0] <= 0.25 <= c.depth[1]
('protrudes', True))");
}

namespace {

using Found = std::shared_ptr<const DistanceResult>;

struct Distance {
  Found result;
};
struct Distances {
  std::shared_ptr<const std::vector<DistanceResult>> all;
  Distance at(std::size_t i) const { return {Found(all, &(*all)[i])}; }
};

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
      *result = lrb::distance(body_a.rep(), at_a, body_b.rep(), at.first, request, own_workspace()).value();
    }
    return py::cast(Distance{std::move(result)});
  }
  const unsigned n = threads_of(count(threads, "threads"));
  auto results = std::make_shared<std::vector<DistanceResult>>(at.many.size());
  std::vector<Workspace> workspaces(n);
  run_batch(at.many.size(), n, [&](std::size_t i, unsigned worker) {
    (*results)[i] =
        lrb::distance(body_a.rep(), at_a, body_b.rep(), at.many[i], request, workspaces[worker]).value();
  });
  return py::cast(Distances{std::move(results)});
}

py::array_t<double> points_of(const DistanceResult& r) {
  py::array_t<double> out({2, 3});
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i < 3; ++i) out.mutable_data()[3 * side + i] = r.witness[side].point[i];
  return out;
}

/// Returns an id as a Python int, or None for kNull.
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
  py::class_<Distance> c(m, "Distance",
                         "Distance of two surfaces, as a proven interval. Made by distance().");
  c.def_property_readonly(
      "lower", [](const Distance& d) { return d.result->lower; }, "float: the world's unit.");
  c.def_property_readonly(
      "upper", [](const Distance& d) { return d.result->upper; }, "float: the world's unit.");
  c.def_property_readonly(
      "solids",
      [](const Distance& d) { return py::make_tuple(d.result->solids_lower(), d.result->solids_upper()); },
      "(float, float): the interval for the solids; also 0 if one body contains the other.");
  c.def_property_readonly(
      "meet", [](const Distance& d) { return d.result->meet; }, "bool: the surfaces have a point in common.");
  c.def_property_readonly(
      "within",
      [](const Distance& d) {
        return d.result->within ? py::object(py::bool_(*d.result->within)) : py::object(py::none());
      },
      "bool or None: True if the distance is at most `within`; None if not requested or not "
      "decided.");
  c.def_property_readonly(
      "finished", [](const Distance& d) { return d.result->finished; }, "bool: no limit was reached.");
  c.def_property_readonly(
      "relation", [](const Distance& d) { return py::str(to_string(d.result->relation)); },
      "str: as Result.relation; for intersecting surfaces, derived from the first pair.");
  c.def_property_readonly(
      "points", [](const Distance& d) { return points_of(*d.result); },
      "(2, 3) float64: the closest points of A and of B, world frame.");
  c.def_property_readonly(
      "triangles",
      [](const Distance& d) {
        return py::make_tuple(id_of(d.result->witness[0].simplex), id_of(d.result->witness[1].simplex));
      },
      "(int, int): the triangles of these points; None for a body without faces.");
  c.def_property_readonly(
      "faces",
      [](const Distance& d) {
        return py::make_tuple(id_of(d.result->witness[0].face), id_of(d.result->witness[1].face));
      },
      "(int, int): the faces of these triangles.");
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
  bind_iterator(c);
  c.def("__repr__", [](const Distances& d) {
    return "<lrbscope.Distances of " + std::to_string(d.all->size()) + " poses>";
  });
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

Finds the distance of the surfaces of two bodies, as a proven interval.

poses_b: (4, 4) float, or (k, 4, 4) for many poses on all cores; pose_a: (4, 4). None: the identity.
within: only decide whether the distance is at most this (the world's unit): Distance.within.
tolerance (the world's unit), relative_tolerance: maximum width of the interval. 0, 0: about 1e-12 of the
bodies' size. max_steps: of the search; 0: no limit. relation: determine the relation of bodies whose
surfaces do not intersect.

Returns a Distance, or for (k, 4, 4) a Distances.

>>> d = distance(cube, cube, shifted(3, 0, 0))
>>> d.lower <= 2 <= d.upper, d.points[:, 0].tolist()
(True, [1.0, 3.0]))");
}

namespace {

struct FirstContact {
  std::shared_ptr<const FirstContactResult> result;
};
struct FirstContacts {
  std::shared_ptr<const std::vector<FirstContactResult>> all;
  FirstContact at(std::size_t i) const { return {{all, &(*all)[i]}}; }
};

/// Returns the motion through poses at equally spaced times from 0 to 1; a single pose is at rest.
Motion motion_through(std::span<const Pose> poses) {
  if (poses.size() == 1) return Motion::still(poses[0]);
  std::vector<Motion::KeyFrame> frames;
  const auto last = static_cast<double>(poses.size() - 1);
  for (std::size_t i = 0; i < poses.size(); ++i) frames.push_back({static_cast<double>(i) / last, poses[i]});
  return Motion::key_frames(frames);
}

/// Motions of a body, and whether a single one was given.
struct Motions {
  std::vector<Motion> all;
  bool one = true;
};

/// Reads (4, 4), at rest, or (m, 4, 4), through m poses, as one motion; (k, m, 4, 4) as many.
Motions motions(py::handle given, const char* what) {
  const bool many = py::isinstance<py::array>(given) && py::reinterpret_borrow<py::array>(given).ndim() == 4;
  Motions out;
  out.one = !many;
  const py::list each = many ? py::list(py::reinterpret_borrow<py::object>(given)) : py::list();
  const auto add = [&](py::handle one) {
    const std::vector<Pose> through = poses(one, what).to_vector();
    if (through.empty()) throw InputError(std::string(what) + ": expected at least one pose, got none");
    out.all.push_back(motion_through(through));
  };
  if (!many) add(given);
  for (const py::handle one : each) add(one);
  return out;
}

py::object first_contact(py::handle a, py::handle b, py::handle motion_b, py::handle motion_a,
                         py::handle tolerance, py::handle max_steps, py::handle relation,
                         py::handle threads) {
  const Body &body_a = body(a, "a"), &body_b = body(b, "b");
  const Motions of_b = motions(motion_b, "motion_b"), of_a = motions(motion_a, "motion_a");
  if (!of_a.one) throw InputError("motion_a: expected one motion, (m, 4, 4)");
  FirstContactRequest request;
  request.tolerance = size(tolerance, "tolerance", request.tolerance);
  request.max_steps = count(max_steps, "max_steps", request.max_steps);
  request.relation = flag(relation, "relation", true);
  auto results = std::make_shared<std::vector<FirstContactResult>>(of_b.all.size());
  const unsigned n = of_b.one ? 1 : threads_of(count(threads, "threads"));
  // Runs in a batch even for a single motion, because it can take long: Ctrl-C ends the wait.
  std::vector<Workspace> workspaces(n);
  run_batch(of_b.all.size(), n, [&](std::size_t i, unsigned worker) {
    (*results)[i] = std::move(
        lrb::first_contact(body_a.rep(), of_a.all[0], body_b.rep(), of_b.all[i], request, workspaces[worker])
            .value());
  });
  const FirstContacts found{std::move(results)};
  return of_b.one ? py::cast(found.at(0)) : py::cast(found);
}

py::array_t<double> contact_points_of(const FirstContact& f) {
  const std::array<Eigen::Vector3d, 2> points{f.result->witness[0].point, f.result->witness[1].point};
  return array_of(points);
}

py::object pair_of(const FirstContact& f) {
  if (f.result->pair.a == kNull) return py::none();
  return py::make_tuple(f.result->pair.a.value(), f.result->pair.b.value());
}

py::array_t<double> ambiguous_of(const FirstContact& f) {
  const std::vector<TimeSpan>& spans = f.result->ambiguous;
  static_assert(sizeof(TimeSpan) == 2 * sizeof(double));
  return py::array_t<double>({static_cast<py::ssize_t>(spans.size()), py::ssize_t{2}},
                             reinterpret_cast<const double*>(spans.data()));
}

py::dict counters_of(const FirstContactCounters& c) {
  py::dict d;
  d["spans"] = c.spans;
  d["pairs"] = c.pairs;
  d["steps"] = c.steps;
  d["exact_queries"] = c.exact_queries;
  return d;
}

template <class Value>
py::str word_of(Value value) {
  return py::str(std::string(name_of(value)));
}

void bind_single_contact(py::module_& m) {
  py::class_<FirstContact> c(
      m, "FirstContact",
      "First contact of two moving bodies, as a proven interval of the time t from 0 to 1. Made"
      " by\n"
      "first_contact().");
  const auto get = [&c](const char* name, auto member, const char* text) {
    c.def_property_readonly(
        name, [member](const FirstContact& f) { return (*f.result).*member; }, text);
  };
  c.def_property_readonly(
      "outcome", [](const FirstContact& f) { return word_of(f.result->outcome); },
      "str: 'contact'; 'never', which is proven; 'undecided': too close to each other for "
      "double precision.");
  get("t0", &FirstContactResult::t0, "float: no contact before this time; 1 if never.");
  get("t1", &FirstContactResult::t1,
      "float: in contact at this time; if undecided, no contact after it; 1 if never.");
  get("at_start", &FirstContactResult::at_start, "bool: in contact at t = 0.");
  get("grazing", &FirstContactResult::grazing,
      "bool: the interval is wider than requested, because of an earlier tangential contact.");
  get("passed", &FirstContactResult::passed,
      "bool: in contact at some time up to t1, though not at t1 itself.");
  get("finished", &FirstContactResult::finished, "bool: no step limit was reached.");
  c.def_property_readonly(
      "unresolved",
      [](const FirstContact& f) -> py::object {
        if (f.result->unresolved == Unresolved::nothing) return py::none();
        return word_of(f.result->unresolved);
      },
      "str or None: why the interval is wider than requested, or contact in it is undecided: "
      "'rounding': the\n"
      "bodies are as close as rounding errors; 'steps': a step limit was reached.");
  get("speed", &FirstContactResult::speed,
      "float: approach speed of the closest points along the normal; world's unit per unit of "
      "t.");
  c.def_property_readonly(
      "at_begin", [](const FirstContact& f) { return word_of(f.result->at_begin); },
      "str: relation of the bodies at the start, as Result.relation.");
  c.def_property_readonly("ambiguous", &ambiguous_of, "(d, 2) float64: time intervals that are undecided.");
  c.def_property_readonly("pair", &pair_of,
                          "(int, int) or None: triangles of A and of B that intersect at t1.");
  c.def_property_readonly("points", &contact_points_of,
                          "(2, 3) float64: the closest points of A and of B at t0, world frame.");
  c.def_property_readonly(
      "normal", [](const FirstContact& f) { return array_of(f.result->normal); },
      "(3,) float64: unit, from A to B, at t0; 0 at the start, and if it is below rounding "
      "errors.");
  c.def_property_readonly(
      "counters", [](const FirstContact& f) { return counters_of(f.result->counters); },
      "dict: the work, in numbers of operations.");
  c.def(
      "__bool__", [](const FirstContact& f) { return f.result->is_contact(); },
      "True if the outcome is 'contact'.");
  c.def("__repr__", [](const FirstContact& f) {
    const std::string t0 = py::str(py::float_(f.result->t0)), t1 = py::str(py::float_(f.result->t1));
    return "<lrbscope.FirstContact " + std::string(name_of(f.result->outcome)) + ", t in [" + t0 + ", " + t1 +
           "]>";
  });
}

void bind_first_contacts(py::module_& m) {
  py::class_<FirstContacts> c(m, "FirstContacts",
                              "First contacts for k motions: a sequence of FirstContact, in their order.");
  c.def("__len__", [](const FirstContacts& f) { return f.all->size(); });
  c.def("__getitem__",
        [](const FirstContacts& f, py::ssize_t i) { return f.at(checked_index(i, f.all->size())); });
  bind_iterator(c);
  c.def("__repr__", [](const FirstContacts& f) {
    return "<lrbscope.FirstContacts of " + std::to_string(f.all->size()) + " motions>";
  });
  const auto ends = [&c](const char* name, double FirstContactResult::*end, const char* text) {
    c.def_property_readonly(
        name,
        [end](const FirstContacts& f) {
          py::array_t<double> out(static_cast<py::ssize_t>(f.all->size()));
          for (std::size_t i = 0; i < f.all->size(); ++i) out.mutable_data()[i] = (*f.all)[i].*end;
          return out;
        },
        text);
  };
  ends("t0", &FirstContactResult::t0, "(k,) float64: FirstContact.t0 of each.");
  ends("t1", &FirstContactResult::t1, "(k,) float64: FirstContact.t1 of each.");
}

}  // namespace

void bind_first_contact(py::module_& m) {
  bind_single_contact(m);
  bind_first_contacts(m);
  const py::none no;
  m.def("first_contact", &first_contact, py::arg("a"), py::arg("b"), py::arg("motion_b"),
        py::arg("motion_a") = no, py::kw_only(), py::arg("tolerance") = no, py::arg("max_steps") = no,
        py::arg("relation") = no, py::arg("threads") = no,
        R"(first_contact(a, b, motion_b, motion_a=None, *, tolerance=1e-9, max_steps=10000000, relation=True,
              threads=0)

Finds the time of impact of the surfaces of two moving bodies, as a proven interval of t.

motion_b: (m, 4, 4) float, m >= 2: rigid poses at equally spaced times from t = 0 to t = 1. In between, B
    rotates by the shortest arc and its origin moves on a straight line. (4, 4): at rest. (k, m, 4, 4):
    k motions, on all cores.
motion_a: (m, 4, 4) or (4, 4); None: at rest at the identity.
tolerance: maximum width of the interval, in t. max_steps: step limit in addition to the built-in limit;
    0: only the built-in limit.
relation: determine the relation at the start of bodies that are not in contact then.

Returns a FirstContact, or for (k, m, 4, 4) a FirstContacts.

>>> f = first_contact(cube, cube, [shifted(3, 0.1, 0.2), shifted(0, 0.1, 0.2)])
>>> f.outcome, round(f.t0, 6)
('contact', 0.666667))");
}

}  // namespace lrb::python

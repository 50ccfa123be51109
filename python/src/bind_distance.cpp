#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/properties.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/trace/answer_fields.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::python {

namespace {

py::object clash(const Given& given) {
  const TwoBodies two(given);
  ClashRequest request;
  request.clearance = size(given["clearance"]);
  if (const Argument along = given["along"]; !along.is_none()) request.along = vector(along);
  request.depth = flag(given["depth"], request.depth);
  request.volume = flag(given["volume"], request.volume);
  request.max_steps = count(given["max_steps"], request.max_steps);
  std::vector<ClashResult> found =
      ask_poses<ClashResult>(two.poses_b, given, [&](const Pose& pose_b, Workspace& memory) {
        return lrb::clash(two.a.rep(), two.pose_a, two.b.rep(), pose_b, request, memory);
      });
  return two.poses_b.one ? py::cast(std::move(found[0])) : py::cast(std::move(found));
}

void bind_clash(py::module_& m) {
  py::class_<ClashResult> c(
      m, "Clash",
      R"(Kind and depth of the contact of two solids. Lengths are in the world's unit; intervals are proven
bounds. Made by clash().)");
  property(
      c, "kind",
      R"(str: 'apart' (separate), 'within_clearance', 'touching_point', 'touching_edge', 'touching_face', 'protrudes',
'pierces' (A passes through B), 'cuts_through' (A divides B), 'a_inside_b', 'b_inside_a', 'equal',
'undecided' (see `reason`).)",
      &ClashResult::kind);
  property(c, "reason",
           "str or None: why the kind is 'undecided', such as 'A intersects itself'; None if it is decided.",
           [](const ClashResult& r) {
             return r.reason == ClashReason::none ? std::nullopt : std::optional(r.reason);
           });
  property(c, "interiors_overlap", "bool or None: True if the solids share a volume; None if not known.",
           &ClashResult::interiors_overlap);
  property(c, "shares_faces",
           "bool: the surfaces coincide over an area, with both solids on the same side of it.",
           &ClashResult::shares_faces);
  property(c, "distance", "(float, float): of the solids.", &ClashResult::distance);
  property(
      c, "depth",
      "(float, float) or None: length of the shortest translation of B after which they share no volume.",
      &ClashResult::depth);
  property(
      c, "translation",
      "(3,) float64: after this translation, B is proven to share no volume with A; its length is depth[1].",
      &ClashResult::translation);
  property(c, "along", "(float, float) or None: how far B has to move in the given direction.",
           &ClashResult::along);
  property(c, "volume", "(float, float) or None: the shared volume, unit cubed.", &ClashResult::volume);
  property(c, "finished", "bool: max_steps was not reached.", &ClashResult::finished);
  c.def("__repr__",
        [](const ClashResult& r) { return "<lrbscope.Clash " + std::string(to_string(r.kind)) + ">"; });
  make_picklable(c);
  define(m, R"(clash(a, b, poses_b=None, pose_a=None, *, clearance=0, along=None, depth=True, volume=True,
      max_steps=0, threads=0)

Finds the kind and depth of the contact of two solids.

poses_b: (4, 4) float, or (k, 4, 4) for many poses on all cores; pose_a: (4, 4). None: the identity.
clearance: solids at this distance or less are 'within_clearance'; the world's unit.
along: (3,), a direction in which B is to leave A. depth, volume: whether to compute them.
max_steps: stop narrowing depths after this number of queries and of points located in the bodies; 0: no limit.

Returns a Clash, or for (k, 4, 4) a list of them.

>>> c = clash(cube, cube, shifted(0.75, 0.25, 0.125))
>>> c.kind, c.depth[0] <= 0.25 <= c.depth[1]
('protrudes', True))",
         &clash);
}

py::object distance(const Given& given) {
  const TwoBodies two(given);
  DistanceRequest request;
  if (const Argument within = given["within"]; !within.is_none()) request.within = size(within);
  request.tolerance = size(given["tolerance"]);
  request.relative_tolerance = size(given["relative_tolerance"]);
  request.max_steps = count(given["max_steps"]);
  request.relation = flag(given["relation"], true);
  const auto ask = [&](const Pose& pose_b, Workspace& memory) {
    return lrb::distance(two.a.rep(), two.pose_a, two.b.rep(), pose_b, request, memory);
  };
  if (!two.poses_b.one)
    return py::cast(Sequence<DistanceResult>{ask_poses<DistanceResult>(two.poses_b, given, ask)});
  DistanceResult result;
  {
    const py::gil_scoped_release unlocked;
    result = ask(two.pose_b(), own_workspace()).value();
  }
  return py::cast(std::move(result));
}

/// Returns get(witness) of A and of B as a tuple.
template <class Get>
auto of_both(const Get& get) {
  return [get](const DistanceResult& r) {
    return py::make_tuple(to_python(std::invoke(get, r.witness[0])),
                          to_python(std::invoke(get, r.witness[1])));
  };
}

const auto kPointsOf = [](const auto& answer) {
  return column(answer.witness, [](const Witness& w) { return w.point; });
};

void bind_single_distance(py::module_& m) {
  py::class_<DistanceResult> c(m, "Distance",
                               "Distance of two surfaces, as a proven interval. Made by distance().");
  property(c, "lower", "float: the world's unit.", &DistanceResult::lower);
  property(c, "upper", "float: the world's unit.", &DistanceResult::upper);
  property(c, "solids", "(float, float): the interval for the solids; also 0 if one body contains the other.",
           [](const DistanceResult& r) { return py::make_tuple(r.solids_lower(), r.solids_upper()); });
  property(c, "meet", "bool: the surfaces have a point in common.", &DistanceResult::meet);
  property(c, "within",
           "bool or None: True if the distance is at most `within`; None if not requested or not decided.",
           &DistanceResult::within);
  property(c, "finished", "bool: no limit was reached.", &DistanceResult::finished);
  property(c, "relation", "str: as Result.relation; for intersecting surfaces, derived from the first pair.",
           &DistanceResult::relation);
  property(c, "points", "(2, 3) float64: the closest points of A and of B, world frame.", kPointsOf);
  property(c, "triangles", "(int, int): the triangles of these points; None for a body without faces.",
           of_both(&Witness::simplex));
  property(c, "faces", "(int, int): the faces of these triangles.", of_both(&Witness::face));
  property(c, "features", "(str, str): 'corner', 'edge' or 'inside' of the triangle.",
           of_both([](const Witness& w) {
             return py::str(w.feature.dim == 0 ? "corner" : w.feature.dim == 1 ? "edge" : "inside");
           }));
  property(c, "corners", "((i,) uint32, (j,) uint32): the vertices that span the features.",
           of_both([](const Witness& w) {
             return column(std::span(w.corners).first(static_cast<std::size_t>(w.corner_count)),
                           std::identity());
           }));
  property(c, "counters", kCountersText, [](const DistanceResult& r) { return dict_of(r.counters); });
  c.def(
      "__float__", [](const DistanceResult& r) { return r.upper; }, "The upper end.");
  c.def("__repr__", [](const DistanceResult& r) {
    const std::string lower = py::str(py::float_(r.lower)), upper = py::str(py::float_(r.upper));
    return "<lrbscope.Distance in [" + lower + ", " + upper + "]>";
  });
  make_picklable(c);
}

void bind_distance(py::module_& m) {
  bind_single_distance(m);
  auto c = bind_sequence<Sequence<DistanceResult>>(
      m, "Distances", "Distances for k poses: a sequence of Distance, in the order of the poses.");
  const auto of_each = rows_of(c, "poses", &Sequence<DistanceResult>::all);
  of_each("lower", "(k,) float64", &DistanceResult::lower);
  of_each("upper", "(k,) float64", &DistanceResult::upper);
  define(m, R"(distance(a, b, poses_b=None, pose_a=None, *, within=None, tolerance=0, relative_tolerance=0,
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
(True, [1.0, 3.0]))",
         &distance);
}

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
Motions motions(const Argument& arg) {
  Motions out;
  const py::object all = arg.is_none() ? py::object(py::none()) : numbers(arg);
  out.one = arg.is_none() || all.cast<Doubles>().ndim() != 4;
  const auto add = [&](py::handle one) {
    const std::vector<Pose> through = poses({one, arg.name}).to_vector();
    if (through.empty()) throw InputError(std::string(arg.name) + ": expected at least one pose, got none");
    out.all.push_back(motion_through(through));
  };
  if (out.one)
    add(all);
  else
    for (const py::handle one : all) add(one);
  return out;
}

py::object first_contact(const Given& given) {
  const Body &a = body(given["a"]), &b = body(given["b"]);
  const Motions of_b = motions(given["motion_b"]), of_a = motions(given["motion_a"]);
  if (!of_a.one) throw InputError("motion_a: expected one motion, (m, 4, 4)");
  FirstContactRequest request;
  request.tolerance = size(given["tolerance"], request.tolerance);
  request.max_steps = count(given["max_steps"], request.max_steps);
  request.relation = flag(given["relation"], true);
  // Runs in a batch even for a single motion, because it can take long: Ctrl-C ends the wait.
  Sequence<FirstContactResult> found{ask_each<FirstContactResult>(
      of_b.all.size(), of_b.one ? 1 : threads_of(given), [&](std::size_t i, Workspace& memory) {
        return lrb::first_contact(a.rep(), of_a.all[0], b.rep(), of_b.all[i], request, memory);
      })};
  return of_b.one ? py::cast(std::move(found.all[0])) : py::cast(std::move(found));
}

void bind_single_contact(py::module_& m) {
  using Contact = FirstContactResult;
  py::class_<Contact> c(
      m, "FirstContact",
      R"(First contact of two moving bodies, as a proven interval of the time t from 0 to 1. Made by
first_contact().)");
  property(
      c, "outcome",
      "str: 'contact'; 'never', which is proven; 'undecided': too close to each other for double precision.",
      &Contact::outcome);
  property(c, "t0", "float: no contact before this time; 1 if never.", &Contact::t0);
  property(c, "t1", "float: in contact at this time; if undecided, no contact after it; 1 if never.",
           &Contact::t1);
  property(c, "at_start", "bool: in contact at t = 0.", &Contact::at_start);
  property(c, "grazing",
           "bool: the interval is wider than requested, because of an earlier tangential contact.",
           &Contact::grazing);
  property(c, "passed", "bool: in contact at some time up to t1, though not at t1 itself.", &Contact::passed);
  property(c, "finished", "bool: no step limit was reached.", &Contact::finished);
  property(
      c, "unresolved",
      R"(str or None: why the interval is wider than requested, or contact in it is undecided: 'rounding': the
bodies are as close as rounding errors; 'steps': a step limit was reached.)",
      [](const Contact& f) {
        return f.unresolved == Unresolved::nothing ? std::nullopt : std::optional(f.unresolved);
      });
  property(c, "speed",
           "float: approach speed of the closest points along the normal; world's unit per unit of t.",
           &Contact::speed);
  property(c, "at_begin", "str: relation of the bodies at the start, as Result.relation.",
           &Contact::at_begin);
  property(c, "ambiguous", "(d, 2) float64: time intervals that are undecided.", [](const Contact& f) {
    return column(f.ambiguous, [](const TimeSpan& span) { return std::array{span.begin, span.end}; });
  });
  property(c, "pair", "(int, int) or None: triangles of A and of B that intersect at t1.",
           [](const Contact& f) {
             return f.pair.a == kNull ? py::object(py::none())
                                      : py::make_tuple(f.pair.a.value(), f.pair.b.value());
           });
  property(c, "points", "(2, 3) float64: the closest points of A and of B at t0, world frame.", kPointsOf);
  property(c, "normal",
           "(3,) float64: unit, from A to B, at t0; 0 at the start, and if it is below rounding errors.",
           &Contact::normal);
  property(c, "counters", kCountersText, [](const Contact& f) { return dict_of(f.counters); });
  c.def("__bool__", &Contact::is_contact, "True if the outcome is 'contact'.");
  c.def("__repr__", [](const Contact& f) {
    const std::string t0 = py::str(py::float_(f.t0)), t1 = py::str(py::float_(f.t1));
    return "<lrbscope.FirstContact " + std::string(name_of(f.outcome)) + ", t in [" + t0 + ", " + t1 + "]>";
  });
  make_picklable(c);
}

void bind_first_contact(py::module_& m) {
  bind_single_contact(m);
  auto c = bind_sequence<Sequence<FirstContactResult>>(
      m, "FirstContacts", "First contacts for k motions: a sequence of FirstContact, in their order.");
  const auto of_each = rows_of(c, "motions", &Sequence<FirstContactResult>::all);
  of_each("t0", "(k,) float64: FirstContact.t0 of each.", &FirstContactResult::t0);
  of_each("t1", "(k,) float64: FirstContact.t1 of each.", &FirstContactResult::t1);
  define(m,
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
('contact', 0.666667))",
         &first_contact);
}

}  // namespace

void bind_distances(py::module_& m) {
  bind_distance(m);
  bind_first_contact(m);
  bind_clash(m);
}

}  // namespace lrb::python

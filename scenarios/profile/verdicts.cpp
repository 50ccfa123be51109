#include "scenarios/profile/verdicts.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/axes.hpp"
#include "scenarios/record/engine_run.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/pair_distance.hpp>

namespace lrb::profile {
namespace {

using capture::Event;
using capture::EventKind;
using capture::Query;
using capture::QueryKind;
using capture::Verdict;

double ulp_of(Precision precision) {
  return precision == Precision::float32 ? double{std::numeric_limits<float>::epsilon()}
                                         : std::numeric_limits<double>::epsilon();
}

/// Returns the largest term in the world coordinates of a point.
double largest_term(const Pose& pose, const Eigen::Vector3d& x) {
  return (pose.r.cwiseAbs() * x.cwiseAbs() + pose.t.cwiseAbs()).maxCoeff();
}

Triangle moved(const Triangle& t, const Pose& pose) {
  return {pose.apply(t[0]), pose.apply(t[1]), pose.apply(t[2])};
}

bool share_a_vertex(const capture::Mesh& mesh, const TrianglePair& pair) {
  const auto &s = mesh.triangles[pair.a], &t = mesh.triangles[pair.b];
  return std::any_of(s.begin(), s.end(),
                     [&](std::uint32_t v) { return std::find(t.begin(), t.end(), v) != t.end(); });
}

/// The pairs whose test the engine recorded, ascending.
struct Tested {
  std::vector<TrianglePair> met;
  std::vector<TrianglePair> disjoint;  ///< and not met in another test
};

bool contains(const std::vector<TrianglePair>& ascending, const TrianglePair& pair) {
  return std::binary_search(ascending.begin(), ascending.end(), pair);
}

void sort_once(std::vector<TrianglePair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

Tested tested_pairs(const Query& query, const capture::Mesh& mesh_a) {
  Tested out;
  for (const Event& e : query.events) {
    if (e.kind != EventKind::triangles) continue;
    TrianglePair pair{e.a, e.b};
    if (query.kind == QueryKind::self) {
      if (pair.a > pair.b) std::swap(pair.a, pair.b);
      if (pair.a == pair.b || share_a_vertex(mesh_a, pair)) continue;
    }
    (e.met > 0 ? out.met : out.disjoint).push_back(pair);
  }
  sort_once(out.met);
  sort_once(out.disjoint);
  std::vector<TrianglePair> never;
  std::set_difference(out.disjoint.begin(), out.disjoint.end(), out.met.begin(), out.met.end(),
                      std::back_inserter(never));
  out.disjoint = std::move(never);
  return out;
}

void worsen(Judgement& outcome, Judgement by) {
  outcome = std::max(outcome, by);
}

}  // namespace

Precision precision_of(const capture::Capture& capture) {
  for (const capture::Tree& tree : capture.trees) {
    if (!tree.instances.empty()) continue;  // the reader moved its volumes, in double
    for (const double x : tree.volumes)
      if (static_cast<double>(static_cast<float>(x)) != x) return Precision::float64;
  }
  return capture.trees.empty() ? Precision::float64 : Precision::float32;
}

double error_bound(Points a, const Pose& pose_a, Points b, const Pose& pose_b, Precision precision) {
  double of_a = 0, of_b = 0;
  for (const Eigen::Vector3d& x : a) of_a = std::max(of_a, largest_term(pose_a, x));
  for (const Eigen::Vector3d& x : b) of_b = std::max(of_b, largest_term(pose_b, x));
  return kTestUlps * ulp_of(precision) * (of_a + of_b);
}

double gap_of(const Triangle& a, const Triangle& b) {
  const double* const pa[] = {a[0].data(), a[1].data(), a[2].data()};
  const double* const pb[] = {b[0].data(), b[1].data(), b[2].data()};
  return exact::distance_of_simplices(pa, pb, 3).lower;
}

double overlap_depth(Points a, Points b) {
  // The translation along any axis by the overlap of the projections separates the triangles, so that every
  // axis gives an upper bound. The shortest one is along a normal of a face of the Minkowski sum of A and -B:
  // the normal of a triangle, or of the parallelogram of an edge of each. (Cameron, "Enhancing GJK", 1997,
  // section 4.) The coordinate axes serve where edges are parallel and the sum is flat.
  double least = std::numeric_limits<double>::infinity();
  std::vector<Eigen::Vector3d> from_a[2] = {{a.begin(), a.end()}, {b.begin(), b.end()}};
  for (auto& points : from_a)
    for (Eigen::Vector3d& x : points) x -= a[0];
  const auto along = [&](const Eigen::Vector3d& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return;
    least = std::min(least, std::max(0.0, -gap_along(direction / length, from_a[0], from_a[1])));
  };
  Eigen::Vector3d edges[2][3];
  for (int side = 0; side < 2; ++side) {
    const Points t = side == 0 ? a : b;
    for (std::size_t i = 0; i < 3; ++i) edges[side][i] = t[(i + 1) % 3] - t[i];
    along(edges[side][0].cross(edges[side][1]));
  }
  for (const Eigen::Vector3d& e : edges[0])
    for (const Eigen::Vector3d& f : edges[1]) along(e.cross(f));
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(k);
    along(unit);
    for (const auto& of : edges)
      for (const Eigen::Vector3d& e : of) along(e.cross(unit));
  }
  return least;
}

struct Checker::Posed {
  const Query& query;
  std::array<std::uint32_t, 2> trees;
  std::array<const capture::Mesh*, 2> meshes;
  std::array<const LrbRep*, 2> bodies;
  std::array<Pose, 2> poses;

  bool is_self() const { return query.kind == QueryKind::self; }
  bool is_box() const { return query.probe.shape == capture::ProbeShape::box; }
  bool has_probe() const { return query.probe.shape != capture::ProbeShape::none; }
};

Checker::Checker(CapturedBodies& bodies, Precision precision) : bodies_(bodies), precision_(precision) {
  records_triangles_ = std::ranges::any_of(bodies.capture().queries, tests_triangles);
}

std::string_view words(PoseError error) {
  switch (error) {
    case PoseError::inverted:
      return "poses map the world to the body: record their inverse";
    case PoseError::transposed:
      return "rotations are transposed: record matrices row by row";
    case PoseError::exchanged:
      return "the poses of A and B are exchanged";
    case PoseError::rotated_last:
      return "translations are not rotated: record R x + t, not R (x + t)";
  }
  return "";
}

namespace {

/// Returns the poses without the error.
std::array<Pose, 2> corrected(const std::array<Pose, 2>& poses, PoseError error) {
  std::array<Pose, 2> out = poses;
  if (error == PoseError::exchanged) std::swap(out[0], out[1]);
  for (Pose& pose : out) {
    if (error == PoseError::inverted) pose = {pose.r.transpose(), -(pose.r.transpose() * pose.t)};
    if (error == PoseError::transposed) pose.r.transposeInPlace();
    if (error == PoseError::rotated_last) pose.t = pose.r * pose.t;
  }
  return out;
}

}  // namespace

std::array<bool, kPoseErrors> Checker::explaining_errors(const Query& query, const QueryWalk& walk) {
  std::array<bool, kPoseErrors> out{};
  Posed posed = posed_bodies(query, walk);
  const std::vector<TrianglePair> found = tested_pairs(query, *posed.meshes[0]).met;
  if (found.empty()) return out;
  for (std::size_t i = 0; i < kPoseErrors; ++i) {
    posed.poses = corrected(query.poses, static_cast<PoseError>(i));
    const std::vector<TrianglePair> exact = exact_pairs(posed);
    std::vector<TrianglePair> other;
    std::set_symmetric_difference(found.begin(), found.end(), exact.begin(), exact.end(),
                                  std::back_inserter(other));
    constexpr std::size_t kTolerated = 100;  // one pair of these may be undecidable
    out[i] = other.size() <= found.size() / kTolerated;
  }
  return out;
}

Checker::Posed Checker::posed_bodies(const Query& query, const QueryWalk& walk) {
  const std::array<std::uint32_t, 2>& trees = walk.trees();
  Posed posed{query, trees, {}, {}, query.poses};
  for (std::size_t side = 0; side < 2; ++side) {
    posed.meshes[side] = &bodies_.mesh_of(trees[side]);
    posed.bodies[side] = bodies_.body(bodies_.tree(trees[side]).mesh);
  }
  if (posed.is_self()) posed.poses[1] = posed.poses[0];
  return posed;
}

QueryVerdict Checker::check(const Query& query, const QueryWalk* walk,
                            const std::vector<SimplexPair>* known) {
  QueryVerdict out;
  out.number = query.number;
  out.kind = query.kind;
  if (walk == nullptr) {
    out.remark = "a side without a tree: its shape is not known";
    return out;
  }
  if (!query.ended) {
    out.remark = "the capture was cut off within this query";
    return out;
  }
  records_triangles_ = records_triangles_ || tests_triangles(query);  // of a query beside the capture
  const Posed posed = posed_bodies(query, *walk);
  if (known == nullptr)
    out.exact = exact_pairs(posed);
  else
    for (const SimplexPair& pair : *known) out.exact.push_back({pair.a, pair.b});
  out.exact_pairs = out.exact.size();
  if (query.kind == QueryKind::all_pairs || query.kind == QueryKind::any || posed.is_self() ||
      is_first_hit(query))
    check_pairs(posed, *walk, out);
  check_answer(posed, out);
  if (query.value) check_value(posed, out);
  out.outcome = out.answer;
  if (out.pairs_checked) worsen(out.outcome, Judgement::right);
  if (out.undecidable > 0) worsen(out.outcome, Judgement::undecidable);
  if (out.missed + out.extra > 0) worsen(out.outcome, Judgement::wrong);
  return out;
}

std::vector<TrianglePair> Checker::exact_pairs(const Posed& posed) {
  std::vector<TrianglePair> out;
  if (posed.bodies[0] == nullptr || posed.bodies[1] == nullptr) return out;
  const Expected<CollideResult&> found = collide(*posed.bodies[0], posed.poses[0], *posed.bodies[1],
                                                 posed.poses[1], CollideRequest{}, workspace_);
  std::vector<SimplexPair>& pairs = found.value().pairs;
  fill_box(posed.query, *posed.bodies[0], *posed.meshes[0], pairs);
  for (const SimplexPair& pair : pairs) {
    const TrianglePair triangles{pair.a, pair.b};
    if (posed.is_self() && (triangles.a >= triangles.b || share_a_vertex(*posed.meshes[0], triangles)))
      continue;
    out.push_back(triangles);
  }
  return out;  // the result's pairs ascend
}

WrongPair Checker::describe(const Posed& posed, const TrianglePair& pair, bool missed) const {
  WrongPair out;
  out.triangles = pair;
  out.missed = missed;
  const Triangle a = corners_of(*posed.meshes[0], pair.a), b = corners_of(*posed.meshes[1], pair.b);
  const Triangle world_a = moved(a, posed.poses[0]), world_b = moved(b, posed.poses[1]);
  out.margin = missed ? overlap_depth(world_a, world_b) : gap_of(world_a, world_b);
  out.bound = error_bound(a, posed.poses[0], b, posed.poses[1], precision_);
  if (posed.is_box()) {  // its pose is the identity
    const capture::Mesh& box = *posed.meshes[1];
    out.bound = error_bound(a, posed.poses[0], box.vertices, posed.poses[1], precision_);
    if (missed) out.margin = overlap_depth(world_a, box.vertices);
    for (std::uint32_t t = 0; !missed && t < box.triangles.size(); ++t)
      out.margin = std::min(out.margin, gap_of(world_a, corners_of(box, t)));
  }
  out.undecidable = out.margin <= out.bound;
  return out;
}

bool Checker::is_undecidable(const Query& query, const QueryWalk& walk, const TrianglePair& pair,
                             bool missed) {
  return describe(posed_bodies(query, walk), pair, missed).undecidable;
}

void Checker::blame(const Posed& posed, const QueryWalk& walk, bool tested, WrongPair& wrong) {
  const TrianglePair& pair = wrong.triangles;
  if (tested) {
    wrong.culprit = Culprit::triangle_test;
    return;
  }
  wrong.in_leaf = {walk.index(0).leaf[pair.a] != kNull, walk.index(1).leaf[pair.b] != kNull};
  if (!wrong.in_leaf[0] || !wrong.in_leaf[1]) {
    wrong.culprit = Culprit::in_no_leaf;
    return;
  }
  if (!posed.query.complete()) {
    wrong.culprit = Culprit::unrecorded;
    return;
  }
  const std::uint32_t visit = walk.deepest_above(pair);
  if (visit == QueryWalk::kNone) {
    wrong.culprit = Culprit::not_visited;
    return;
  }
  const Event& e = posed.query.events[visit];
  wrong.nodes = {e.a, e.b};
  if (e.met > 0) {
    // Wide nodes: if every pair of children that overlaps was visited, the missing one did not.
    const bool leaves = walk.index(0).is_leaf(e.a) && walk.index(1).is_leaf(e.b);
    const bool some_disjoint = e.met < e.tests && (leaves || walk.children(visit) >= e.met);
    wrong.culprit = some_disjoint ? Culprit::child_volumes : Culprit::traversal;
    return;
  }
  wrong.culprit = e.tests > 1 ? Culprit::child_volumes : Culprit::volumes;
  wrong.axis = e.axis;
  // A volume that does not contain its triangle explains the rest.
  const std::uint32_t triangles[] = {pair.a, pair.b};
  for (std::size_t side = 0; side < 2; ++side) {
    if (bodies_.tree(posed.trees[side]).splits) continue;
    for (const Eigen::Vector3d& x : corners_of(*posed.meshes[side], triangles[side]))
      wrong.outside[side] =
          std::max(wrong.outside[side], bodies_.volumes(posed.trees[side]).outside(wrong.nodes[side], x));
  }
}

void Checker::check_pairs(const Posed& posed, const QueryWalk& walk, QueryVerdict& out) {
  const Query& query = posed.query;
  if (!records_triangles_) {
    out.remark = "tests of triangles are not recorded";
    return;
  }
  const Tested tested = tested_pairs(query, *posed.meshes[0]);
  out.found = tested.met.size();
  // A query that need not find all pairs misses one only by a wrong test, or by calling the bodies separate.
  const bool all = query.verdict == Verdict::separate || (query.kind != QueryKind::any && query.complete());
  out.pairs_checked = all || !tested.met.empty() || !tested.disjoint.empty();
  if (!out.pairs_checked) out.remark = "events are not recorded";
  // Of the hits of a ray, those behind the first one that was found need not be found.
  double first_found = std::numeric_limits<double>::infinity();
  const auto hit = [&](const TrianglePair& pair) {
    return hit_of(query, *posed.meshes[0], pair.a, describe(posed, pair, true).bound);
  };
  if (is_first_hit(query))
    for (const TrianglePair& pair : tested.met)
      if (contains(out.exact, pair) || describe(posed, pair, false).undecidable)
        first_found = std::min(first_found, hit(pair)[0]);
  std::vector<WrongPair> wrong;
  for (const TrianglePair& pair : out.exact) {
    if (is_first_hit(query) && !contains(tested.met, pair) && hit(pair)[1] >= first_found) continue;
    const bool tested_disjoint = contains(tested.disjoint, pair);
    if (contains(tested.met, pair)) {
      ++out.right;
    } else if (all || tested_disjoint) {
      wrong.push_back(describe(posed, pair, true));
      blame(posed, walk, tested_disjoint, wrong.back());
    }
  }
  for (const TrianglePair& pair : tested.met)
    if (!contains(out.exact, pair)) wrong.push_back(describe(posed, pair, false));
  for (const WrongPair& w : wrong) ++(w.undecidable ? out.undecidable : w.missed ? out.missed : out.extra);
  std::stable_partition(wrong.begin(), wrong.end(), [](const WrongPair& w) { return !w.undecidable; });
  if (wrong.size() > QueryVerdict::kKept) wrong.resize(QueryVerdict::kKept);
  out.wrong = std::move(wrong);
}

double Checker::error_of_distance(const Posed& posed) const {
  double terms = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    double largest = 0;
    for (const Eigen::Vector3d& x : posed.meshes[side]->vertices)
      largest = std::max(largest, largest_term(posed.poses[side], x));
    terms += largest;
  }
  return kTestUlps * ulp_of(precision_) * terms;
}

void Checker::check_value(const Posed& posed, QueryVerdict& out) {
  if (posed.bodies[0] == nullptr || posed.bodies[1] == nullptr) return;
  // Between surfaces. An engine may give negative numbers for bodies that intersect.
  const bool of_ray = is_first_hit(posed.query);
  double lower = 0, upper = 0, error = of_ray ? 0 : error_of_distance(posed);
  // Of a ray: the least and greatest multiple that rounding of the engine's tests explains.
  double possible = std::numeric_limits<double>::infinity(), sure = possible;
  if (of_ray) {
    if (out.exact.empty()) return;
    // The least bounds of all hits, as multiples of the direction.
    const auto& n = posed.query.probe.numbers;
    const double unit = posed.poses[1].r.col(0).norm() / Eigen::Vector3d(n[3], n[4], n[5]).stableNorm();
    lower = upper = std::numeric_limits<double>::infinity();
    for (const TrianglePair& pair : out.exact) {
      const WrongPair d = describe(posed, pair, true);
      const auto hit = hit_of(posed.query, *posed.meshes[0], pair.a, d.bound);
      lower = std::min(lower, unit * hit[0]), upper = std::min(upper, unit * hit[1]);
      if (!d.undecidable) sure = std::min(sure, unit * hit[1]);
    }
    possible = lower;
    for (const WrongPair& w : out.wrong)
      if (!w.missed && w.undecidable)
        possible =
            std::min(possible, unit * hit_of(posed.query, *posed.meshes[0], w.triangles.a, w.bound)[0]);
  } else if (out.exact.empty()) {
    DistanceRequest request;
    request.relation = false;
    const auto& exact =
        distance(*posed.bodies[0], posed.poses[0], *posed.bodies[1], posed.poses[1], request, workspace_)
            .value();
    lower = exact.lower, upper = exact.upper;
  }
  const auto [least, most] = *posed.query.value;
  const double floor = of_ray ? -std::numeric_limits<double>::infinity() : 0;
  const double by = std::max({lower - std::max(most, floor), std::max(least, floor) - upper, 0.0});
  const bool is_error = by > error && !(of_ray && most >= possible && least <= sure);
  worsen(out.answer, is_error ? Judgement::wrong : by > 0 ? Judgement::undecidable : Judgement::right);
  if (!is_error) return;
  const auto number = [](double x) { return io::number_text(x, 9); };
  out.distance = "the engine's distance is " + number(least) + (most > least ? " to " + number(most) : "") +
                 "; it is " + number(upper);
  out.remark += (out.remark.empty() ? "" : "; ") + out.distance;
}

void Checker::check_answer(const Posed& posed, QueryVerdict& out) {
  const Query& query = posed.query;
  if (query.verdict == Verdict::unreported) return;
  const bool reported = query.verdict == Verdict::intersecting, meet = !out.exact.empty();
  if (query.kind == QueryKind::first_contact && (reported || !meet)) return;
  out.answer = Judgement::right;
  const auto depth = [&](const TrianglePair& pair) { return describe(posed, pair, true); };
  const auto undecidable_pairs = [&] {
    return std::count_if(out.exact.begin(), out.exact.end(),
                         [&](const TrianglePair& pair) { return depth(pair).undecidable; });
  };
  if (reported && !meet) {
    const bool neighbours = posed.is_self() && out.extra == 0;
    if (neighbours) {
      out.answer = Judgement::unchecked;  // it may count triangles with a common vertex
      return;
    }
    // The bodies' gap decides, because the pair that the engine took for intersecting may be unrecorded.
    const bool close = posed.bodies[0] != nullptr && posed.bodies[1] != nullptr && [&] {
      DistanceRequest request;
      request.within = error_of_distance(posed);
      request.relation = false;
      return distance(*posed.bodies[0], posed.poses[0], *posed.bodies[1], posed.poses[1], request, workspace_)
          .value()
          .within.value_or(false);
    }();
    out.answer = close ? Judgement::undecidable : Judgement::wrong;
    out.remark = std::string("the engine's verdict is intersecting; ") +
                 (posed.has_probe() ? "nothing is hit" : "the bodies are separate");
    return;
  }
  if (!reported && meet) {
    const bool all_undecidable = undecidable_pairs() == static_cast<std::ptrdiff_t>(out.exact.size());
    out.answer = all_undecidable ? Judgement::undecidable : Judgement::wrong;
    out.remark = "the engine's verdict is separate; " + std::to_string(out.exact.size()) +
                 (posed.has_probe()       ? " triangles are hit"
                  : out.exact.size() == 1 ? " pair of triangles intersects"
                                          : " pairs of triangles intersect");
    return;
  }
  // The number of pairs. 0 with an intersection: the engine does not count. A number that agrees with the
  // tests is as right as these.
  if (query.kind != QueryKind::all_pairs || query.pairs == 0 || query.pairs == out.exact.size()) return;
  if (out.pairs_checked && query.complete() && query.pairs == out.found) return;
  const std::uint64_t exact = out.exact.size();
  std::uint64_t extra = 0;
  for (const WrongPair& w : out.wrong) extra += w.undecidable && !w.missed;
  const bool near = query.pairs < exact
                        ? exact - query.pairs <= static_cast<std::uint64_t>(undecidable_pairs())
                        : query.pairs - exact <= extra;
  out.answer = near ? Judgement::undecidable : Judgement::wrong;
  out.remark = "the engine counted " + std::to_string(query.pairs) + " pairs of triangles; " +
               std::to_string(exact) + (posed.has_probe() ? " are hit" : " intersect");
}

std::string cause_of(const WrongPair& wrong) {
  const bool sticks_out = std::max(wrong.outside[0], wrong.outside[1]) > wrong.bound;
  return !wrong.missed ? "false"
                       : "missed; cause: " + io::in_words(name_of(wrong.culprit)) +
                             (sticks_out ? ", from which a triangle sticks out" : "");
}

std::string sentence(const WrongPair& wrong, const capture::Tree& a, const capture::Tree& b) {
  constexpr int kDigits = 3;
  const auto number = [](double x) { return io::number_text(x, kDigits); };
  const bool of_probe = b.id == 0;  // a ray, point or box
  const std::string names[] = {a.name_of_triangle(wrong.triangles.a), b.name_of_triangle(wrong.triangles.b)};
  std::string out =
      (wrong.missed ? "missed " : "false ") + names[0] + (of_probe ? "" : "," + names[1]) + ": ";
  const auto nodes = [&] {
    const std::string node = a.name_of_node(wrong.nodes[0]);
    return of_probe ? "node " + node + ", which contains it, and the probe "
                    : "nodes " + node + " and " + b.name_of_node(wrong.nodes[1]) + ", which contain them, ";
  };
  switch (wrong.culprit) {
    case Culprit::none:
      out += of_probe ? "it is not hit" : "the triangles are disjoint";
      break;
    case Culprit::triangle_test:
      out += "the triangle test called them disjoint";
      break;
    case Culprit::volumes:
      out += nodes() + "were found disjoint";
      if (wrong.axis != capture::kNoAxis) out += " along " + record::axis_words(wrong.axis);
      for (std::size_t side = 0; side < 2; ++side)
        if (wrong.outside[side] > wrong.bound)
          out += "; triangle " + names[side] + " sticks out of its node by " + number(wrong.outside[side]);
      break;
    case Culprit::child_volumes:
      out += "the children of " + nodes() + "were found disjoint";
      break;
    case Culprit::traversal:
      out += nodes() + "overlap, but the pair beneath was never visited";
      break;
    case Culprit::not_visited:
      out += "no pair of nodes above them was visited";
      break;
    case Culprit::in_no_leaf:
      out += std::string(wrong.in_leaf[0]   ? "the second"
                         : wrong.in_leaf[1] ? "the first"
                                            : "each") +
             " triangle is in no leaf";
      break;
    case Culprit::unrecorded:
      out += "the events are not complete, so the cause is not known";
      break;
  }
  return out + " (" + (wrong.missed ? "overlap depth " : "gap ") + number(wrong.margin) +
         (wrong.undecidable ? ", within " : ", beyond ") + "the error bound " + number(wrong.bound) + ")";
}

}  // namespace lrb::profile

/// Bodies, poses, motions, tolerances and requests that bytes choose, for first contacts, distances and
/// clashes. Numbers are small multiples of a quarter more often than not, and off these by little, so that
/// bodies are flush, graze or are in the same place.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/fuzz/choices.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/first_contact.hpp>

namespace lrb::fuzz {
namespace {

using Eigen::Vector3d;

/// A block with a notch, which is not convex.
Mesh notch() {
  return shapes::voxels(
      3, 2, 1, [](int x, int y, int) { return x != 1 || y == 0; }, true);
}

Mesh polygon(int n, bool open) {
  const Mesh star = shapes::star(n, 1, 0.5);
  return open ? test::without_last_face(star) : star;
}

Mesh box(bool open) {
  const Mesh quads = shapes::quad_box();
  return open ? test::without_last_face(quads) : quads;
}

/// Simplices that have nothing to do with each other.
Mesh loose(Choices& choose, int dim) {
  Mesh mesh;
  mesh.dim = dim;
  const unsigned count = 1 + choose.below(4);
  for (unsigned i = 0; i < count; ++i) {
    std::vector<Vector3d> corners;
    for (int k = 0; k < dim; ++k) corners.push_back(choose.vector(dim));
    test::add_loose(mesh, corners);
  }
  return mesh;
}

LrbRep body(Choices& choose, int dim) {
  const unsigned kind = choose.byte();
  const bool open = kind & 8;
  if (dim == 2)
    return kind % 4 == 0
               ? test::open_body(loose(choose, 2))
               : LrbRep::without_regions(polygon(3 + static_cast<int>(choose.below(6)), open), !open, false);
  switch (kind % 8) {
    case 0:
    case 1:
      return LrbRep::without_regions(box(open), !open, false);
    case 2:
      return LrbRep::without_regions(shapes::tetrahedron(), true, false);
    case 3:
      return LrbRep::without_regions(notch(), true, false);
    case 4:
    case 5:
      return test::open_body(test::sheet(1 + choose.below(6)));
    default:
      return test::open_body(loose(choose, 3));
  }
}

Pose pose(Choices& choose, int dim) {
  Pose p = Pose::translation(choose.vector(dim));
  const unsigned how = choose.byte();
  const Vector3d axis =
      dim == 2 || how & 1 ? Vector3d(0, 0, 1) : Vector3d(1, how & 2 ? 1 : 0, 0).normalized();
  if (how % 4 != 0) p = Pose::rotation(axis, how & 4 ? std::numbers::pi / 2 : choose.number(), p.t);
  if (how % 16 == 15) p.r *= choose.number();
  if (how % 32 == 31) p.r.col(0) *= choose.number();
  return p;
}

Motion motion(Choices& choose, int dim) {
  const Pose start = pose(choose, dim);
  switch (choose.below(6)) {
    case 0:
      return Motion::still(start);
    case 1:
    case 2:
      return Motion::linear(start, choose.vector(dim));
    case 3: {
      Vector3d turn = choose.vector(dim);
      if (dim == 2) turn = {0, 0, turn.x()};
      const Vector3d centre = choose.vector(dim);
      return Motion::turning(start, turn, centre,
                             choose.below(2) == 0 ? Vector3d(0, 0, 0) : choose.vector(dim));
    }
    case 4: {
      Pose end = start;
      end.t = choose.vector(dim);
      return Motion::screw(start, end);
    }
    default: {
      std::vector<Motion::KeyFrame> frames = {{0, start}};
      for (unsigned n = 1 + choose.below(3), i = 1; i <= n; ++i)
        frames.push_back({static_cast<double>(i) / n, pose(choose, dim)});
      return Motion::key_frames(frames);
    }
  }
}

double tolerance(Choices& choose) {
  switch (choose.below(4)) {
    case 0:
      return 1e-9;
    case 1:
      return std::ldexp(1.0, -static_cast<int>(choose.byte()));
    case 2:
      return std::numeric_limits<double>::denorm_min();
    default:
      return std::abs(choose.number());
  }
}

bool meet(const LrbRep& a, const Motion& of_a, const LrbRep& b, const Motion& of_b, double t) {
  CollideRequest any;
  any.mode = Mode::any_pair;
  return !collide(a, of_a.at(t), b, of_b.at(t), any).pairs.empty();
}

/// Checks what first_contact.hpp promises. The number of steps is that of its bound; what one span or exact
/// query takes may come on top of it.
void ask_first_contact(Choices& choose, const LrbRep& a, const LrbRep& b, int dim) {
  FirstContactRequest request;
  request.tolerance = tolerance(choose);
  if (choose.below(8) == 0) request.max_steps = 0;
  const Motion of_a = choose.below(4) == 0 ? motion(choose, dim) : Motion::still(pose(choose, dim));
  const Motion of_b = motion(choose, dim);
  const FirstContactResult r = first_contact(a, of_a, b, of_b, request);
  double parts = 0, pairs = 1.0 * a.real_simplex_count() * b.real_simplex_count();
  for (const Motion* m : {&of_a, &of_b})
    for (const Motion::Piece& p : m->pieces())
      parts += 0.5 + std::min(p.turn.stableNorm() / (2 * std::numbers::pi), 16.0);
  const FirstContactCounters& k = r.counters;
  const double most =
      (8192 + 512.0 * (a.real_simplex_count() + b.real_simplex_count())) * parts + 4 * pairs + 64;
  judge(static_cast<double>(k.spans + k.pairs + k.steps + k.exact_queries) <= most,
        "more steps than there may be");
  judge(0 <= r.t0 && r.t0 <= r.t1 && r.t1 <= 1, "t0 and t1 are no interval");
  const bool is_wide =
      r.outcome == MotionOutcome::undecided || (r.is_contact() && r.t1 - r.t0 > request.tolerance);
  judge(is_wide == (r.unresolved != Unresolved::nothing), "an interval is wide without a reason");
  judge(r.finished || r.unresolved == Unresolved::steps, "a search is unfinished for another reason");
  if (r.is_contact() && !r.passed) judge(meet(a, of_a, b, of_b, r.t1), "no contact at t1");
  for (const double t : {0.0, 0.5 * r.t0, std::nextafter(r.t0, 0)})
    if (t < r.t0) judge(!meet(a, of_a, b, of_b, t), "a contact before t0");
}

void ask_distance(Choices& choose, const LrbRep& a, const LrbRep& b, int dim) {
  DistanceRequest request;
  if (choose.below(2) == 0) request.tolerance = tolerance(choose);
  if (choose.below(2) == 0) request.relative_tolerance = tolerance(choose);
  if (choose.below(4) == 0) request.within = tolerance(choose);
  const Pose of_a = pose(choose, dim), of_b = pose(choose, dim);
  const DistanceResult r = distance(a, of_a, b, of_b, request);
  const double pairs = 1.0 * a.real_simplex_count() * b.real_simplex_count();
  judge(static_cast<double>(r.counters.pairs_in_doubles) <= 2 * pairs + 2,
        "pairs are measured more than twice");
  judge(static_cast<double>(r.counters.pairs_exact) <= 2 * pairs + 2,
        "pairs are measured more than twice, exactly");
  judge(0 <= r.lower && r.lower <= r.upper, "the distance is no interval");
  judge(r.finished, "a distance without a limit is unfinished");
  CollideRequest any;
  any.mode = Mode::any_pair;
  const bool touches = !collide(a, of_a, b, of_b, any).pairs.empty();
  judge(!r.meet || touches, "bodies are said to meet that do not");
  judge(!touches || r.lower == 0, "bodies that meet are said to be apart");
  if (request.within && touches)
    judge(r.within.value_or(false), "bodies that meet are not within a distance");
}

void ask_clash(Choices& choose, const LrbRep& a, const LrbRep& b) {
  ClashRequest request;
  if (choose.below(4) == 0) request.along = choose.vector(3);
  if (choose.below(4) == 0) request.clearance = tolerance(choose);
  const Pose of_a = pose(choose, 3), of_b = pose(choose, 3);
  const ClashResult r = clash(a, of_a, b, of_b, request);
  for (const auto& interval : {r.depth, r.along, r.volume})
    if (interval)
      judge(0 <= interval->lower && interval->lower <= interval->upper, "a clash's number is no interval");
}

}  // namespace

bool feed_motion(std::string_view bytes) {
  Choices choose(bytes);
  const unsigned what = choose.byte();
  const int dim = what & 64 ? 2 : 3;
  try {
    const LrbRep a = body(choose, dim), other = body(choose, dim);
    const LrbRep& b = what & 128 ? a : other;
    if (what % 4 < 2)
      ask_first_contact(choose, a, b, dim);
    else if (what % 4 == 2 || dim == 2)
      ask_distance(choose, a, b, dim);
    else
      ask_clash(choose, a, b);
    return true;
  } catch (const InputError& e) {
    judge(std::string(e.what()).find('\n') == std::string::npos, "a message is more than one line");
    return false;
  }
}

}  // namespace lrb::fuzz

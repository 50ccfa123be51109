#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Geometry>

#include "bench/methods/triangles.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/self_intersections.hpp>

namespace lrb::methods {
namespace {

using Eigen::Vector3d;

Motion motion_of(const Question& q) {
  return Motion::linear(Pose::translation(q.from), q.to);
}

Answer interval_of(const Question& q, DistanceRequest request) {
  request.relation = false;
  const Stopwatch watch;
  const DistanceResult r = distance(q.a, Pose{}, q.b, Pose{}, request);
  const double us = watch.microseconds();
  // Only a lower bound may be known; records contain finite numbers.
  return number_answer(r.lower, std::min(r.upper, std::numeric_limits<double>::max()), us);
}

Answer our_distance(const Question& q, Setting tolerance) {
  DistanceRequest request;
  request.tolerance = tolerance.value_or(0) * q.size;
  return interval_of(q, request);
}

Answer distance_in_steps(const Question& q, Setting steps) {
  DistanceRequest request;
  request.max_steps = static_cast<std::uint64_t>(steps.value_or(100));
  return interval_of(q, request);
}

Answer within(const Question& q, Setting share) {
  DistanceRequest request;
  request.within = share.value_or(0.05) * q.size;
  return interval_of(q, request);
}

Answer our_first_contact(const Question& q, Setting tolerance) {
  FirstContactRequest request;
  request.relation = false;
  if (tolerance) request.tolerance = *tolerance;
  const Stopwatch watch;
  const FirstContactResult r = first_contact(q.a, Motion::still({}), q.b, motion_of(q), request);
  const double us = watch.microseconds();
  if (r.outcome == MotionOutcome::undecided)
    throw InputError("undecided, as reported by the method: closer than rounding errors");
  if (r.outcome == MotionOutcome::never) return number_answer(kNever, kNever, us);
  return number_answer(r.t0, r.t1, us);
}

Answer our_depth(const Question& q, Setting) {
  ClashRequest request;
  request.volume = false;
  const Stopwatch watch;
  const ClashResult r = clash(q.a, Pose{}, q.b, Pose{}, request);
  const double us = watch.microseconds();
  if (!r.depth) throw InputError("undecided, as reported by the method: not a closed solid");
  return number_answer(r.depth->lower, r.depth->upper, us);
}

/// Runs the exact query at n + 1 equally spaced times.
Answer sampled(const Question& q, int n) {
  const Motion motion = motion_of(q);
  CollideRequest any;
  any.mode = Mode::any_pair;
  const Stopwatch watch;
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n;
    if (!collide(q.a, Pose{}, q.b, motion.at(t), any).pairs.empty())
      return number_answer(t, t, watch.microseconds());
  }
  return number_answer(kNever, kNever, watch.microseconds());
}

Answer our_near_pairs(const Question& q, Setting) {
  NearPairsRequest request;
  request.within = q.within;
  const Stopwatch watch;
  const NearPairsResult r = near_pairs(q.a, Pose{}, q.b, Pose{}, request);
  Answer out;
  out.microseconds = watch.microseconds();
  for (const NearPair& p : r.pairs) {
    add_near(out, {p.a, p.b}, p.upper);
    out.upper = std::max(out.upper, p.upper - p.lower);  // the width of the widest interval
  }
  return out;
}

Answer our_self_intersections(const Question& q, Setting) {
  const LrbRep body = union_of(q);
  const Stopwatch watch;
  const SelfIntersections r = self_intersections(body, 1);
  Answer out;
  out.microseconds = watch.microseconds();
  for (const SelfIntersection& p : r.pairs)  // all faces are triangles
    out.pairs.push_back({static_cast<SimplexId>(p.a.value()), static_cast<SimplexId>(p.b.value())});
  return out;
}

using Triangle = std::array<Vector3d, 3>;

double point_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d d = b - a;
  const double length_sq = d.squaredNorm();
  return (a + (length_sq > 0 ? std::clamp((p - a).dot(d) / length_sq, 0.0, 1.0) : 0) * d - p).norm();
}

double point_to_triangle(const Vector3d& p, const Triangle& t) {
  const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  double least = std::numeric_limits<double>::infinity();
  bool above = n.norm() > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d &a = t[k], &b = t[(k + 1) % 3];
    least = std::min(least, point_to_segment(p, a, b));
    above = above && n.dot((b - a).cross(p - a)) >= 0;
  }
  return above ? std::abs(n.dot(p - t[0])) / n.norm() : least;
}

/// Of the lines' closest points, or of an end and the other segment if these are not on both segments.
double segment_to_segment(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d u = b - a, v = d - c, w = a - c;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w),
               divisor = uu * vv - uv * uv;
  if (divisor > 0) {
    const double s = (uv * vw - vv * uw) / divisor, t = (uu * vw - uv * uw) / divisor;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) return (w + s * u - t * v).norm();
  }
  return std::min(std::min(point_to_segment(a, c, d), point_to_segment(b, c, d)),
                  std::min(point_to_segment(c, a, b), point_to_segment(d, a, b)));
}

Eigen::AlignedBox3d box_of(const Triangle& t) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : t) box.extend(x);
  return box;
}

double triangle_to_triangle(const Triangle& s, const Triangle& t) {
  if (plain_triangles_meet(s.data(), t.data())) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min({least, point_to_triangle(s[i], t), point_to_triangle(t[i], s)});
    for (std::size_t j = 0; j < 3; ++j)
      least = std::min(least, segment_to_segment(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
  }
  return least;
}

Answer plain_near_pairs(const Question& q, Setting) {
  struct Face {
    Triangle corners;
    Eigen::AlignedBox3d box;
  };
  const auto faces_of = [](const LrbRep& rep) {
    std::vector<Face> out;
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s)
      out.push_back({corners_of(rep, Pose{}, s), box_of(corners_of(rep, Pose{}, s))});
    return out;
  };
  Answer out;
  const Stopwatch watch;
  const std::vector<Face> a = faces_of(q.a), b = faces_of(q.b);
  for (SimplexId i = 0; i < a.size(); ++i)
    for (SimplexId j = 0; j < b.size(); ++j) {
      if (a[i].box.exteriorDistance(b[j].box) > q.within) continue;
      const double d = triangle_to_triangle(a[i].corners, b[j].corners);
      if (d <= q.within) add_near(out, {i, j}, d);
    }
  out.microseconds = watch.microseconds();
  return out;
}

Answer plain_self_intersections(const Question& q, Setting) {
  const LrbRep body = union_of(q);
  Answer out;
  const Stopwatch watch;
  for (SimplexId i = 0; i < body.real_simplex_count(); ++i)
    for (SimplexId j(i + 1); j < body.real_simplex_count(); ++j) {
      VertexId v[3] = {}, w[3] = {};
      body.simplex(i, v);
      body.simplex(j, w);
      if (std::find_first_of(v, v + 3, w, w + 3) != v + 3) continue;
      const Triangle s = corners_of(body, Pose{}, i), t = corners_of(body, Pose{}, j);
      if (plain_triangles_meet(s.data(), t.data())) out.pairs.push_back({i, j});
    }
  out.microseconds = watch.microseconds();
  return out;
}

constexpr const char* kInterval = "An interval that must contain the number.";
const MethodStyle kOurStyle = {"lrbscope", "#0072b2", "circle"};
const MethodStyle kPlainStyle = {"brute force", "#6b6b6b", "crossRot"};
constexpr Traits kProves = {Trait::hard_cases, Trait::proves};
constexpr int kRank = 10;

MethodEntry ours(Quantity quantity, const char* title, Ask ask, const char* remark = kInterval,
                 Traits traits = kProves) {
  return {{.name = "ours",
           .title = title,
           .remark = remark,
           .traits = traits,
           .style = kOurStyle,
           .role = Role::ours,
           .rank = kRank,
           .quantity = quantity},
          nullptr,
          std::move(ask)};
}

MethodEntry plain_list(Quantity quantity, const char* remark, Ask ask) {
  return {{.name = "plain",
           .title = "brute force, double",
           .remark = remark,
           .style = kPlainStyle,
           .role = Role::no_peer,
           .rank = kRank,
           .quantity = quantity},
          nullptr,
          std::move(ask)};
}

MethodEntry sampled_method(int n, Traits traits) {
  return {
      {.name = "sampled-" + std::to_string(n),
       .title = "exact query, " + std::to_string(n) + " steps",
       .remark =
           "lrbscope's exact query at equally spaced times; returns the first at which the bodies collide.",
       .traits = traits,
       .style = {"exact query at 10, 100, 1000 times", "#6b6b6b", "crossRot"},
       .rank = kRank,
       .quantity = Quantity::first_contact},
      nullptr,
      [n](const Question& q, Setting) { return sampled(q, n); }};
}

}  // namespace

std::vector<MethodEntry> own_numbers_methods() {
  MethodEntry distance = ours(Quantity::distance, "lrbscope, distance", our_distance);
  distance.info.parameter = "tolerance";
  distance.info.settings = {0.1, 0.01, 1e-3, 1e-6, 0};
  MethodEntry first_contact = ours(Quantity::first_contact, "lrbscope, first contact", our_first_contact);
  first_contact.info.parameter = "tolerance";
  first_contact.info.settings = {1e-6, 1e-9, 1e-12};
  return {std::move(distance),
          // Two that compute less than the narrowest interval, for charts only.
          {{.name = "ours-budget",
            .title = "lrbscope, distance in N steps",
            .remark = "The interval after N steps (pairs of nodes expanded).",
            .traits = {Trait::proves},
            .parameter = "steps",
            .settings = {3, 10, 30, 100, 300},
            .style = {"lrbscope, within a budget", "#56b4e9", "rect"},
            .role = Role::ours_other,
            .rank = kRank,
            .quantity = Quantity::distance},
           nullptr,
           distance_in_steps},
          {{.name = "ours-within",
            .title = "lrbscope, within 5 % of the diagonal?",
            .remark = "A proven yes or no; the interval is the bound known by then.",
            .traits = {Trait::proves},
            .parameter = "within",
            .settings = {0.05},
            .style = {"lrbscope, yes or no: within a distance?", "#0072b2", "rectOpen"},
            .role = Role::ours_other,
            .rank = kRank,
            .quantity = Quantity::distance},
           nullptr,
           within},
          std::move(first_contact),
          ours(Quantity::depth, "lrbscope, clash", our_depth),
          ours(Quantity::near_pairs, "lrbscope, near pairs", our_near_pairs,
               "near_pairs(), all pairs, each with the interval of its distance."),
          plain_list(Quantity::near_pairs,
                     "Boxes of every pair, then the distance by corners, edges and Moeller's test (1997).",
                     plain_near_pairs),
          ours(Quantity::self_intersections, "lrbscope, self-intersections", our_self_intersections,
               "self_intersections() of a mesh.", {Trait::hard_cases}),
          plain_list(
              Quantity::self_intersections,
              "Every pair without a common corner by Moeller's test (1997); others are left out, as usual.",
              plain_self_intersections),
          sampled_method(10, {}),
          sampled_method(100, {Trait::hard_cases}),
          sampled_method(1000, {Trait::hard_cases})};
}

}  // namespace lrb::methods

#include "bench/quantities/truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include <Eigen/Geometry>

#include "bench/methods/triangles.hpp"
#include "bench/stability/rational_oracles.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>

namespace lrb::quantities {

namespace {

using Eigen::Vector3d;
using stability::Quantity, stability::RightAnswer;

/// Maximum number of faces, to bound the time of rational brute force to seconds.
constexpr std::uint32_t kMaxFaces = 100, kMaxFacesForDepth = 20;

/// Returns the vector with 20 bits per coordinate, so that its products with 1/4 and 3/4 are exact.
Vector3d rounded(const Vector3d& x) {
  Vector3d out;
  for (int k = 0; k < 3; ++k) {
    int exponent = 0;
    const double part = std::frexp(x[k], &exponent);
    out[k] = std::ldexp(std::round(std::ldexp(part, 20)), exponent - 20);
  }
  return out;
}

}  // namespace

std::string why_unsupported(Quantity quantity, const cases::Case& c) {
  if (c.a->dim() == 2) return "2D bodies";
  const std::uint32_t most = quantity == Quantity::depth ? kMaxFacesForDepth : kMaxFaces;
  for (const auto& [rep, pose] : {std::pair{c.a, c.pose_a}, std::pair{c.b, c.pose_b}}) {
    if (rep->real_simplex_count() > most)
      return "a body of more than " + std::to_string(most) + " triangles, too many for rational arithmetic";
    for (const Vector3d& v : rep->vertices())
      if (!(pose.apply(v).norm() < 1e150))
        return "coordinates whose squares are not representable as doubles";
    if (quantity == Quantity::depth && !rep->closed()) return "a body that is not closed";
  }
  return "";
}

methods::Question question_of(const cases::Case& c) {
  methods::Question out{methods::at_pose(*c.a, c.pose_a), methods::at_pose(*c.b, c.pose_b)};
  const Eigen::AlignedBox3d box_a = shapes::box_of(out.a), box_b = shapes::box_of(out.b);
  out.size = std::max(box_a.diagonal().norm(), box_b.diagonal().norm());
  // Not quite between the centres, because the oracle does not support faces that slide along each other.
  Vector3d direction = box_b.center() - box_a.center();
  direction = direction.norm() > 0 ? direction.normalized() : Vector3d(0, 0, 1);
  direction += Vector3d(0.0312, 0.0487, -0.0256);
  const Vector3d towards = rounded(-4 * out.size * direction);
  out.from = -0.75 * towards;
  out.to = 0.25 * towards;
  const std::uint64_t choice = out.a.hash() ^ out.b.hash();
  const auto& p = out.a.vertices();
  const auto& q = out.b.vertices();
  const double distances[] = {0, (p[choice % p.size()] - q[choice / 5 % q.size()]).norm(), 1e-9 * out.size,
                              0.1 * out.size, out.size};
  out.within = distances[choice % std::size(distances)];
  return out;
}

namespace {

using Eigen::AlignedBox3d;
using methods::kNever, methods::Question;
using oracle::Rational;
using oracle::RationalPoint;
using oracle::RationalPoints;

/// The real triangles of a body.
struct Faces {
  std::vector<std::array<VertexId, 3>> corners;
  std::vector<oracle::Corners> x;
  std::vector<RationalPoints> exact;
  std::vector<AlignedBox3d> boxes;
  RationalPoints points;  ///< by vertex

  explicit Faces(const LrbRep& rep) {
    for (const Vector3d& v : rep.vertices()) points.push_back(oracle::rational(v));
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      rep.simplex(s, corners.emplace_back().data());
      x.emplace_back();
      exact.emplace_back();
      boxes.emplace_back();
      for (const VertexId v : corners.back()) {
        x.back().push_back(rep.vertices()[v]);
        exact.back().push_back(points[v]);
        boxes.back().extend(rep.vertices()[v]);
      }
    }
  }
  std::size_t size() const { return corners.size(); }
};

/// Returns the least value of the pairs of faces, or nullopt if none has a value. Pairs are processed in
/// ascending order of `bound`, a lower bound; infinite: no value. value(i, j, least so far): an optional.
template <class Bound, class Value>
std::optional<Rational> least_of_pairs(const Faces& a, const Faces& b, const Bound& bound,
                                       const Value& value) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) pairs.emplace_back(bound(a.boxes[i], b.boxes[j]), i, j);
  std::sort(pairs.begin(), pairs.end());
  std::optional<Rational> least;
  for (const auto& [low, i, j] : pairs) {
    if (std::isinf(low) || (least && Rational(low) > *least)) break;
    const std::optional<Rational> x = value(i, j, least);
    if (x && (!least || *x < *least)) least = x;
  }
  return least;
}

void set_number(RightAnswer& e, const Rational& x) {
  const auto d = x.convert_to<double>();
  e.least = std::nextafter(std::nextafter(d, -1.0), -1.0);
  e.most = std::nextafter(std::nextafter(d, kNever), HUGE_VAL);
}

void set_root(RightAnswer& e, const Rational& square) {
  const double d = std::sqrt(square.convert_to<double>());
  e.least = d * (1 - 4e-16);
  e.most = d * (1 + 4e-16);
}

Rational distance_sq(const Question& q) {
  const Faces a(q.a), b(q.b);
  return *least_of_pairs(
      a, b,
      [](const AlignedBox3d& s, const AlignedBox3d& t) { return s.squaredExteriorDistance(t) * (1 - 1e-12); },
      [&](std::size_t i, std::size_t j, const auto&) {
        return std::optional(oracle::distance_sq(a.x[i], b.x[j]));
      });
}

/// Returns a lower bound on the time t at which box b, translated by `from` + t * `towards`, intersects box
/// a; infinite: never.
double box_time(const AlignedBox3d& a, const AlignedBox3d& b, const Vector3d& from, const Vector3d& towards) {
  double begin = 0, end = 1;
  for (int k = 0; k < 3; ++k) {
    const double slack = 1e-9 * towards.norm();
    const double low = b.min()[k] + from[k] - a.max()[k] - slack,
                 high = b.max()[k] + from[k] - a.min()[k] + slack;
    if (towards[k] == 0) {
      if (low > 0 || high < 0) return HUGE_VAL;
      continue;
    }
    const double t = -low / towards[k], u = -high / towards[k];
    begin = std::max(begin, std::min(t, u));
    end = std::min(end, std::max(t, u));
  }
  return begin > end ? HUGE_VAL : begin;
}

std::optional<Rational> first_time(const Question& q) {
  const Faces a(q.a), b(q.b);
  const RationalPoint from = oracle::rational(q.from), towards = oracle::minus(oracle::rational(q.to), from);
  return least_of_pairs(
      a, b,
      [&](const AlignedBox3d& s, const AlignedBox3d& t) { return box_time(s, t, q.from, q.to - q.from); },
      [&](std::size_t i, std::size_t j, const std::optional<Rational>& first) {
        RationalPoints there;
        for (const RationalPoint& x : b.exact[j]) there.push_back(oracle::moved(x, from, 1));
        return oracle::first_time(a.exact[i], there, towards, first.value_or(1));
      });
}

RationalPoint normal_of(const RationalPoints& t) {
  return oracle::cross(oracle::minus(t[1], t[0]), oracle::minus(t[2], t[0]));
}

/// Returns the squared depth of two convex bodies, or nullopt if one is not convex: the least separation
/// along the normals of faces, and the cross products of edges.
std::optional<Rational> depth_sq(const Question& q) {
  const Faces of[] = {Faces(q.a), Faces(q.b)};
  RationalPoints normals[2], edges[2];
  for (std::size_t side = 0; side < 2; ++side) {
    const Faces& faces = of[side];
    std::set<std::pair<VertexId, VertexId>> seen;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const RationalPoint n = normal_of(faces.exact[f]);
      if (oracle::dot(n, n) == 0) continue;
      for (const RationalPoint& x : faces.points)
        if (oracle::dot(n, oracle::minus(x, faces.exact[f][0])) > 0) return std::nullopt;
      normals[side].push_back(n);
      const auto& c = faces.corners[f];
      for (int k = 0; k < 3; ++k)
        if (seen.insert(std::minmax(c[k], c[(k + 1) % 3])).second)
          edges[side].push_back(oracle::minus(faces.points[c[(k + 1) % 3]], faces.points[c[k]]));
    }
    if (normals[side].size() <= 3) return std::nullopt;
  }
  std::optional<Rational> least;
  const auto try_out = [&](const RationalPoint& n) {
    if ((least && *least == 0) || oracle::dot(n, n) == 0) return;
    std::optional<Rational> far, near;
    for (const RationalPoint& x : of[0].points)
      if (const Rational d = oracle::dot(n, x); !far || d > *far) far = d;
    for (const RationalPoint& x : of[1].points)
      if (const Rational d = oracle::dot(n, x); !near || d < *near) near = d;
    const Rational overlap = *far - *near;
    const Rational d = overlap <= 0 ? Rational(0) : Rational(overlap * overlap / oracle::dot(n, n));
    if (!least || d < *least) least = d;
  };
  const RationalPoint zero = {0, 0, 0};
  for (const RationalPoint& n : normals[0]) try_out(n);
  for (const RationalPoint& n : normals[1]) try_out(oracle::minus(zero, n));
  for (const RationalPoint& e : edges[0])
    for (const RationalPoint& f : edges[1]) {
      try_out(oracle::cross(e, f));
      try_out(oracle::cross(f, e));
    }
  return least;
}

// Lists of pairs: those within a distance, and self-intersections. By rational arithmetic where doubles do
// not decide with a margin.

/// Differences of doubles, and sums of a few squares of them, have smaller relative errors.
constexpr double kMargin = 1e-12;

bool is_within(const Faces& a, std::size_t i, const Faces& b, std::size_t j, double within) {
  if (within == 0 && !a.boxes[i].intersects(b.boxes[j])) return false;
  // Squares of smaller numbers lose digits.
  constexpr double kLeastSquare = 1e-280;
  if (const double square = within * within; square > kLeastSquare) {
    if (a.boxes[i].squaredExteriorDistance(b.boxes[j]) * (1 - kMargin) > square) return false;
    for (const Vector3d& p : a.x[i])
      for (const Vector3d& q : b.x[j])
        if ((p - q).squaredNorm() < square * (1 - kMargin)) return true;
  }
  return oracle::distance_sq(a.x[i], b.x[j]) <= oracle::square(within);
}

bool has_area(const RationalPoints& t) {
  const RationalPoint n = normal_of(t);
  return oracle::dot(n, n) != 0;
}

/// Returns true if two triangles with area share a point beyond the corners and edges that they share by
/// index.
bool intersect_beyond_shared(const Faces& f, std::size_t i, std::size_t j) {
  const RationalPoints &s = f.exact[i], &t = f.exact[j];
  std::vector<std::size_t> shared_i, shared_j;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l)
      if (f.corners[i][k] == f.corners[j][l]) shared_i.push_back(k), shared_j.push_back(l);
  switch (shared_i.size()) {
    case 0:
      return !oracle::clearly_apart(s, t) && oracle::simplices_meet(s, t);
    case 1: {
      // Both triangles are starlike about the corner: a ray from it leaves them in their opposite edges, and
      // the intersection in the nearer of the two.
      const std::size_t k = shared_i[0], l = shared_j[0];
      return oracle::simplices_meet({s[(k + 1) % 3], s[(k + 2) % 3]}, t) ||
             oracle::simplices_meet(s, {t[(l + 1) % 3], t[(l + 2) % 3]});
    }
    case 2: {
      // Only in a common plane, on the same side of the edge.
      const RationalPoint edge = oracle::minus(s[shared_i[1]], s[shared_i[0]]);
      const auto side = [&](const RationalPoints& all, const std::vector<std::size_t>& of) {
        return oracle::cross(edge, oracle::minus(all[3 - of[0] - of[1]], all[of[0]]));
      };
      const RationalPoint u = side(s, shared_i), v = side(t, shared_j), out = oracle::cross(u, v);
      return oracle::dot(out, out) == 0 && oracle::dot(u, v) > 0;
    }
    default:
      return true;  // the same triangle twice
  }
}

}  // namespace

std::vector<SimplexPair> true_near_pairs(const LrbRep& a, const LrbRep& b, double within) {
  const Faces of_a(a), of_b(b);
  std::vector<SimplexPair> out;
  for (std::size_t i = 0; i < of_a.size(); ++i)
    for (std::size_t j = 0; j < of_b.size(); ++j)
      if (is_within(of_a, i, of_b, j, within))
        out.push_back({static_cast<SimplexId>(i), static_cast<SimplexId>(j)});
  return out;
}

std::vector<SimplexPair> true_self_intersections(const LrbRep& body) {
  const Faces f(body);
  std::vector<bool> area;
  for (const RationalPoints& t : f.exact) area.push_back(has_area(t));
  std::vector<SimplexPair> out;
  for (std::size_t i = 0; i < f.size(); ++i)
    for (std::size_t j = i + 1; j < f.size(); ++j)
      if (area[i] && area[j] && f.boxes[i].intersects(f.boxes[j]) && intersect_beyond_shared(f, i, j))
        out.push_back({static_cast<SimplexId>(i), static_cast<SimplexId>(j)});
  return out;
}

RightAnswer true_number(Quantity quantity, const cases::Case& c) {
  RightAnswer e;
  e.rejection = why_unsupported(quantity, c);
  if (!e.rejection.empty()) return e;
  const Question q = question_of(c);
  e.size = q.size;
  if (quantity == Quantity::near_pairs) {
    e.pairs = true_near_pairs(q.a, q.b, q.within);
  } else if (quantity == Quantity::self_intersections) {
    e.pairs = true_self_intersections(methods::union_of(q));
  } else if (quantity == Quantity::distance) {
    const bool meet = !brute_force(q.a, Pose{}, q.b, Pose{}).pairs.empty();
    set_root(e, meet ? Rational(0) : distance_sq(q));
  } else if (quantity == Quantity::first_contact) {
    if (const auto t = first_time(q))
      set_number(e, *t);
    else
      e.least = e.most = kNever;
  } else if (const auto depth = depth_sq(q)) {
    set_root(e, *depth);
  } else {
    e.rejection = "a non-convex body, whose depth has no independent reference";
  }
  return e;
}

methods::Answer ask_number(const methods::MethodEntry& method, const cases::Case& c) {
  methods::Answer out;
  workers::note_failures(out, [&] {
    const std::string why = why_unsupported(method.info.quantity, c);
    if (!why.empty()) throw InputError("skipped: " + why);
    out = method.ask(question_of(c), std::nullopt);
  });
  return out;
}

}  // namespace lrb::quantities

// What kind of contact, and how deep: against bodies whose answers are known, rational brute force over
// convex pairs, and exact arithmetic over bodies of cells.
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include <doctest/doctest.h>

#include "bench/stability/rational_oracles.hpp"
#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/clash.hpp>

using namespace lrb;
using Eigen::Vector3d;
using oracle::Rational;
using shapes::RandomEngine;

namespace {

/// Multiplies the number of random cases: LRB_CLASH_SHARE=100 query_tests -tc="clash*".
int share() {
  const char* const text = std::getenv("LRB_CLASH_SHARE");
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

using test::closed;

ClashResult ask(const LrbRep& a, const LrbRep& b, const Pose& pose_b = {}, const ClashRequest& request = {}) {
  return clash(a, Pose{}, b, pose_b, request);
}

ClashResult ask(const Mesh& a, const Mesh& b, const Pose& pose_b = {}, const ClashRequest& request = {}) {
  return ask(closed(a), closed(b), pose_b, request);
}

void check_holds(const std::optional<ProvedInterval>& interval, double value, double width) {
  REQUIRE(interval.has_value());
  CAPTURE(interval->lower);
  CAPTURE(interval->upper);
  CAPTURE(value);
  CHECK(interval->lower <= value);
  CHECK(interval->upper >= value);
  CHECK(interval->upper - interval->lower <= width);
}

/// The bodies are apart, as the exact query sees them, once B has moved by the translation, which is as long
/// as the upper end of the depth.
void check_translation(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                       const ClashResult& result) {
  REQUIRE(result.depth.has_value());
  REQUIRE(result.depth->upper < std::numeric_limits<double>::infinity());
  CHECK(result.depth->lower <= result.depth->upper);
  CHECK(result.translation.norm() <= result.depth->upper);
  CHECK(result.translation.norm() >= result.depth->upper * (1 - 1e-12));
  const Pose moved{pose_b.r, pose_b.t + result.translation};
  CHECK(collide(a, pose_a, b, moved).relation == Relation::separate);
}

}  // namespace

TEST_CASE("clash: a limit of steps widens the depth's interval, which stays proven") {
  const LrbRep body = closed(shapes::torus(20, 12));
  const Pose pose = Pose::rotation({1, 2, 3}, 0.7, {0.6, 0.5, 0.2});
  const ClashResult whole = ask(body, body, pose);
  double last = HUGE_VAL;
  for (const std::uint64_t steps : {1, 100, 1000, 1000000}) {
    CAPTURE(steps);
    ClashRequest request;
    request.max_steps = steps;
    const ClashResult r = ask(body, body, pose, request);
    CHECK(r.kind == whole.kind);
    CHECK(r.volume->upper == whole.volume->upper);
    CHECK(r.depth->lower <= whole.depth->upper);
    CHECK(r.depth->upper >= whole.depth->lower);
    CHECK(r.finished == (steps == 1000000));
    CHECK(r.depth->upper - r.depth->lower <= last);
    last = r.depth->upper - r.depth->lower;
    check_translation(body, Pose{}, body, pose, r);
  }
  CHECK(last == whole.depth->upper - whole.depth->lower);
}

TEST_CASE("clash: far from the origin, translations separate bodies although positions are rounded") {
  RandomEngine random(27);
  const Vector3d far = Vector3d::Constant(0x1p38);
  for (int i = 0; i < 12 * share(); ++i) {
    CAPTURE(i);
    Mesh bodies[2] = {shapes::l_shape(), shapes::l_shape()};
    for (Mesh& mesh : bodies) {
      const Eigen::Matrix3d turn = shapes::random_rotation(random);
      // On the grid of doubles near 2^38, so that the bodies can be moved to the origin exactly.
      for (Vector3d& x : mesh.vertices)
        x = (0x1p14 * (turn * (x - Vector3d::Constant(0.5)))).array().round() * 0x1p-14;
    }
    const ClashResult r = ask(shapes::translated(bodies[0], far), shapes::translated(bodies[1], far));
    REQUIRE(r.depth->lower > 0);
    const Pose moved = Pose::translation(r.translation);
    CHECK(collide(closed(bodies[0]), {}, closed(bodies[1]), moved).relation == Relation::separate);
  }
}

TEST_CASE("clash: touching, separate, and within a clearance") {
  const Mesh a = shapes::box();
  const auto kind = [&](const Vector3d& at, double clearance = 0) {
    ClashRequest request;
    request.clearance = clearance;
    const ClashResult r = ask(a, a, Pose::translation(at), request);
    check_holds(r.depth, 0, 0);
    check_holds(r.volume, 0, 0);
    CHECK(r.interiors_overlap == Answer::no);
    return r.kind;
  };
  CHECK(kind({1, 0.25, 0.5}) == ClashKind::touching_face);
  CHECK(kind({1, 0, 0}) == ClashKind::touching_face);
  CHECK(kind({1, 1, 0.5}) == ClashKind::touching_edge);
  CHECK(kind({1, 1, 0}) == ClashKind::touching_edge);
  CHECK(kind({1, 1, 1}) == ClashKind::touching_point);
  CHECK(kind({1.25, 0, 0}) == ClashKind::apart);
  CHECK(kind({1.25, 0, 0}, 0.25) == ClashKind::within_clearance);
  CHECK(kind({1.25, 0, 0}, std::nextafter(0.25, 0.0)) == ClashKind::apart);
  // A corner on a face.
  const Mesh tip = shapes::tetrahedron();
  CHECK(ask(a, shapes::translated(shapes::turned_inside_out(tip), {0, 0, 0})).kind != ClashKind::undecided);
  Mesh spike = shapes::tetrahedron();
  for (Vector3d& x : spike.vertices)
    x = Vector3d(0.5, 0.5, 1) + Vector3d(x.x() - 0.1 * x.z(), x.y(), x.x() + x.y() + x.z());
  CHECK(ask(a, spike).kind == ClashKind::touching_point);
}

TEST_CASE("clash: enclosed, equal, flush") {
  const Mesh a = shapes::box();
  const auto kind_of = [&](const Mesh& x, const Mesh& y) { return ask(x, y).kind; };
  const Mesh small = shapes::box({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5});
  CHECK(kind_of(a, small) == ClashKind::b_inside_a);
  CHECK(kind_of(small, a) == ClashKind::a_inside_b);
  CHECK(kind_of(a, a) == ClashKind::equal);
  CHECK(kind_of(a, shapes::subdivided(a)) == ClashKind::equal);
  const Mesh flush = shapes::box({0, 0.25, 0.25}, {0.5, 0.5, 0.5});
  CHECK(kind_of(a, flush) == ClashKind::b_inside_a);
  CHECK(ask(a, flush).shares_faces);
  CHECK(!ask(a, small).shares_faces);
  check_holds(ask(a, small).depth, 0.5, 1e-11);
  check_holds(ask(a, a).depth, 1, 1e-11);
  check_holds(ask(a, shapes::subdivided(a)).volume, 1, 1e-10);
  check_holds(ask(a, a).volume, 1, 1e-10);
  // A plate within the other body: at most its own volume.
  const double top = 0.5 + 1e-11;
  check_holds(ask(a, shapes::box({0.25, 0.25, 0.5}, {0.75, 0.75, top})).volume, 0.25 * (top - 0.5), 5e-12);
  // At most that of the box of the overlap.
  check_holds(
      ask(shapes::subdivided(a), shapes::subdivided(shapes::box({1 - 0x1p-40, 0, 0}, {2, 1, 1}))).volume,
      0x1p-40, 9e-12);
  // Shifted along an edge: no face crosses another.
  const ClashResult shifted = ask(a, shapes::translated(a, {0.5, 0, 0}));
  CHECK(shifted.kind == ClashKind::protrudes);
  CHECK(shifted.shares_faces);
  check_holds(shifted.depth, 0.5, 1e-11);
  // What fills a void touches from within, and no volume is shared.
  const Mesh hollow = shapes::box_with_void();
  const Mesh filling = shapes::box({1, 1, 1}, {2, 2, 2});
  CHECK(kind_of(hollow, filling) == ClashKind::touching_face);
  const ClashResult around = ask(hollow, shapes::box({0.5, 0.5, 0.5}, {2.5, 2.5, 2.5}));
  CHECK(around.kind == ClashKind::protrudes);
  check_holds(around.volume, 7, 1e-9);
  check_holds(ask(hollow, shapes::box({1.25, 1.25, 1.25}, {1.5, 1.5, 1.5})).volume, 0, 0);
}

TEST_CASE("clash: protrudes, pierces, cuts through") {
  const Mesh plate = shapes::box({-2, -2, 0}, {2, 2, 0.5});
  const Mesh nail = shapes::box({-0.25, -0.25, -2}, {0.25, 0.25, 2});
  const ClashResult through = ask(nail, plate);
  CHECK(through.kind == ClashKind::pierces);
  CHECK(through.pieces[0].outside == 2);
  CHECK(through.pieces[0].inside == 1);
  CHECK(through.pieces[1].outside == 1);
  CHECK(through.pieces[1].inside == 2);
  check_holds(through.volume, 0.125, 1e-9);
  check_holds(through.depth, 2, 1e-10);
  CHECK(ask(plate, nail).kind == ClashKind::cuts_through);
  const ClashResult into = ask(nail, plate, Pose::translation({0, 0, 1.75}));
  CHECK(into.kind == ClashKind::protrudes);
  check_holds(into.depth, 0.25, 1e-11);
  const ClashResult ball = ask(shapes::icosphere(3), shapes::box({0.5, -2, -2}, {3, 2, 2}));
  CHECK(ball.kind == ClashKind::protrudes);
  CHECK(ball.depth->upper <= 0.5 + 1e-9);
  CHECK(ball.depth->lower >= 0.49);
  CHECK(ball.depth->upper - ball.depth->lower < 1e-10);
  // A ring, and a bar through its tube on one side; then through both.
  const Mesh ring = shapes::torus(24, 12);
  CHECK(ask(shapes::box({0.9, -0.1, -2}, {1.1, 0.1, 2}), ring).kind == ClashKind::pierces);
  CHECK(ask(shapes::box({-3, -0.1, -0.1}, {3, 0.1, 0.1}), ring).pieces[0].outside == 3);
  CHECK(ask(shapes::box({-0.1, -0.1, -3}, {0.1, 0.1, 3}), ring).kind == ClashKind::apart);
}

namespace {

using Vec = std::array<Rational, 3>;

Vec cross(const Vec& x, const Vec& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

std::vector<Vec> world_points(const LrbRep& rep, const Pose& pose) {
  std::vector<Vec> out;
  for (const Vector3d& x : rep.vertices()) {
    const Vector3d w = pose.apply(x);
    out.push_back({Rational(w.x()), Rational(w.y()), Rational(w.z())});
  }
  return out;
}

/// Every direction that can be normal to a facet of the difference of two convex bodies.
std::vector<Vec> facet_normals(const LrbRep& a, const std::vector<Vec>& of_a, const LrbRep& b,
                               const std::vector<Vec>& of_b) {
  std::vector<Vec> edges[2], out;
  const auto add = [&](const Vec& n) {
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) return;
    out.push_back(n);
    out.push_back({-n[0], -n[1], -n[2]});
  };
  for (int side = 0; side < 2; ++side) {
    const LrbRep& rep = side == 0 ? a : b;
    const std::vector<Vec>& x = side == 0 ? of_a : of_b;
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      VertexId v[3] = {};
      rep.simplex(s, v);
      add(cross(oracle::minus(x[v[1]], x[v[0]]), oracle::minus(x[v[2]], x[v[0]])));
      for (int k = 0; k < 3; ++k)
        if (v[k] < v[(k + 1) % 3]) edges[side].push_back(oracle::minus(x[v[(k + 1) % 3]], x[v[k]]));
    }
  }
  for (const Vec& e : edges[0])
    for (const Vec& f : edges[1]) add(cross(e, f));
  return out;
}

/// How far B must move along n until a plane across n parts the two, times the length of n.
Rational width(const Vec& n, const std::vector<Vec>& of_a, const std::vector<Vec>& of_b) {
  Rational high = oracle::dot(n, of_a[0]), low = oracle::dot(n, of_b[0]);
  for (const Vec& x : of_a) high = std::max(high, oracle::dot(n, x));
  for (const Vec& x : of_b) low = std::min(low, oracle::dot(n, x));
  return high - low;
}

/// Compares depth and separation vector of two convex bodies with the minimum over all facets of their
/// Minkowski difference, which are rational but for roots. Returns false if they do not overlap.
bool check_convex(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const Vector3d& along, double narrow) {
  const std::vector<Vec> of_a = world_points(a, pose_a), of_b = world_points(b, pose_b);
  const Vec u = {Rational(along.x()), Rational(along.y()), Rational(along.z())};
  Rational depth_sq = -1, way = -1;
  for (const Vec& n : facet_normals(a, of_a, b, of_b)) {
    const Rational w = width(n, of_a, of_b);
    if (w <= 0) return false;
    const Rational sq = w * w / oracle::dot(n, n), slope = oracle::dot(n, u);
    if (depth_sq < 0 || sq < depth_sq) depth_sq = sq;
    if (slope > 0 && (way < 0 || w / slope < way)) way = w / slope;
  }
  ClashRequest request;
  request.along = along;
  const ClashResult r = clash(a, pose_a, b, pose_b, request);
  REQUIRE(r.depth.has_value());
  REQUIRE(r.along.has_value());
  CAPTURE(std::sqrt(depth_sq.convert_to<double>()));
  CAPTURE(way.convert_to<double>());
  CAPTURE(r.depth->lower);
  CAPTURE(r.depth->upper);
  CAPTURE(r.along->lower);
  CAPTURE(r.along->upper);
  REQUIRE(oracle::square(r.depth->lower) <= depth_sq);
  REQUIRE(oracle::square(r.depth->upper) >= depth_sq);
  REQUIRE(r.depth->upper - r.depth->lower <= narrow);
  // Lengths along a vector that is of length 1 but for rounding.
  const double length = along.stableNorm();
  REQUIRE(r.along->lower <= way.convert_to<double>() * length * (1 + 1e-14));
  REQUIRE(r.along->upper >= way.convert_to<double>() * length * (1 - 1e-14));
  REQUIRE(r.along->upper - r.along->lower <= 1e-9 + narrow);
  check_translation(a, pose_a, b, pose_b, r);
  return true;
}

Mesh random_convex(RandomEngine& random, int which) {
  Mesh mesh = which == 0 ? shapes::tetrahedron() : which == 1 ? shapes::box() : shapes::icosphere(0);
  // A linear map keeps it convex.
  Eigen::Matrix3d m;
  do {
    for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = shapes::uniform(random, -1, 1);
  } while (m.determinant() < 0.05);
  for (Vector3d& x : mesh.vertices) x = m * x;
  return mesh;
}

}  // namespace

TEST_CASE("clash: convex pairs against all facets of their Minkowski difference, in rational arithmetic") {
  RandomEngine random(17);
  int overlap = 0;
  const int pairs = 40 * share();
  for (int i = 0; i < pairs; ++i) {
    CAPTURE(i);
    const LrbRep a = closed(random_convex(random, i % 2)), b = closed(random_convex(random, i / 2 % 2));
    Pose pose_a{shapes::random_rotation(random), Vector3d::Zero()};
    Pose pose_b{shapes::random_rotation(random), 0.4 * shapes::random_direction(random)};
    // Far off, where corners cross a power of two while they move and so are rounded by other units.
    // Not so far that the corners' rounding leaves no body convex.
    const double far = i % 4 == 3 ? std::exp2(random() % 24) : 0;
    for (Pose* const pose : {&pose_a, &pose_b}) pose->t += far * Vector3d(1, -1, 1);
    overlap += check_convex(a, pose_a, b, pose_b, shapes::random_direction(random), 1e-10 + 0x1p-42 * far);
  }
  CHECK(overlap > pairs / 3);
}

namespace {

using Cells = std::set<std::array<int, 3>>;

Mesh mesh_of(const Cells& cells) {
  return shapes::voxels(3, 3, 3, [&](int i, int j, int k) { return cells.contains({i, j, k}); });
}

/// A random polycube without edges or corners that hang together by themselves.
Cells random_cells(RandomEngine& random) {
  Cells cells{{1, 1, 1}};
  for (int i = 0; i < 5; ++i) {
    auto cell = *std::next(cells.begin(), static_cast<long>(random() % cells.size()));
    const std::size_t axis = random() % 3;
    cell[axis] = std::clamp(cell[axis] + (random() % 2 == 0 ? 1 : -1), 0, 2);
    cells.insert(cell);
  }
  return cells;
}

/// The depth of bodies of cells, exactly but for a root: B's translations after which no two cells overlap
/// are those outside a union of open boxes; the nearest of them is nearest in a cell of the grid of their
/// sides.
double cells_depth(const Cells& a, const Cells& b, const Vector3d& at) {
  std::vector<double> sides[3];
  std::vector<std::array<double, 3>> lows;  // boxes, 2 wide
  for (const auto& p : a)
    for (const auto& q : b) {
      std::array<double, 3> low;
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = p[k] - q[k] - at[static_cast<int>(k)] - 1;
        sides[k].push_back(low[k]);
        sides[k].push_back(low[k] + 2);
      }
      lows.push_back(low);
    }
  struct Part {
    double inside, nearest;
  };
  std::vector<Part> parts[3];
  for (int k = 0; k < 3; ++k) {
    auto& s = sides[k];
    std::sort(s.begin(), s.end());
    s.erase(std::unique(s.begin(), s.end()), s.end());
    parts[k].push_back({s.front() - 1, std::min(0.0, s.front())});
    parts[k].push_back({s.back() + 1, std::max(0.0, s.back())});
    for (std::size_t i = 0; i < s.size(); ++i) {
      parts[k].push_back({s[i], s[i]});
      if (i + 1 < s.size()) parts[k].push_back({(s[i] + s[i + 1]) / 2, std::clamp(0.0, s[i], s[i + 1])});
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Part& x : parts[0])
    for (const Part& y : parts[1])
      for (const Part& z : parts[2]) {
        const Vector3d nearest(x.nearest, y.nearest, z.nearest), inside(x.inside, y.inside, z.inside);
        if (!(nearest.norm() < least)) continue;
        const bool meets = std::any_of(lows.begin(), lows.end(), [&](const auto& low) {
          for (std::size_t k = 0; k < 3; ++k) {
            const double d = inside[static_cast<int>(k)] - low[k];
            if (!(d > 0 && d < 2)) return false;
          }
          return true;
        });
        if (!meets) least = nearest.norm();
      }
  return least;
}

double cells_volume(const Cells& a, const Cells& b, const Vector3d& at) {
  double sum = 0;
  for (const auto& p : a)
    for (const auto& q : b) {
      double v = 1;
      for (std::size_t k = 0; k < 3; ++k)
        v *= std::max(0.0, 1 - std::abs(p[k] - q[k] - at[static_cast<int>(k)]));
      sum += v;
    }
  return sum;
}

}  // namespace

TEST_CASE("clash: non-convex bodies of cells: intervals contain depth and volume") {
  RandomEngine random(19);
  int overlap = 0, found = 0;
  for (int i = 0; i < 60 * share(); ++i) {
    CAPTURE(i);
    const Cells of_a = random_cells(random), of_b = random_cells(random);
    const Mesh mesh_a = mesh_of(of_a), mesh_b = mesh_of(of_b);
    Vector3d at;
    for (int k = 0; k < 3; ++k) at[k] = 0.125 * (static_cast<int>(random() % 33) - 16);
    const LrbRep a = closed(mesh_a), b = closed(mesh_b);
    const Pose pose_b = Pose::translation(at);
    const ClashResult r = ask(a, b, pose_b);
    const double depth = cells_depth(of_a, of_b, at), volume = cells_volume(of_a, of_b, at);
    CAPTURE(depth);
    CAPTURE(volume);
    if (r.kind == ClashKind::undecided) continue;  // cells that meet in an edge alone
    CHECK((r.interiors_overlap == Answer::yes) == (volume > 0));
    check_holds(r.volume, volume, 1e-9);
    REQUIRE(r.depth.has_value());
    CAPTURE(r.depth->lower);
    CAPTURE(r.depth->upper);
    CHECK(r.depth->lower <= depth * (1 + 1e-14));
    CHECK(r.depth->upper >= depth * (1 - 1e-14));
    if (volume == 0) continue;
    ++overlap;
    CHECK(r.depth->lower > 0);
    check_translation(a, Pose{}, b, pose_b, r);
    found += r.depth->upper < depth + 1e-9;
  }
  CHECK(overlap > 25 * share());
  CHECK(found > overlap * 8 / 10);  // the shortest separation vector, which is not guaranteed
}

TEST_CASE("clash: the same solid in more faces gives the same intervals") {
  const Pose turned = Pose::rotation({1, 2, 3}, 0.7, {0.6, 0.3, 0.2});
  const auto compare = [&](const Mesh& a, const Mesh& b, double tolerance) {
    ClashRequest request;
    request.along = Vector3d(1, 0.5, -0.25);
    const ClashResult first = ask(a, b, turned, request);
    Mesh fine_a = a, fine_b = b;
    for (int level = 0; level < 2; ++level) {
      fine_a = shapes::subdivided(fine_a);
      fine_b = shapes::subdivided(fine_b);
      const ClashResult r = ask(fine_a, fine_b, turned, request);
      CHECK(r.kind == first.kind);
      const auto close = [&](const std::optional<ProvedInterval>& x, const std::optional<ProvedInterval>& y) {
        REQUIRE((x && y));
        CHECK(std::abs(x->lower - y->lower) <= tolerance);
        CHECK(std::abs(x->upper - y->upper) <= tolerance);
      };
      close(r.depth, first.depth);
      close(r.along, first.along);
      close(r.volume, first.volume);
      CHECK((r.translation - first.translation).norm() <= 1e-6);
    }
  };
  compare(shapes::box(), shapes::box(), 1e-10);
  compare(shapes::tetrahedron(2), shapes::box(), 1e-10);
  compare(shapes::l_shape(), shapes::box(), 1e-9);
  compare(shapes::l_shape(), shapes::comb(2, 2), 1e-9);
}

#include "engine/mesh/self_intersections.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/hull_oracle.hpp"
#include "tests/support/rational_oracle.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/self_intersections.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

Points corners_of(const Mesh& m, FaceId f) {
  Points out;
  for (const VertexId v : m.face(f)) out.push_back(m.vertices[v]);
  return out;
}

int oracle_meet(const Points& a, const Points& b) {
  return oracle::meet_of_simplices(pointers(a).data(), pointers(b).data(), a.size());
}

/// Every pair of triangles without a common vertex that meets, by linear programming over all pairs.
Pairs meeting_strangers(const Mesh& m) {
  Pairs found;
  for (FaceId f = 0; f < m.face_count(); ++f)
    for (FaceId g(f + 1); g < m.face_count(); ++g) {
      const auto a = m.face(f), b = m.face(g);
      if (std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end()) continue;
      if (oracle_meet(corners_of(m, f), corners_of(m, g)) != 0) found.push_back({f, g});
    }
  return found;
}

/// Returns the pairs with kinds, segments and curves, the same for any number of threads.
SelfIntersections listed_in(const Mesh& m) {
  const CheckedMesh checked = check(m);
  const SelfIntersections one = self_intersections(checked, 1), many = self_intersections(checked, 3);
  CHECK(one.segments == many.segments);
  CHECK(one.curves == many.curves);
  REQUIRE(one.pairs.size() == many.pairs.size());
  for (std::size_t i = 0; i < one.pairs.size(); ++i) {
    CHECK(one.pairs[i].a == many.pairs[i].a);
    CHECK(one.pairs[i].b == many.pairs[i].b);
    CHECK(one.pairs[i].kind == many.pairs[i].kind);
    CHECK(one.pairs[i].curve == many.pairs[i].curve);
  }
  return one;
}

/// Checks kinds by the oracle's classification of two simplices, and that ends of segments are on both.
void check_kinds(const Mesh& m, const SelfIntersections& found, const Pairs& expected) {
  REQUIRE(found.pairs.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const SelfIntersection& pair = found.pairs[i];
    CAPTURE(pair.a);
    CAPTURE(pair.b);
    REQUIRE(std::array<std::uint32_t, 2>{pair.a, pair.b} == expected[i]);
    CHECK(pair.shared == 0);
    REQUIRE(pair.segments > 0);
    CHECK(pair.curve < found.curves);
    const Points of_a = corners_of(m, pair.a), of_b = corners_of(m, pair.b);
    // 2: their interiors cross. An overlap has an area (2D: a length).
    const bool crosses = oracle_meet(of_a, of_b) == 2;
    CHECK((pair.kind == SelfContact::cross) == crosses);
    const bool has_area =
        m.dim == 3 ? pair.segments >= 3
                   : found.segments[pair.first_segment][0] != found.segments[pair.first_segment][1];
    CHECK((pair.kind == SelfContact::overlap) == (!crosses && has_area));
    for (std::uint32_t s = 0; s < pair.segments; ++s)
      for (const Eigen::Vector3d& x : found.segments[pair.first_segment + s]) {
        CHECK(simplex_distance({x}, of_a) < 1e-12);
        CHECK(simplex_distance({x}, of_b) < 1e-12);
      }
  }
}

void check_against_oracle(const Mesh& m) {
  const Pairs expected = meeting_strangers(m);
  check_kinds(m, listed_in(m), expected);
  const MeshFinding finding = check_mesh(m)[MeshFault::self_intersection];
  CHECK(finding.count == expected.size());
  std::set<FaceId> faces;
  for (const auto& pair : expected) faces.insert(pair.begin(), pair.end());
  MeshReport unused;
  Workers workers(2);
  CHECK(self_intersecting_faces(m, check_faces(m, unused), workers) ==
        std::vector<FaceId>(faces.begin(), faces.end()));
  CHECK(finding.first ==
        Pairs(expected.begin(), expected.begin() + std::min<std::size_t>(8, expected.size())));
}

/// Do faces overlap as those of solids that touch do not?
bool overlaps(const Mesh& m) {
  MeshReport unused;
  return overlaps_itself(m, check_faces(m, unused));
}

Mesh random_soup(std::uint64_t seed, int triangles, int dim) {
  std::mt19937_64 random(seed);
  Mesh m;
  m.dim = dim;
  while (m.face_count() < static_cast<std::size_t>(triangles)) {
    std::vector<VertexId> corners;
    for (int i = 0; i < dim; ++i) {
      corners.push_back(static_cast<VertexId>(m.vertices.size()));
      m.vertices.emplace_back(random() % 8, random() % 8, dim == 3 ? random() % 8 : 0);
    }
    Mesh one;
    one.dim = dim;
    one.vertices = m.vertices;
    one.add_face(corners);
    if (check_mesh(one, false)[MeshFault::zero_area_face].count == 0) m.add_face(corners);
  }
  return m;
}

/// Returns true if the hulls of two faces intersect beyond their common corners: if a point of both is
/// possible with a positive weight of a corner that is not common. A linear program decides this for each
/// such corner.
bool intersect_beyond_shared(const Mesh& m, FaceId f, FaceId g) {
  const std::span<const VertexId> a = m.face(f), b = m.face(g);
  const auto corners = [&](std::span<const VertexId> face) {
    oracle::Points<std::int64_t> out;
    for (const VertexId v : face) {
      out.emplace_back();
      for (int k = 0; k < m.dim; ++k) out.back().push_back(static_cast<std::int64_t>(m.vertices[v][k]));
    }
    return out;
  };
  const auto of_a = corners(a), of_b = corners(b);
  std::size_t own = 0;
  for (std::size_t k = 0; k < a.size() + b.size(); ++k) {
    const bool first = k < a.size();
    const auto other = first ? b : a;
    const VertexId v = first ? a[k] : b[k - a.size()];
    if (std::find(other.begin(), other.end(), v) != other.end()) continue;
    ++own;
    if (oracle::meet_with_positive_weight(of_a, of_b, k)) return true;
  }
  return own == 0;  // the same face twice
}

/// Compares the pairs of soups on a grid, of faces with an area, with all pairs by linear programming.
int check_self_grids(int meshes) {
  RandomEngine random(8);
  int found = 0;
  for (int i = 0; i < meshes;) {
    CAPTURE(i);
    const Mesh m = grid_soup(random, 4, i % 4 == 0 ? 2 : 3, i % 3 == 0 ? 0 : 6);
    const CheckedMesh checked = check(m);
    if (checked.report()[MeshFault::zero_area_face].count > 0) continue;
    ++i;
    Pairs expected, pairs;
    for (FaceId f = 0; f < m.face_count(); ++f)
      for (FaceId g(f + 1); g < m.face_count(); ++g)
        if (intersect_beyond_shared(m, f, g)) expected.push_back({f, g});
    for (const SelfIntersection& pair : self_intersections(checked, 1).pairs)
      pairs.push_back({pair.a, pair.b});
    REQUIRE(pairs == expected);
    found += static_cast<int>(pairs.size());
  }
  return found;
}

}  // namespace

TEST_CASE("self-intersections of triangles on a grid, with and without common corners") {
  CHECK(check_self_grids(1000) > 1000);
}

TEST_CASE("self-intersections of 100,000 sets of triangles on a grid" * doctest::test_suite("long")) {
  CHECK(check_self_grids(100'000) > 100'000);
}

TEST_CASE("self-intersections agree with an oracle over all pairs") {
  check_against_oracle(several({icosphere(1), translated(icosphere(1), {1, 0.25, 0})}));
  check_against_oracle(several({box(), translated(box(), {0.5, 0.5, 0.5})}));
  check_against_oracle(several({box(), translated(box(), {1, 0, 0})}));          // two faces in one place
  check_against_oracle(several({box(), translated(box(), {1, 1, 0.5})}));        // an edge on an edge
  check_against_oracle(several({box(), translated(tetrahedron(), {1, 1, 1})}));  // a corner on a corner
  check_against_oracle(several({torus(9, 6), scaled(torus(9, 6), 1.2)}));
  check_against_oracle(several({star(7), star(6)}));
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    check_against_oracle(random_soup(seed, 40, 3));
    check_against_oracle(random_soup(seed, 40, 2));
  }
}

TEST_CASE("copies of triangles are counted with all their pairs, in time that grows with the faces") {
  Mesh m = random_soup(2, 12, 3);
  const auto copy = [&](std::size_t f) {
    const std::vector<VertexId> corners(m.face(FaceId(f)).begin(), m.face(FaceId(f)).end());
    m.add_face(corners);
  };
  for (std::size_t i = 0; i < 60; ++i) copy(i % 5);
  const std::vector<SelfIntersection> all = self_intersections(check(m), 1).pairs;
  const MeshFinding found = check_mesh(m)[MeshFault::self_intersection];
  CHECK(found.count == all.size());
  REQUIRE(found.first.size() == MeshFinding::kShown);
  for (std::size_t i = 0; i < found.first.size(); ++i)
    CHECK(found.first[i] == std::array<std::uint32_t, 2>{all[i].a, all[i].b});
  constexpr std::uint64_t kCopies = 300'000;
  for (std::uint64_t i = 0; i < kCopies; ++i) copy(0);
  CHECK(check_mesh(m)[MeshFault::self_intersection].count > kCopies * (kCopies - 1) / 2);
}

TEST_CASE("collinear corners are not self-intersections") {
  // A slab whose top and bottom have them on every side: their plain fans hold triangles without area.
  for (int shift = 0; shift < 8; ++shift) {
    Mesh m;
    m.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    for (VertexId v = 0; v < 8; ++v) m.vertices.push_back(m.vertices[v] + Eigen::Vector3d(0, 0, 1));
    std::vector<VertexId> top, bottom;
    for (int i = 0; i < 8; ++i) {
      top.push_back(static_cast<VertexId>(8 + (i + shift) % 8));
      bottom.push_back(static_cast<VertexId>((8 - i + shift) % 8));
    }
    m.add_face(top);
    m.add_face(bottom);
    for (VertexId i = 0; i < 8; ++i)
      m.add_face(std::array{i, VertexId((i + 1) % 8), VertexId(8 + (i + 1) % 8), VertexId(8 + i)});
    CHECK(check_mesh(m).lines(m).empty());
  }
  Mesh three_sided;  // only three proper corners
  three_sided.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {4, 0, 0},
                          {2, 2, 0}, {0, 4, 0}, {0, 1, 0}, {0, 0, 3}};
  three_sided.add_face(std::array<VertexId, 7>{0, 6, 5, 4, 3, 2, 1});
  for (VertexId i = 0; i < 7; ++i) three_sided.add_face(std::array<VertexId, 3>{i, VertexId((i + 1) % 7), 7});
  CHECK(check_mesh(three_sided).lines(three_sided).empty());
}

TEST_CASE("overlapping and touching solids") {
  struct Case {
    Mesh a, b;
    bool overlap;
  };
  const Mesh square = polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  for (const Case& c :
       std::vector<Case>{{box(), box({1, 0, 0}, {2, 1, 1}), false},       // face on face
                         {box(), box({1, 0.5, 0.25}, {2, 2, 2}), false},  // part of a face on part of a face
                         {box(), box({1, 1, 0}, {2, 2, 1}), false},       // edge on edge
                         {box(), box({1, 1, 1}, {2, 2, 2}), false},       // corner on corner
                         {box(), translated(tetrahedron(), {0.25, 0.5, 1}), false},  // resting on it
                         {box(), turned_inside_out(box({0, 0, 0}, {0.5, 0.5, 0.5})),
                          false},  // a notch, flush with three walls
                         {box(), box(), true},
                         {box(), box({0, 0, 0.5}, {1, 1, 1.5}), true},          // flush with four walls
                         {box(), box({0.25, 0.25, 0}, {0.5, 0.5, 0.5}), true},  // inside, on the floor
                         {box(), translated(box(), {0.5, 0.5, 0.5}), true},
                         {square, translated(square, {1, 0, 0}), false},
                         {square, translated(square, {1, 0.5, 0}), false},
                         {square, square, true},
                         {square, translated(square, {0.5, 0, 0}), true},
                         {square, translated(square, {0.5, 0.5, 0}), true}}) {
    CAPTURE(c.b.vertices[0].transpose());
    CHECK(check_mesh(several({c.a, c.b}))[MeshFault::self_intersection].count > 0);
    CHECK(overlaps(several({c.a, c.b})) == c.overlap);
    CHECK(overlaps(several({c.b, c.a})) == c.overlap);
  }
  for (const Mesh& clean : {comb(4), torus(12, 8), box_with_void(), gear(9)}) CHECK_FALSE(overlaps(clean));
}

TEST_CASE(
    "the self-intersections of two bodies in one mesh are the pairs of the exact query, in closed curves") {
  const Mesh a = icosphere(2);
  for (const Point3& by : {Point3{0.9, 0.2, 0.1}, Point3{0.05, 0.02, 1.9}}) {
    const Mesh both = several({a, translated(a, by)});
    const LrbRep rep = closed(a);
    const CollideResult expected = collide(rep, {}, closed(translated(a, by)), {});
    const SelfIntersections found = listed_in(both);
    REQUIRE(found.pairs.size() == expected.pairs.size());
    REQUIRE(!found.pairs.empty());
    for (std::size_t i = 0; i < found.pairs.size(); ++i) {
      CHECK(found.pairs[i].a.value() == expected.pairs[i].a.value());
      CHECK(found.pairs[i].b.value() == expected.pairs[i].b.value() + a.face_count());
      CHECK(found.pairs[i].kind == SelfContact::cross);
    }
    // Two spheres intersect in one closed curve: each end belongs to two segments.
    CHECK(found.curves == 1);
    std::map<std::array<double, 3>, int> ends;
    for (const auto& segment : found.segments)
      for (const Eigen::Vector3d& x : segment) ++ends[{x.x(), x.y(), x.z()}];
    for (const auto& [x, count] : ends) CHECK(count == 2);
    const SelfIntersections of_body = self_intersections(LrbRep::without_regions(both, true, true));
    CHECK(of_body.segments == found.segments);
  }
  CHECK(listed_in(several({a, translated(a, {1, 0, 0}), translated(a, {9, 0, 0}), translated(a, {10, 0, 0})}))
            .curves == 2);
}

TEST_CASE("self-intersections: no pairs, no faces, and too many pairs") {
  CHECK(listed_in(icosphere(2)).pairs.empty());
  CHECK(listed_in(quad_box()).curves == 0);
  CHECK(listed_in(Mesh{}).pairs.empty());
  const Mesh soup = random_soup(5, 40, 3);
  const std::size_t all = listed_in(soup).pairs.size();
  REQUIRE(all > 10);
  CHECK(self_intersections(check(soup), 2, all).pairs.size() == all);
  CHECK_THROWS_WITH_AS(self_intersections(check(soup), 2, all - 1),
                       doctest::Contains("limit set by max_pairs"), InputError);
}

TEST_CASE("self-intersections of faces with common corners: a fold, a spike, a duplicate") {
  Mesh m;
  m.vertices = {{0, 0, 0},      {1, 0, 0},       {0, 1, 0},   {0.25, 0.25, 0},
                {0.25, 0.5, 1}, {0.5, 0.25, -1}, {0.5, -1, 0}};
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    m.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
  };
  add(0, 1, 2);
  add(1, 0, 3);  // folded onto the first along their edge
  SelfIntersections found = listed_in(m);
  REQUIRE(found.pairs.size() == 1);
  CHECK(found.pairs[0].kind == SelfContact::overlap);
  CHECK(found.pairs[0].shared == 2);
  m.face_offsets = {0}, m.face_vertices = {};
  add(0, 1, 2);
  add(0, 4, 5);  // shares a corner, and passes through the interior
  found = listed_in(m);
  REQUIRE(found.pairs.size() == 1);
  CHECK(found.pairs[0].kind == SelfContact::cross);
  CHECK(found.pairs[0].shared == 1);
  REQUIRE(found.pairs[0].segments == 1);
  CHECK(found.segments[0][0].norm() * found.segments[0][1].norm() == 0);  // from the corner
  m.face_offsets = {0}, m.face_vertices = {};
  add(0, 1, 2);
  add(1, 2, 0);
  add(0, 1, 6);  // beside the first: shares an edge only
  found = listed_in(m);
  REQUIRE(found.pairs.size() == 1);
  CHECK(found.pairs[0].kind == SelfContact::overlap);
  CHECK(found.pairs[0].shared == 3);
}

}  // namespace lrb::test

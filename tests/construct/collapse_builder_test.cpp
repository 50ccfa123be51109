#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>

#include <doctest/doctest.h>

#include "engine/construct/complex_builder.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/construct/build_checks.hpp"
#include "tests/support/hard_bodies.hpp"
#include "tests/support/noisy_quads.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

/// Checks a body with all that the builder promises. Returns it.
LrbRep check_built(const Mesh& mesh, std::size_t most = 20, const BuildOptions& options = {}) {
  CAPTURE(mesh.name);
  CAPTURE(mesh.face_count());
  const LrbRep rep = build_lrb(mesh, options);
  check_keeps_mesh(rep, mesh);
  check_valid(rep);
  CHECK(bad_pairs_by_brute_force(rep) == 0);
  CHECK(rep.outermost_faces().size() <= most);
  CHECK(rep.closed());
  return rep;
}

/// A tube that crosses itself all the way round: an 8, turned about the z axis.
Mesh figure_eight() {
  Mesh m = torus(24, 16);
  const auto angle = [](std::size_t i, std::size_t n) {
    return 2 * std::numbers::pi * double(i) / double(n);
  };
  for (std::size_t i = 0; i < m.vertices.size(); ++i) {
    const double u = angle(i / 16, 24), v = angle(i % 16, 16), r = 2 + std::sin(v);
    m.vertices[i] = {r * std::cos(u), r * std::sin(u), 0.6 * std::sin(2 * v)};
  }
  return m;
}

TEST_CASE("bodies of all kinds: valid, embedded according to brute force, few outer faces") {
  const Mesh small[] = {
      tetrahedron(), box(), quad_box(), l_shape(), comb(5), icosphere(2), bumpy_sphere(3, 1, 0.4),
      uv_sphere(16, 8), bowl(16, 8), torus(16, 8), quad_torus(16, 8),
      revolve({{0, -1}, {1, -1}, {0.2, 0}, {1, 1}, {0, 1}}, 24),
      several({icosphere(2), translated(icosphere(2), {3, 0, 0}), translated(torus(12, 8), {0, 4, 1})}),
      several({icosphere(3, 10), translated(icosphere(2, 0.3), {10.5, 0, 0})}),
      // Once a cap over the bowl's hollow was only checked against components in the cap's own box.
      several({bowl(24, 10, 0.1), translated(icosphere(1, 0.1), {0.1, 0, -0.3})}),
      several({box(), translated(box(), {1, 0, 0})}),                 // touch in a face
      several({icosphere(2), translated(icosphere(2), {2, 0, 0})})};  // touch in a point
  for (const Mesh& mesh : small) CHECK_FALSE(check_built(mesh).self_intersecting());
  CHECK(check_built(several({icosphere(3), translated(icosphere(3), {1, 0.1, 0})})).self_intersecting());
  // No face passes through another; and a vertex that two fans share.
  CHECK(check_built(several({icosphere(2), icosphere(2)}), 40).self_intersecting());
  check_built(voxels(2, 2, 2, [](int x, int y, int z) { return x == y && y == z; }));
  CHECK_THROWS_WITH_AS(build_lrb(several({icosphere(3), icosphere(2, 0.5)})), doctest::Contains("inside out"),
                       InputError);
  for (const Mesh& mesh : {tetrahedron(), box(), quad_box()}) CHECK(build_lrb(mesh).region_count() == 0);
  // Caps cover entire polygons.
  const LrbRep quads = check_built(quad_torus(20, 10));
  for (FaceId f = 0; f < quads.real_face_count(); ++f) CHECK(is_region(quads.outer_cell(f)));
}

TEST_CASE("faces in a common plane become regions without volume on request: wrappers of deviation 0") {
  // A gear; a plate with two holes; stairs at random, with outlines of all kinds.
  std::vector<Mesh> bodies = {read_mesh(LRB_SOURCE_DIR "/tests/data/gear.obj")};
  RandomEngine random(7);
  for (int i = 0; i < 12; ++i) {
    std::array<int, 6> along_x{}, along_y{};
    for (auto* heights : {&along_x, &along_y})
      for (int& height : *heights) height = static_cast<int>(random() % 3);
    const auto stairs = [&](int x, int y, int z) {
      return z <= along_x[static_cast<std::size_t>(x)] + along_y[static_cast<std::size_t>(y)];
    };
    const auto with_holes = [](int x, int y, int) { return (x != 2 && x != 6) || y != 3; };
    const bool quads = i % 2 > 0;
    bodies.push_back(i < 2 ? voxels(9, 7, 1, with_holes, quads) : voxels(6, 6, 5, stairs, quads));
  }
  BuildOptions options;
  options.merge_planes = true;
  for (const Mesh& mesh : bodies) {
    const LrbRep rep = check_built(mesh, 60, options);
    const std::vector<bool> flat = flat_regions(rep);
    const std::vector<double> thickness = region_thickness(rep);
    std::size_t faces = rep.real_face_count();  // of the wrapper of deviation 0
    for (RegionId r = 0; r < rep.region_count(); ++r) {
      CHECK((thickness[r] == 0) == flat[r]);
      if (!flat[r]) continue;
      CHECK(rep.layer(r) == 0);
      faces -= rep.floor(r).size() - rep.lids(r).size();
    }
    CHECK(faces < rep.real_face_count());
    // 128 planes of two triangles, and two of 128.
    if (mesh.name == bodies[0].name) CHECK(faces == 160);
    // A looser wrapper has no more faces.
    const auto needed = rep.levels().needed();
    const auto need = [&](CellId cell) {
      return is_region(cell) ? needed[cell] : cell == kSolid ? 0 : std::numeric_limits<double>::infinity();
    };
    std::map<double, std::int64_t> change;  // at each tolerance
    for (FaceId f = 0; f < rep.face_count(); ++f)
      ++change[need(rep.inner_cell(f))], --change[need(rep.outer_cell(f))];
    CHECK(change.begin()->second == static_cast<std::int64_t>(faces));
    for (auto next = std::next(change.begin()); next->first < 1e300; ++next) CHECK(next->second <= 0);
  }
  // Vertices inside a plane go.
  const LrbRep plate =
      build_lrb(voxels(40, 30, 1, [](int x, int y, int) { return x != 9 || y != 9; }), options);
  CHECK(plate.levels().all().back().face_count < 100);
  // Without such faces, nothing changes.
  CHECK(build_lrb(bumpy_sphere(3, 1, 0.4), options).hash() == build_lrb(bumpy_sphere(3, 1, 0.4)).hash());
}

TEST_CASE("an outermost wrapper of few faces on request") {
  for (const std::uint32_t most : {4u, 6u, 8u, 11u}) {
    BuildOptions options;
    options.max_outer_faces = most;
    for (const Mesh& mesh : {bumpy_sphere(3, 1, 0.4), bowl(16, 8), comb(5)}) check_built(mesh, most, options);
  }
}

/// A ball of quads, some cut into triangles, whose vertices are moved along the radius: quads fold.
Mesh folded_sphere(std::uint64_t seed) {
  RandomEngine random(seed);
  const double noise = uniform(random, 0.02, 0.4);
  const auto slices = static_cast<std::uint32_t>(3 + random() % 8),
             rings = static_cast<std::uint32_t>(2 + random() % 5);
  const Mesh mesh = quad_ball(slices, rings, [&] { return 1 + noise * uniform(random, -1, 1); });
  Mesh out;
  out.name = "folded sphere " + std::to_string(seed);
  out.vertices = mesh.vertices;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    std::vector<VertexId> corners(mesh.face(f).begin(), mesh.face(f).end());
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(random() % corners.size()),
                corners.end());
    if (corners.size() == 4 && random() % 3 == 0) {
      out.add_face(std::array{corners[0], corners[1], corners[2]});
      out.add_face(std::array{corners[0], corners[2], corners[3]});
    } else {
      out.add_face(corners);
    }
  }
  return out;
}

TEST_CASE("folded quads: bridging does not split polygons that are not planar") {
  std::uint32_t built = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Mesh mesh = folded_sphere(seed);
    if (!check_mesh(mesh).buildable()) continue;
    BuildOptions options;
    options.lean = seed % 4 == 0;
    const LrbRep rep = build_lrb(mesh, options);
    check_valid(rep);
    check_keeps_mesh(rep, mesh);
    ++built;
  }
  CHECK(built > 20);
}

TEST_CASE("caps do not cover the parts of a surface that face its own inside") {
  // One of the two lobes is inside out.
  const Mesh mesh = turned_inside_out(figure_eight());
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const bool lean : {false, true}) {
      BuildOptions options;
      options.seed = seed;
      options.lean = lean;
      const LrbRep rep = build_lrb(mesh, options);
      check_valid(rep);
      CHECK(rep.self_intersecting());
      CHECK(rep.outermost_faces().size() <= 20);
      CHECK(rep.region_count() > 10);
    }
}

TEST_CASE("every patch size works; larger patches make lean LRB-reps smaller") {
  const Mesh mesh = bumpy_sphere(4, 5);
  std::uint32_t last = ~0u;
  for (const std::uint32_t interior : {4u, 8u, 16u, 32u, 64u}) {
    CAPTURE(interior);
    BuildOptions options;
    options.patch_interior = interior;
    const LrbRep fitting = build_lrb(mesh, options);
    check_valid(fitting);
    CHECK(fitting.outermost_faces().size() <= 20);
    options.lean = true;
    const LrbRep rep = build_lrb(mesh, options);
    check_valid(rep);
    CHECK(rep.outermost_faces().size() <= 20);
    CHECK(rep.face_count() < last);
    last = rep.face_count();
  }
}

TEST_CASE(
    "few lids: valid bodies of every kind, and small regions but for those that bridge, fill and close") {
  const Mesh all[] = {bumpy_sphere(4, 5),
                      torus(24, 12),
                      quad_torus(20, 10),
                      bowl(24, 10, 0.1),
                      box_with_void(),
                      comb(5),
                      several({icosphere(3), translated(icosphere(3), {1, 0.1, 0})}),
                      folded_sphere(3)};
  for (const Mesh& mesh : all)
    for (const std::uint32_t most : {4u, 12u}) {
      CAPTURE(mesh.name);
      CAPTURE(most);
      BuildOptions options;
      options.max_lids = most;
      const LrbRep rep = build_lrb(mesh, options);
      check_valid(rep);
      check_keeps_mesh(rep, mesh);
      std::uint32_t large = 0;
      for (RegionId r = 0; r < rep.region_count(); ++r)
        large += rep.lids(r).size() > most || rep.floor(r).size() > 3 * most;
      CHECK(large <= 2);  // they bridge or close
    }
  BuildOptions few;
  few.max_lids = 12;
  CHECK(build_lrb(all[0], few).region_count() > 2 * build_lrb(all[0]).region_count());
}

TEST_CASE("voids have their own regions, and a solid in a void has its own wrapper") {
  const Mesh mesh = several(
      {icosphere(3, 3), turned_inside_out(icosphere(3, 2)), translated(icosphere(2, 0.5), {0.7, 0, 0})});
  const LrbRep rep = check_built(mesh, 60);
  std::uint32_t cores = 0;
  for (RegionId r = 0; r < rep.region_count(); ++r) cores += rep.lids(r).empty();
  CHECK(cores == 1);  // the rest of the void has only a floor
  for (const FaceId f : rep.outermost_faces())
    for (const VertexId v : rep.face(f)) CHECK(rep.vertices()[v].norm() > 2.9);
  check_valid(build_lrb(box_with_void()));
}

TEST_CASE("the LRB-rep does not depend on scale and position") {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    const LrbRep rep = build_lrb(scaled(bumpy_sphere(3, 7), scale));
    CAPTURE(scale);
    check_valid(rep);
    CHECK(rep.outermost_faces().size() <= 20);
  }
  check_valid(build_lrb(translated(bumpy_sphere(3, 7), {1e4, -1e4, 1e4})));
}

TEST_CASE("bodies that cannot be built are rejected with the affected elements, on one line") {
  const auto message = [](const Mesh& mesh) { return error_of([&] { build_lrb(mesh); }); };
  const std::string open = message(open_cylinder(8));
  CHECK(open.find("an edge has only one face") != std::string::npos);
  CHECK(open.find("0-1") != std::string::npos);
  CHECK(open.find('\n') == std::string::npos);
  CHECK(message(Mesh{}).find("no faces") != std::string::npos);
  CHECK(message(turned_inside_out(icosphere(1))).find("inside out") != std::string::npos);
  Mesh flipped = icosphere(1);
  std::swap(flipped.face_vertices[0], flipped.face_vertices[1]);
  CHECK(message(flipped).find("inconsistently oriented") != std::string::npos);
  Mesh flat = box();
  flat.vertices[7] = flat.vertices[6];
  CHECK(message(flat).find("no area") != std::string::npos);
}

TEST_CASE("bodies with huge faces and high-valence vertices are built with all guarantees") {
  for (const Mesh& mesh : {hard::drum(700), hard::cone(700), hard::bipyramid(700), hard::crown(700),
                           hard::frustum(700), hard::drum(100), hard::bipyramid(100)}) {
    CAPTURE(mesh.face_count());
    const LrbRep rep = build_lrb(mesh);
    check_valid(rep);
    check_keeps_mesh(rep, mesh);
    CHECK_FALSE(rep.self_intersecting());
    CHECK(rep.outermost_faces().size() <= 20);
  }
}

TEST_CASE("validation finds the faults of a body with high-valence vertices") {
  LrbData broken = build_lrb(hard::bipyramid(300)).data();
  CHECK(validate(LrbRep(broken)).valid);
  broken.vertices[7] *= -1.5;  // through the body, and out between needles on its other side
  broken.vertices[7].z() = 0.1;
  const ValidateReport report = validate(LrbRep(broken));
  CHECK(report.real_pairs_meeting + report.violation_count > 0);
}

TEST_CASE("a complex by construction: a box in a box, faces in any order") {
  const Mesh inner = quad_box({1, 1, 1}, {2, 2, 2}), outer = quad_box({0, 0, 0}, {3, 3, 3});
  construct::ComplexBuilder builder(3, "boxes");
  for (const auto& v : inner.vertices) builder.add_vertex(v);
  for (const auto& v : outer.vertices) builder.add_vertex(v);
  const RegionId gap = builder.add_region(0);
  for (FaceId f = 0; f < 6; ++f) {
    VertexId corners[4];
    for (int i = 0; i < 4; ++i) corners[i] = VertexId(outer.face(f)[i] + 8);
    builder.add_pseudo_face(corners, gap, kOutside);
    builder.add_real_face(inner.face(f), kOutside);
  }
  for (int f = 1; f < 12; f += 2) builder.set_outer_cell(FaceId(f), gap);
  const LrbRep rep(builder.finish(true, false));
  CHECK(rep.name() == "boxes");
  CHECK(rep.real_face_count() == 6);
  CHECK(rep.face_count() == 12);
  for (FaceId f = 0; f < 6; ++f) CHECK(rep.face(f)[0] == inner.face(f)[0]);
  CHECK(rep.lids(gap).size() == 6);
  CHECK(rep.floor(gap).size() == 6);
  const ValidateReport report = validate(rep);
  CHECK(report.valid);
  CHECK(report.volume_regions == doctest::Approx(26));
}

}  // namespace
}  // namespace lrb::test

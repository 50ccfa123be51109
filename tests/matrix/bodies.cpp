#include "tests/matrix/bodies.hpp"

#include <array>
#include <cmath>

#include "scenarios/bodies/shapes.hpp"
#include "tests/mesh/io/encode.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/hard_bodies.hpp"
#include "tests/support/noisy_quads.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/motion.hpp>

namespace lrb::matrix {

using namespace shapes;
using Eigen::Vector3d;

namespace {

constexpr int kExtreme = 498;  // 2^498 is about 1e150
constexpr double kProbe = 0.3;

Mesh noisy_quads(std::uint32_t slices, std::uint32_t rings, double noise, std::uint64_t seed) {
  RandomEngine random(seed);
  return test::quad_ball(slices, rings, [&] { return 1 + noise * uniform(random, -1, 1); });
}

/// One triangle.
Mesh lone(const Vector3d& third) {
  return test::with_face({}, {{0, 0, 0}, {1, 0, 0}, third}, {VertexId(0), VertexId(1), VertexId(2)});
}

/// A cube with a vertex at the midpoint of an edge of its first face: that face is split in two, and a face
/// without area lies between them and the neighbour.
Mesh with_flat_face() {
  const Mesh cube = shapes::box();
  const VertexId a = cube.face(0)[0], b = cube.face(0)[1], c = cube.face(0)[2];
  Mesh mesh = test::without_faces(cube, {FaceId(0)});
  const VertexId m(static_cast<std::uint32_t>(mesh.vertices.size()));
  mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
  for (const auto& corners : {std::array{a, m, c}, std::array{m, b, c}, std::array{a, b, m}})
    mesh.add_face(corners);
  return mesh;
}

Mesh two_cubes(bool share_edge) {
  return voxels(2, 2, 2, [=](int x, int y, int z) { return x == y && (share_edge ? z == 0 : y == z); });
}

Mesh spiked(Mesh ball) {
  ball.vertices[0] *= -1.3;
  return ball;
}

double times(double by, int exponent) {
  return std::ldexp(by, exponent);
}

Mesh times(Mesh mesh, int exponent) {
  return shapes::scaled(std::move(mesh), times(1, exponent));
}

std::vector<Kind> make_kinds(int noisy) {
  std::vector<Kind> kinds;
  const auto add = [&](std::string name, Mesh mesh, bool solid = true, bool builds = true, bool simple = true,
                       const char* format = "ply") {
    mesh.name = name;
    if (mesh.dim == 2) format = "obj";
    kinds.push_back({std::move(name), std::move(mesh), solid, builds, simple, format});
  };
  const Mesh ball = icosphere(0), rock = bumpy_sphere(1, 1, 0.3);
  add("clean", bumpy_sphere(2, 1, 0.3), true, true, true, "stl");
  add("quads", voxels(
                   3, 2, 2, [](int x, int y, int z) { return x == 0 || y + z == 0; }, true));
  add("bent-quads", quad_torus(12, 8), true, true, true, "off");
  for (int i = 0; i < noisy; ++i)
    add("folded-" + std::to_string(i), noisy_quads(8, 2 + i % 3, 0.02 + 0.38 * ((i + 3) % 4) / 3.0, 100 + i),
        true, true, false);
  add("open", test::without_faces(rock, {FaceId(0), FaceId(1), FaceId(9)}), false, false, true, "stl");
  add("sheet", test::sheet(5), false, false);
  add("triangle", lone({0, 1, 0}), false, false, true, "off");
  add("line", lone({0.5, 0, 0}), false, false, false);
  add("crossing-once", spiked(icosphere(1)), true, true, false, "stl");
  add("crossing-often", test::shaken(icosphere(2), 0.5, 1), true, true, false);
  add("two-apart", several({ball, translated(ball, {3, 0, 0})}), true, true, true, "stl");
  add("two-touching", several({shapes::box(), shapes::box({1, 0, 0}, {2, 1, 1})}), true, true, false);
  add("two-overlapping", several({ball, translated(ball, {0.9, 0.2, 0.1})}), true, true, false, "off");
  add("twin", several({ball, ball}), true, true, false);
  add("nested", several({ball, shapes::scaled(ball, 0.5)}));
  add("void", box_with_void());
  add("shells", hard::nested(3));
  add("inside-out", turned_inside_out(rock), true, true, true, "stl");
  add("flipped", test::with_flipped(rock, {FaceId(3)}), false, false);
  add("doubled", test::with_doubled(rock, {FaceId(0), FaceId(5)}), false, false, false);
  add("needles", test::stretched(rock, {1, 1e-5, 1e-3}));
  add("frustum", hard::frustum(24));
  add("flat-face", with_flat_face(), true, false, false);
  add("collapsed",
      test::with_merged(rock, VertexId(0),
                        rock.face(0)[0] == VertexId(0) ? rock.face(0)[1] : rock.face(0)[0]),
      true, false, false);
  add("hub", hard::bipyramid(60));
  add("drum", hard::drum(40));
  add("cog", hard::cog(40));
  add("concave", shapes::scaled(test::u_profile(), 0.25), true, true, true, "off");
  add("bridged", shapes::scaled(test::plate_with_hole(), 0.25));
  add("unused", test::with_vertices(rock, {{40, 0, 0}, {0, 0, 0}}));
  add("shared-edge", two_cubes(true), true, false, false);
  add("shared-corner", two_cubes(false), true, true, false);
  add("far", translated(ball, {1e6, -1e6, 1e6}), true, true, true, "off");
  add("tiny", times(rock, -kExtreme));
  add("huge", times(rock, kExtreme), true, true, true, "off");
  Mesh gap = test::without_faces(star(5), {FaceId(0)}), pentagram;
  pentagram = polygon({{0, 1}, {-0.6, -0.8}, {0.95, 0.3}, {-0.95, 0.3}, {0.6, -0.8}});
  add("star-2d", star(7));
  add("open-2d", gap, false, false);
  add("crossing-2d", pentagram, true, true, false);
  add("ring-2d", ring_2d(16));
  add("two-2d", several({circle(12), translated(circle(12), {0.5, 0.1, 0})}), true, true, false);
  add("inside-out-2d", turned_inside_out(gear(6)));
  add("doubled-2d", test::with_doubled(star(5), {FaceId(2)}), false, false, false);
  add("tiny-2d", times(star(5), -kExtreme));
  add("huge-2d", times(star(5), kExtreme));
  for (const auto& [name, exponent] : {std::pair{"", 0}, {"-tiny", -kExtreme}, {"-huge", kExtreme}}) {
    add(std::string("probe") + name, times(icosphere(1, kProbe), exponent));
    add(std::string("probe-2d") + name, times(circle(9, kProbe), exponent));
  }
  return kinds;
}

int exponent_of(const Kind& kind) {
  const bool tiny = kind.name.find("tiny") != std::string::npos;
  return tiny ? -kExtreme : kind.name.find("huge") != std::string::npos ? kExtreme : 0;
}

Pose times(Pose pose, int exponent) {
  for (double& x : pose.t) x = times(x, exponent);
  return pose;
}

/// The answer, from the surfaces alone.
Step step_at(const LrbRep& a, const LrbRep& b, const Pose& pose) {
  Step step{pose, brute_force(a, Pose{}, b, pose), 0};
  if (step.truth.pairs.empty())
    step.distance = test::surface_distance(test::real_simplices(a, {}), test::real_simplices(b, pose));
  return step;
}

/// Poses of B: separate, in A's surface, and in its centre; against itself also at the identity.
std::vector<Pose> poses_of(const Kind& a, const LrbRep& rep, bool itself) {
  const Eigen::AlignedBox3d box = box_of(rep);
  const bool flat = a.mesh.dim == 2;
  const Vector3d size = box.diagonal(), centre = box.center();
  const Vector3d off = Vector3d(1.7, 0.1, flat ? 0 : 0.05) * size.norm();
  Vector3d on_face = Vector3d::Zero();
  for (const VertexId v : rep.face(FaceId(0)))
    on_face += rep.vertices()[v] / static_cast<double>(rep.face(FaceId(0)).size());
  const Pose turn = Pose::rotation(flat ? Vector3d::UnitZ() : Vector3d(1, 2, 3), 0.7);
  if (!itself) return {Pose::translation(centre + off), {turn.r, on_face}, Pose::translation(centre)};
  const Vector3d aside = Vector3d(0.16, 0.09, flat ? 0 : 0.02) * size.norm();
  return {Pose{}, {turn.r, centre - turn.r * centre + aside}, Pose::translation(off)};
}

Cell make_cell(const std::vector<Kind>& kinds, std::size_t a, std::size_t b) {
  const int exponent = exponent_of(kinds[a]);  // a body's properties do not change by powers of two
  const auto rep_of = [&](const Kind& k) {
    return LrbRep::without_regions(times(k.mesh, -exponent), k.solid, !k.simple);
  };
  const LrbRep rep_a = rep_of(kinds[a]), rep_b = rep_of(kinds[b]);
  Cell cell{a, b, {}, {}, {}, {}, 0, times(box_of(rep_a).diagonal().norm(), exponent)};
  const auto poses = poses_of(kinds[a], rep_a, a == b);
  for (const Pose& pose : poses) {
    cell.steps.push_back(step_at(rep_a, rep_b, pose));
    cell.steps.back().pose = times(pose, exponent);
    cell.steps.back().distance = times(cell.steps.back().distance, exponent);
  }
  const Pose& apart = a == b ? poses[2] : poses[0];
  const Vector3d through = a == b ? Vector3d::Zero() : Vector3d(box_of(rep_a).center());
  const Pose end = Pose::rotation(Vector3d::UnitZ(), 1, through - 0.8 * (apart.t - through));
  const Motion motion = Motion::screw(apart, end);
  constexpr int kTimes = 24;
  for (int i = 0; i <= kTimes && !cell.meets; ++i) {
    const double t = static_cast<double>(i) / kTimes;
    if (brute_force(rep_a, Pose{}, rep_b, motion.at(t)).pairs.empty())
      cell.free = t;
    else
      cell.meets = t;
  }
  cell.start = times(apart, exponent);
  cell.end = times(end, exponent);
  return cell;
}

}  // namespace

Matrix make_matrix(int noisy) {
  Matrix out{make_kinds(noisy), {}};
  constexpr std::size_t kProbes = 6;
  const std::size_t rows = out.kinds.size() - kProbes;
  for (std::size_t a = 0; a < rows; ++a) {
    const int exponent = exponent_of(out.kinds[a]);
    const std::size_t probe = rows +
                              (exponent == 0  ? 0
                               : exponent < 0 ? 2
                                              : 4) +
                              (out.kinds[a].mesh.dim == 2 ? 1 : 0);
    for (const std::size_t b : {probe, a}) out.cells.push_back(make_cell(out.kinds, a, b));
  }
  return out;
}

std::string file_of(const Mesh& mesh, const std::string& format) {
  if (format == "ply") return test::to_ply_binary(mesh, false);
  if (format == "off") return test::to_off(mesh);
  if (format == "stl") return test::to_stl_ascii(mesh);
  std::string out;
  for (const Vector3d& v : mesh.vertices) {
    out += "v";
    for (const double x : v) out += " " + test::digits(x);
    out += "\n";
  }
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    out += mesh.dim == 2 ? "l" : "f";
    for (const VertexId v : mesh.face(f)) out += " " + std::to_string(v + 1);
    out += "\n";
  }
  return out;
}

}  // namespace lrb::matrix


#include "scenarios/bodies/shapes.hpp"
#include "tests/fuzz/choices.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/support/hard_bodies.hpp"
#include "tests/support/lrb_files.hpp"
#include "tests/support/noisy_quads.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::fuzz {
namespace {

constexpr std::size_t kMaxCorners = 400;

/// A closed body of polygons whose vertices have been moved, so that its faces fold; some of them perhaps
/// gone, double or turned.
Mesh folded(Choices& choose) {
  const std::uint32_t family = choose.below(4), size = choose.below(8);
  const double reach = choose.below(128) / 128.0;
  Mesh mesh;
  if (family == 0) {
    const std::uint32_t rings = 1 + choose.below(4);
    mesh = test::quad_ball(3 + size, rings, [&] { return 1 + reach * choose.signed_unit(); });
  } else if (family == 1) {
    const std::uint32_t cells = 1 + choose.below(255);
    mesh = shapes::voxels(
        2, 2, 2, [=](int x, int y, int z) { return (cells >> (4 * x + 2 * y + z) & 1) != 0; }, true);
  } else {
    mesh = family == 2 ? hard::drum(3 + size) : shapes::quad_torus(static_cast<int>(3 + size), 3);
  }
  if (family != 0)
    for (Eigen::Vector3d& v : mesh.vertices)
      for (double& x : v) x += reach * choose.signed_unit();
  Mesh out;
  out.vertices = mesh.vertices;
  out.name = "m";
  const std::uint32_t odd = choose.below(4) == 3 ? choose.below(64) : kNull, what = choose.below(3);
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    std::vector<VertexId> corners(mesh.face(f).begin(), mesh.face(f).end());
    if (f == odd && what == 0) continue;
    if (f == odd && what == 1) out.add_face(corners);
    if (f == odd && what == 2) std::reverse(corners.begin(), corners.end());
    out.add_face(corners);
  }
  return out;
}

/// Asks about two bodies what brute force knows.
void query(const LrbRep& a, const LrbRep& b) {
  for (const Pose& pose : {Pose{}, Pose::rotation({1, 2, 3}, 1, {0.4, 0.3, 0.2})}) {
    const BruteForceResult truth = brute_force(a, {}, b, pose);
    CollideRequest request;
    const CollideResult all = collide(a, {}, b, pose, request);
    judge(all.pairs == truth.pairs && all.meets == truth.meets, "other pairs than brute force");
    for (const double tolerance : {0.01, 0.3, 3.0}) {
      request.tolerance = tolerance;
      judge(collide(a, {}, b, pose, request).relation == all.relation, "a tolerance changes the relation");
    }
    judge(distance(a, {}, b, pose).meet == !truth.pairs.empty(), "a distance of 0, or none, is wrong");
  }
}

}  // namespace

bool feed_body(std::string_view bytes) {
  if (bytes.empty()) return false;
  const bool is_file = bytes[0] == '0';
  return accepted(is_file ? "m.obj" : "m", [&] {
    Choices choose(bytes.substr(1));
    Mesh mesh = is_file ? read_mesh(std::string(bytes.substr(1)), "m.obj") : folded(choose);
    if (mesh.face_vertices.size() > kMaxCorners) return;
    BodyOptions options;
    options.build.threads = 1;
    options.build.lean = bytes[0] % 2 != 0;
    const Body body = Body::from(std::move(mesh), options).value();
    ValidateOptions validating;
    validating.wrapper_states = 8;
    const ValidateReport report = validate(body, validating);
    if (body.has_regions() && !report.valid) throw std::logic_error("invalid: " + report.violations.at(0));
    for (const bool levels : {false, true}) {
      if (levels) body.rep().levels();
      const std::string file = test::lrb_bytes(body);
      const LrbRep again = load_lrb(file, "m.lrb");
      judge(again.hash() == body.rep().hash() && test::lrb_bytes(again) == file,
            "another body once saved and loaded");
      query(body, again);
    }
  });
}

}  // namespace lrb::fuzz

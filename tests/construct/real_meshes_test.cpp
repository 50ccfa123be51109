#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "engine/construct/closing.hpp"
#include "tests/construct/build_checks.hpp"
#include "tests/support/shared_meshes.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::test {
namespace {

using construct::volume_of;

/// Faces of the wrapper that keeps closed what is proved to be off by no more than a share of the largest
/// side.
std::uint32_t faces_within(const LrbRep& rep, std::vector<double> needed, double tolerance) {
  for (bool grown = true; grown;) {
    grown = false;
    for (FaceId f(rep.real_face_count()); f < rep.face_count(); ++f) {
      const CellId in = rep.inner_cell(f), out = rep.outer_cell(f);
      if (!is_region(out) || needed[out] >= needed[in]) continue;
      needed[out] = needed[in];
      grown = true;
    }
  }
  const auto includes = [&](CellId c) { return is_region(c) && needed[c] <= tolerance; };
  std::uint32_t count = 0;
  for (FaceId f = 0; f < rep.face_count(); ++f)
    count += (rep.is_real(f) || includes(rep.inner_cell(f))) && !includes(rep.outer_cell(f));
  return count;
}

struct Target {
  const char* name;
  std::uint32_t faces[3];  ///< at most, within 0.005, 0.01 and 0.02 of the largest side of the box
};

TEST_CASE("real models meet the targets for faces, outer faces, volume, embedding and tight wrappers" *
          doctest::test_suite("shared meshes")) {
  const auto folder = shared_meshes();
  const Mesh large = read_mesh((folder / "nefertiti.obj").string());
  CHECK((large.vertices.size() == 49971 && large.face_count() == 99938));
  for (const Target& target : {Target{"spot", {4400, 1800, 680}}, Target{"homer", {2700, 1110, 560}},
                               Target{"fandisk", {340, 215, 205}}, Target{"cheburashka", {2760, 1370, 620}},
                               Target{"rocker-arm", {1780, 720, 390}}}) {
    CAPTURE(target.name);
    const Mesh mesh = read_mesh((folder / (std::string(target.name) + ".obj")).string());
    const MeshReport report = check_mesh(mesh);
    CHECK(report.lines(mesh).empty());
    CHECK((report.closed && report.components == 1));
    CHECK(report.genus == (target.name == std::string("rocker-arm") ? 1 : 0));
    Eigen::AlignedBox3d box;
    for (const auto& v : mesh.vertices) box.extend(v);
    Mesh hull;
    hull.vertices = mesh.vertices;
    for (const auto& t : convex_hull(mesh.vertices))
      hull.add_face(std::array{VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
    for (const bool lean : {false, true}) {
      CAPTURE(lean);
      BuildOptions options;
      options.lean = lean;
      const LrbRep rep = build_lrb(mesh, options);
      check_keeps_mesh(rep, mesh);
      check_valid(rep, 5);
      CHECK(rep.outermost_faces().size() <= 20);
      CHECK(rep.face_count() <= (lean ? 1.6 : 2.0) * rep.real_face_count());
      CHECK(enclosed_volume(rep, rep.outermost_faces()) <= 1.4 * volume_of(hull));
      if (lean) continue;
      const std::vector<double> thickness = region_thickness(rep);
      constexpr double kShares[3] = {0.005, 0.01, 0.02};
      for (int i = 0; i < 3; ++i)
        CHECK(faces_within(rep, thickness, kShares[i] * box.sizes().maxCoeff()) <= target.faces[i]);
    }
  }
}

}  // namespace
}  // namespace lrb::test

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/hard_bodies.hpp"
#include "tests/support/lrb_shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

using namespace lrb;

namespace {

bool names(const ValidateReport& report, const std::string& part) {
  for (const auto& v : report.violations)
    if (v.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("valid LRB-reps pass, with known volumes") {
  const ValidateReport box = validate(shapes::dented_box());
  CHECK(box.valid);
  CHECK(box.volume_solid == doctest::Approx(28));
  CHECK(box.volume_regions == doctest::Approx(4));
  CHECK(box.volume_outer == doctest::Approx(32));
  CHECK(box.embedding_pairs > 0);
  CHECK(box.states == 100);
  struct {
    LrbRep rep;
    double solid, outer;
  } const others[] = {{shapes::stairs_2d(), 10, 16},
                      {LrbRep(toy::small_plate()), 25, 36},
                      {LrbRep(toy::dented_tetrahedron()), 4, 32.0 / 3}};
  for (const auto& [rep, solid, outer] : others) {
    const ValidateReport report = validate(rep);
    CHECK_MESSAGE(report.valid, (report.violations.empty() ? "" : report.violations[0]));
    CHECK(report.volume_solid == doctest::Approx(solid));
    CHECK(report.volume_outer == doctest::Approx(outer));
  }
}

TEST_CASE("the mean thickness is the volume of the regions over the lids' area") {
  CHECK(lid_height(shapes::dented_box()) == doctest::Approx(1));  // 4 under 4
  CHECK(lid_height(LrbRep::without_regions(shapes::box(), true, false)) == 0);
  const LrbRep plate(toy::small_plate());
  double length = 0;
  for (RegionId r = 0; r < plate.region_count(); ++r)
    for (const FaceId lid : plate.lids(r))
      length += (plate.vertices()[plate.face(lid)[1]] - plate.vertices()[plate.face(lid)[0]]).norm();
  CHECK(lid_height(plate) * length == doctest::Approx(36 - 25));
}

TEST_CASE("an open region is named") {
  LrbData d = shapes::dented_box().data();
  d.outer_cell[18] = kOutside;  // a face of the dent leaves the region's collector
  const ValidateReport report = validate(LrbRep(d));
  CHECK_FALSE(report.valid);
  CHECK(names(report, "region 0 is open"));
}

TEST_CASE("a closed body with a face that names a vertex twice is closed") {
  const Mesh ball = shapes::icosphere(0);
  const Mesh collapsed = test::with_merged(ball, ball.face(FaceId(0))[0], ball.face(FaceId(0))[1]);
  CHECK(validate(LrbRep::without_regions(collapsed, true, false)).valid);
}

TEST_CASE("intersecting faces are found, and classified by the body or the builder") {
  LrbData d = shapes::dented_box().data();
  for (VertexId v = 12; v < 16; ++v)
    d.vertices[v].z() = -1;  // the dent goes through the bottom: real against real
  const ValidateReport input = validate(LrbRep(d));
  CHECK(input.real_pairs_meeting > 0);
  CHECK_FALSE(names(input, "pseudo"));

  LrbData lid = shapes::dented_box().data();
  // The lid gets a corner of its own, below the floor of the dent.
  lid.vertices.push_back({2, 2, 0.5});
  const auto last = static_cast<VertexId>(lid.vertices.size() - 1);
  lid.face_vertices[lid.face_offsets[28] + 1] = last;
  const ValidateReport report = validate(LrbRep(lid));
  CHECK_FALSE(report.valid);
  CHECK(names(report, "(pseudo)"));
}

TEST_CASE("a lid that coincides with its floor is allowed and counted") {
  LrbData d = shapes::dented_box().data();
  for (VertexId v = 12; v < 16; ++v)
    d.vertices[v].z() = 2;  // the dent has depth 0: its floor lies in the lid's plane
  // The walls of the dent are gone flat too; only the floor (faces 26, 27) and walls overlap the lid.
  for (VertexId v = 12; v < 16; ++v) d.vertices[v] = 0.5 * (d.vertices[v] + Eigen::Vector3d(2, 2, 2));
  const ValidateReport report = validate(LrbRep(d));
  CHECK(report.flat_pairs > 0);
  CHECK_MESSAGE(report.valid, (report.violations.empty() ? "" : report.violations[0]));
}

TEST_CASE("a region of negative volume is rejected") {
  LrbData d = shapes::dented_box().data();
  for (VertexId v = 12; v < 16; ++v) d.vertices[v].z() = 3;  // a bump through the lid
  const ValidateReport report = validate(LrbRep(d));
  CHECK_FALSE(report.valid);
  CHECK(names(report, "negative"));
}

TEST_CASE("the thickness of a region whose lids are too far away for doubles is infinite") {
  LrbData data = shapes::dented_box().data();
  for (const VertexId v : data.face(FaceId(data.face_count() - 1)))
    if (v >= 8) data.vertices[v].z() = 1e300;
  for (Eigen::Vector3d& x : data.vertices)
    if (std::abs(x.z()) < 1e299) x *= 1e-20;
  const LrbRep rep(data);
  for (const double t : region_thickness(rep)) CHECK(t > 1e200);
}

#include "engine/construct/complex_builder.hpp"

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/validate.hpp>

namespace lrb::construct {
namespace {

TEST_CASE("a complex by construction: a box in a box, faces in any order") {
  const Mesh inner = shapes::quad_box({1, 1, 1}, {2, 2, 2}), outer = shapes::quad_box({0, 0, 0}, {3, 3, 3});
  ComplexBuilder builder(3, "boxes");
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
}  // namespace lrb::construct

// Bodies with huge faces and high-valence vertices are built without patches over these, and are valid.

#include <doctest/doctest.h>

#include "tests/construct/build_checks.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/build.hpp>

namespace lrb::test {

TEST_CASE("bodies with huge faces and high-valence vertices are built with all guarantees") {
  for (const Mesh& mesh : {hard::drum(700), hard::cone(700), hard::bipyramid(700), hard::crown(700),
                           hard::frustum(700), hard::drum(100), hard::bipyramid(100)}) {
    CAPTURE(mesh.face_count());
    const LrbRep rep = build_lrb(mesh);
    check_valid(rep);
    check_keeps_mesh(rep, mesh);
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

}  // namespace lrb::test

#include <doctest/doctest.h>

#include "engine/exact/predicates.hpp"
#include "scenarios/bodies/generators.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/validate.hpp>

using namespace lrb;

TEST_CASE("the paper's objects: exactly table 1's numbers of faces, closed, embedded, few outer faces") {
  for (const generators::FractalSpec& spec : generators::paper_objects()) {
    CAPTURE(spec.name);
    const LrbRep rep = generators::fractal_body(spec);
    CHECK(rep.real_face_count() == spec.real_faces);
    CHECK(rep.face_count() == spec.total_faces);
    CHECK(rep.outermost_faces().size() == 6);
    ValidateOptions options;
    options.wrapper_states = 5;
    const ValidateReport report = validate(rep, options);
    CHECK(report.valid);
    CHECK(report.real_pairs_meeting == 0);
    CHECK(report.volume_solid > 0.3 * report.volume_outer);
    CHECK(report.volume_solid < 0.5 * report.volume_outer);
  }
}

TEST_CASE("fractal bodies: every face is exactly planar") {
  const LrbRep rep = generators::fractal_body(generators::paper_objects()[3]);
  std::size_t quads = 0;
  for (FaceId f = 0; f < rep.face_count(); ++f) {
    const auto v = rep.face(f);
    const auto x = [&](std::size_t i) { return rep.vertices()[v[i]].data(); };
    for (std::size_t i = 3; i < v.size(); ++i) CHECK(exact::orient3d(x(0), x(1), x(2), x(i)) == 0);
    quads += v.size() == 4;
  }
  CHECK(quads > 100);
}

TEST_CASE("fractal bodies: the seed alone determines the body, and other numbers of faces work") {
  const generators::FractalSpec small{"small", 500, 600, 3};
  generators::FractalSpec other = small;
  other.seed = 4;
  CHECK(hash_of(generators::fractal_body(small).data()) == hash_of(generators::fractal_body(small).data()));
  CHECK(hash_of(generators::fractal_body(small).data()) != hash_of(generators::fractal_body(other).data()));
  for (const std::uint32_t pseudo : {71u, 72u, 100u, 197u}) {
    const LrbRep rep = generators::fractal_body({"body", 500, 500 + pseudo, 5});
    CHECK(rep.face_count() == 500 + pseudo);
    CHECK(rep.real_face_count() == 500);
  }
  CHECK(generators::fractal_body({"prism", 7, 7, 1}).face_count() == 7);
  CHECK(generators::fractal_body({"star in a cube", 24, 30, 1, 6}).face_count() == 30);
}

TEST_CASE("fractal bodies: unreachable numbers of faces are rejected") {
  for (const auto& [real, total] : {std::pair{500u, 400u}, {500u, 501u}, {500u, 900u}, {6u, 6u}, {8u, 9u}})
    CHECK_THROWS_AS(generators::fractal_body({"body", real, total, 1}), InputError);
}

TEST_CASE("fractal bodies: as a generator, with their own regions; as a mesh, only the real faces") {
  const generators::FractalSpec object = generators::paper_objects()[3];
  const generators::GeneratorValues values = {{"real_faces", object.real_faces},
                                              {"total_faces", object.total_faces}};
  const std::optional<LrbRep> rep = generators::generate_rep("fractal", values, object.seed);
  REQUIRE(rep);
  generators::FractalSpec named = object;
  named.name = rep->name();
  named.outer_faces = 7;
  CHECK(rep->hash() == generators::fractal_body(named).hash());
  CHECK_FALSE(generators::generate_rep("rock"));
  const Mesh mesh = generators::generate("fractal", values, object.seed);
  REQUIRE(mesh.face_count() == object.real_faces);
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    REQUIRE(mesh.face(f).size() == rep->face(f).size());
    for (std::size_t i = 0; i < mesh.face(f).size(); ++i)
      CHECK(mesh.vertices[mesh.face(f)[i]] == rep->vertices()[rep->face(f)[i]]);
  }
  CHECK_THROWS_AS(generators::generate("fractal", {{"total_faces", 2005}}), InputError);
}

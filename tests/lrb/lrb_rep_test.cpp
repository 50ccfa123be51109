#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>

using namespace lrb;

TEST_CASE("an LRB-rep lists lids and floors of its regions") {
  const LrbRep rep = shapes::dented_box();
  REQUIRE(rep.region_count() == 1);
  CHECK(rep.real_face_count() == 28);
  CHECK(rep.face_count() == 30);
  CHECK(std::vector<FaceId>(rep.lids(0).begin(), rep.lids(0).end()) == std::vector<FaceId>{28, 29});
  CHECK(rep.floor(0).size() == 10);
  CHECK(rep.collector(0).size() == 12);
  CHECK(rep.outermost_faces().size() == 20);
  CHECK(rep.parent(0) == kOutside);
  CHECK(rep.depth(0) == 1);
}

TEST_CASE("parents and depths follow the lids outward") {
  const LrbRep rep = shapes::stairs_2d();
  CHECK(rep.parent(0) == 1);
  CHECK(rep.parent(1) == kOutside);
  CHECK(rep.depth(0) == 2);
  CHECK(rep.depth(1) == 1);
  CHECK(rep.layer_count() == 2);
}

TEST_CASE("simplices of polygons are numbered face by face") {
  const LrbRep quads = LrbRep::without_regions(shapes::quad_box(), true, false);
  CHECK(quads.real_simplex_count() == 12);
  for (SimplexId s = 0; s < 12; ++s) CHECK(quads.face_of_simplex(s) == s / 2);
  VertexId v[3];
  quads.simplex(5, v);
  CHECK(v[0] == quads.face(2)[0]);
  CHECK(v[1] == quads.face(2)[2]);
  CHECK(v[2] == quads.face(2)[3]);
}

TEST_CASE("inconsistent arrays are rejected by name") {
  const auto message = [](auto change) {
    LrbData d = shapes::dented_box().data();
    change(d);
    return test::error_of([&] { LrbRep rep(std::move(d)); });
  };
  const auto names = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  CHECK(message([](LrbData&) {}).empty());
  CHECK(names(message([](LrbData& d) { d.face_vertices[7] = 99; }), "face 2 refers to vertex 99"));
  CHECK(names(message([](LrbData& d) { d.outer_cell[3] = 5; }), "face 3 refers to a region"));
  CHECK(names(message([](LrbData& d) { d.inner_cell[28] = kSolid; }), "face 28"));
  CHECK(names(message([](LrbData& d) { d.outer_cell[0] = kSolid; }), "inner and outer cell swapped"));
  CHECK(names(message([](LrbData& d) { d.vertices[4].y() = std::nan(""); }), "vertex 4"));
  CHECK(names(message([](LrbData& d) { d.inner_cell.pop_back(); }), "differ in length"));
  CHECK(names(message([](LrbData& d) { d.face_offsets[2] = 50; }), "not ascending"));
}

TEST_CASE("the hash identifies the complex") {
  const LrbRep a = shapes::dented_box(), b = shapes::dented_box();
  CHECK(a.hash() == b.hash());
  CHECK(a.serial() != b.serial());
  LrbData d = a.data();
  d.vertices[3].x() += 1e-9;
  CHECK(LrbRep(d).hash() != a.hash());
}

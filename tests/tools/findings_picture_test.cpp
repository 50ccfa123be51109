/// inspect --draw: the faults of a mesh, marked in a picture.

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/pixels.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/render/scene.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

using nlohmann::json;

constexpr Part kAboveLegend{0, 0, 1, 7.0 / 8};

struct Drawn {
  const char* kind;
  Mesh mesh;
  std::vector<render::Rgba> colours;
};

}  // namespace

TEST_CASE("the picture shows each kind of fault in its colour") {
  const Mesh ball = icosphere(1);
  const auto n = static_cast<VertexId>(ball.vertices.size());
  Mesh star = circle(5);
  for (std::size_t i = 0; i < 5; ++i) {
    star.face_vertices[2 * i] = VertexId(2 * i % 5);
    star.face_vertices[2 * i + 1] = VertexId(2 * (i + 1) % 5);
  }
  for (const Drawn& d : std::vector<Drawn>{
           {"open", without_faces(ball, {7}), {render::palette::kVermillion}},
           {"fin",
            with_face(ball, {{2, 0, 0}}, {ball.face(0)[0], ball.face(0)[1], n}),
            {render::palette::kVermillion, render::palette::kPurple, render::palette::kOrange}},
           {"flipped", with_flipped(ball, {7}), {render::palette::kBlue}},
           {"doubled", with_doubled(ball, {7}), {render::palette::kGreen}},
           {"crossing",
            several({ball, translated(ball, {0.7, 0.1, 0.2})}),
            {render::palette::kOrange, render::palette::kSkyBlue, render::palette::kContact}},
           {"collapsed", with_merged(ball, ball.face(0)[0], ball.face(0)[1]), {render::palette::kYellow}},
           {"huge and open", scaled(without_faces(ball, {7}), 1e308), {render::palette::kVermillion}},
           {"2D open", without_faces(circle(9), {3}), {render::palette::kVermillion}},
           {"2D crossing",
            star,
            {render::palette::kOrange, render::palette::kSkyBlue, render::palette::kContact}}}) {
    CAPTURE(std::string(d.kind));
    const Folder folder;
    write_mesh(d.mesh, folder / "m.obj");
    const Outcome o = succeed(folder, {"inspect", "m.obj", "--json", "--no-join", "--draw", "new/m.png"});
    CHECK(o.err.empty());
    CHECK(json::parse(o.out)["drawing"] == "new/m.png");
    const render::Image image = render::read_png(folder / "new/m.png").image;
    for (const render::Rgba& colour : d.colours) {
      CAPTURE(int(colour.r));
      CHECK(count_pixels(image, kAboveLegend, like(colour)) > 40);
    }
  }
}

TEST_CASE("faults with the same elements are drawn once") {
  const Mesh doubled = with_doubled(icosphere(1), {3, 9});  // they also meet
  CHECK(render::findings::kinds(check_mesh(doubled)) ==
        std::vector{MeshFault::duplicate_face, MeshFault::non_manifold_edge});
  const Mesh collapsed = with_face(icosphere(1), {}, {0, 0, 1});
  CHECK(render::findings::kinds(check_mesh(collapsed)) == std::vector{MeshFault::zero_area_face});
  CHECK(render::findings::kinds(check_mesh(icosphere(1))).empty());
}

}  // namespace lrb::test

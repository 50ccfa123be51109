#include <algorithm>
#include <map>
#include <set>

#include <doctest/doctest.h>

#include "render/scene_parts.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

using namespace lrb;
using Eigen::Vector3d;

namespace {

struct Counts {
  std::size_t opaque = 0, translucent = 0, on_top = 0;
};

Counts count(const render::DrawList& list) {
  Counts n;
  for (const render::DrawTriangle& t : list.triangles) {
    ++(t.layer == render::Layer::opaque        ? n.opaque
       : t.layer == render::Layer::translucent ? n.translucent
                                               : n.on_top);
  }
  return n;
}

std::set<std::uint32_t> ids(const render::DrawList& list, render::Layer layer) {
  std::set<std::uint32_t> out;
  for (const render::DrawTriangle& t : list.triangles) {
    if (t.layer == layer) out.insert(t.id);
  }
  return out;
}

bool has_key(const render::Scene& scene, const std::string& text) {
  return std::ranges::any_of(scene.key, [&](const render::LegendItem& i) { return i.text == text; });
}

}  // namespace

TEST_CASE("the picture follows the wrapper: all real faces, and the lids of its boundary") {
  const LrbRep rep = build_lrb(shapes::bumpy_sphere(2, 7, 0.3));
  Wrapper wrapper(rep);
  const std::vector<render::SceneBody> body = {{&rep, &wrapper, {}, {}, ""}};
  for (int step = 0; step < 12; ++step) {
    const render::Scene scene = render::build_scene(body);
    const Counts n = count(scene.list);
    CHECK(n.opaque == rep.real_face_count());
    std::set<std::uint32_t> lids;
    for (const FaceId f : wrapper.boundary()) {
      if (!rep.is_real(f)) lids.insert(render::face_id(Side::a, f));
    }
    CHECK(ids(scene.list, render::Layer::translucent) == lids);
    CHECK(has_key(scene, "A, pseudo faces"));
    wrapper.refine(static_cast<RegionId>(static_cast<std::uint32_t>(step) * 3 % rep.region_count()));
  }
  wrapper.refine_all();
  const render::Scene bare = render::build_scene(body);
  CHECK(count(bare.list).translucent == 0);
  CHECK(bare.list.lines.empty());
  CHECK(!has_key(bare, "A, pseudo faces"));
}

TEST_CASE("borders of regions and creases are marked on request") {
  const LrbRep rep = build_lrb(shapes::comb(6));
  const Wrapper wrapper(rep);
  const std::vector<render::SceneBody> body = {{&rep, &wrapper, {}, {}, ""}};
  render::SceneOptions options;
  const auto edges = [&](render::Layer layer, bool borders) {
    std::size_t n = 0;
    for (const render::DrawTriangle& t : render::build_scene(body, {}, options).list.triangles)
      for (int i = 0; i < 3; ++i)
        if (t.layer == layer) n += ((borders ? t.borders : t.edges) >> i & 1);
    return n;
  };
  CHECK(edges(render::Layer::opaque, true) == 0);
  CHECK(edges(render::Layer::translucent, true) == 0);
  options.borders = true;
  for (const render::Layer layer : {render::Layer::opaque, render::Layer::translucent}) {
    CHECK(edges(layer, true) > 0);
    CHECK(edges(layer, true) <= edges(layer, false));
  }
  // A wrapper that is one region has no borders inside, and a ball has no creases.
  const LrbRep ball = LrbRep::without_regions(shapes::icosphere(3), true, false);
  std::size_t creases = 0;
  const std::vector<render::SceneBody> round = {{&ball, nullptr, {}, {}, ""}};
  for (const render::DrawTriangle& t : render::build_scene(round, {}, options).list.triangles)
    creases += t.borders;
  CHECK(creases == 0);
}

TEST_CASE("layers, regions and values give faces their colours and the frame its scale") {
  const LrbRep rep = build_lrb(shapes::bumpy_sphere(2, 7, 0.3));
  Wrapper wrapper(rep);
  wrapper.refine(0);
  std::vector<double> values(rep.face_count(), 0.0);
  values[rep.outermost_faces()[2]] = 40;
  values[rep.outermost_faces()[5]] = 10;
  const std::vector<render::SceneBody> body = {{&rep, &wrapper, {}, values, ""}};
  render::SceneOptions options;
  options.colour_by = render::ColourBy::layer;
  render::Scene scene = render::build_scene(body, {}, options);
  REQUIRE(scene.scale.has_value());
  REQUIRE(rep.layer_count() > 1);
  const double last = rep.layer_count() - 1;
  CHECK(scene.scale->high == last);
  for (const render::DrawTriangle& t : scene.list.triangles) {
    if (t.layer != render::Layer::translucent) continue;
    const std::uint16_t layer = rep.layer(rep.inner_cell(FaceId(t.id)).as_region());
    CHECK(render::with_alpha(t.colour, 255) == render::palette::heat(layer / last));
  }
  options.colour_by = render::ColourBy::region;
  scene = render::build_scene(body, {}, options);
  for (const render::DrawTriangle& t : scene.list.triangles) {
    if (t.layer == render::Layer::translucent)
      CHECK(render::with_alpha(t.colour, 255) == render::palette::category(rep.inner_cell(FaceId(t.id))));
  }
  options.colour_by = render::ColourBy::value;
  scene = render::build_scene(body, {}, options);
  CHECK(scene.scale->high == 40);
  std::map<std::uint32_t, render::Rgba> colour;
  for (const render::DrawTriangle& t : scene.list.triangles) colour[t.id] = render::with_alpha(t.colour, 255);
  CHECK(colour[rep.outermost_faces()[2]] == render::palette::heat(1));
  CHECK(colour[rep.outermost_faces()[5]] == render::palette::heat(0.25));
  options.value_range = {{0.0, 20.0}};
  CHECK(render::build_scene(body, {}, options).scale->high == 20);
}

TEST_CASE("exploded lids keep their shape and move outward, layer by layer") {
  const LrbRep rep = build_lrb(shapes::bumpy_sphere(2, 7, 0.3));
  const Wrapper wrapper(rep);
  const std::uint32_t outermost = rep.layer_count() - 1;
  render::SceneOptions options;
  double outward = 0;
  for (const double explode : {0.9 / rep.layer_count(), 1.0}) {
    options.explode = explode;
    const render::Scene scene =
        render::build_scene(std::vector<render::SceneBody>{{&rep, &wrapper, {}, {}, ""}}, {}, options);
    CHECK(count(scene.list).opaque == rep.real_face_count());
    if (explode == 1) CHECK(count(scene.list).translucent == rep.face_count() - rep.real_face_count());
    for (const render::DrawTriangle& t : scene.list.triangles) {
      const auto corners = rep.face(FaceId(t.id));
      const Vector3d before = rep.vertices()[corners[0]], moved = t.x[0] - before;
      CHECK((t.x[1] - rep.vertices()[corners[1]] - moved).norm() < 1e-12);
      const CellId behind = rep.inner_cell(FaceId(t.id));
      const bool rises = is_region(behind) && (explode == 1 || rep.layer(behind.as_region()) == outermost);
      CHECK(rises == (moved.norm() > 0));
      outward += moved.dot(before);
    }
  }
  CHECK(outward > 0);
  // The lids of a region that was just refined have moved as well, in its colour; no outline stays.
  Wrapper refined(rep);
  refined.refine(3);
  render::SceneHighlight highlight;
  highlight.refining[0] = {3};
  const render::Scene later =
      render::build_scene(std::vector<render::SceneBody>{{&rep, &refined, {}, {}, ""}}, highlight, options);
  CHECK(later.list.lines.empty());
  const auto green = std::ranges::count_if(later.list.triangles, [&](const auto& t) {
    return render::with_alpha(t.colour, 255) == render::style_of(options.style).refining;
  });
  CHECK(static_cast<std::size_t>(green) == rep.lids(3).size());
}

TEST_CASE("many bodies: each in its colour, faces in contact in the contact colour") {
  const LrbRep solid = build_lrb(shapes::bumpy_sphere(2, 7, 0.3)), flat = build_lrb(shapes::star(5));
  for (const LrbRep* rep : {&solid, &flat}) {
    const std::vector<std::uint8_t> marks = {0, 1, 1};
    std::vector<render::SceneBody> bodies;
    for (std::uint32_t i = 0; i < 3; ++i) {
      render::SceneBody body;
      body.rep = rep;
      body.pose = Pose::translation({3.0 * i, 0, 0});
      body.colour = render::palette::category(i);
      if (i == 2) body.in_contact = marks;
      bodies.push_back(body);
    }
    const render::DrawList list = render::build_scene(bodies).list;
    std::map<std::uint32_t, std::size_t> faces;  // by colour, as one number
    const auto number = [](render::Rgba c) { return c.r << 16 | c.g << 8 | c.b; };
    for (const render::DrawTriangle& t : list.triangles)
      ++faces[static_cast<std::uint32_t>(number(t.colour))];
    std::size_t marked_lines = 0;
    for (const render::DrawLine& l : list.lines)
      marked_lines += l.colour == render::palette::kContact ? 1 : 0;
    if (rep == &solid) {
      CHECK(faces[static_cast<std::uint32_t>(number(render::palette::category(0)))] ==
            solid.real_face_count());
      CHECK(faces[static_cast<std::uint32_t>(number(render::palette::category(1)))] ==
            solid.real_face_count());
      CHECK(faces[static_cast<std::uint32_t>(number(render::palette::category(2)))] ==
            solid.real_face_count() - 2);
      CHECK(faces[static_cast<std::uint32_t>(number(render::palette::kContact))] == 2);
    } else {
      CHECK(list.fills.size() == 3);
      CHECK(list.fills[1].colour == render::palette::solid_2d(render::palette::category(1)));
      CHECK(marked_lines == 1);
    }
    render::SceneHighlight highlight;
    highlight.refining[0] = {0};
    CHECK_THROWS_AS(render::build_scene(bodies, highlight), InputError);
  }
}

TEST_CASE("inconsistent scenes are rejected") {
  const LrbRep solid = build_lrb(shapes::bumpy_sphere(2, 7, 0.3)), flat = build_lrb(shapes::star(5));
  CHECK_THROWS_AS(render::build_scene({}), InputError);
  CHECK_THROWS_AS(render::build_scene(std::vector<render::SceneBody>{{&solid, nullptr, {}, {}, ""},
                                                                     {&flat, nullptr, {}, {}, ""}}),
                  InputError);
  const std::vector<render::SceneBody> body = {{&solid, nullptr, {}, {}, ""}};
  render::SceneHighlight highlight;
  highlight.refining[0] = {RegionId(solid.region_count())};
  CHECK_THROWS_AS(render::build_scene(body, highlight), InputError);
  highlight = {};
  highlight.under_test = {0, 0};
  CHECK_THROWS_AS(render::build_scene(body, highlight), InputError);
  render::SceneOptions options;
  options.isolate[1] = {0};
  CHECK_THROWS_AS(render::build_scene(body, {}, options), InputError);
}

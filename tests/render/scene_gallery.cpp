#include "tests/render/scene_gallery.hpp"

#include <cmath>

#include "tests/render/bodies.hpp"
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::test {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> all_points(const std::vector<render::SceneBody>& bodies) {
  std::vector<Vector3d> out;
  for (const render::SceneBody& b : bodies) {
    const auto points = render::body_points(*b.rep, b.pose);
    out.insert(out.end(), points.begin(), points.end());
  }
  return out;
}

render::Image frame(render::Rasterizer& r, const render::Scene& scene, const std::vector<Vector3d>& points,
                    const std::string& title, int width = 1280, int height = 720, bool flat = false) {
  render::Overlay overlay;
  overlay.title = title;
  overlay.key = scene.key;
  overlay.scale = scene.scale;
  const render::OverlayLayout layout = render::lay_out(overlay, width, height);
  render::RasterOptions o;
  o.width = layout.picture.width, o.height = layout.picture.height;
  const render::Camera camera =
      flat ? render::fit_top(points, o.width, o.height) : render::fit_camera(points, o.width, o.height);
  return render::compose_frame(r.draw(scene.list, camera, o), layout.picture, overlay, width, height);
}

ContactRegion ring(const Vector3d& centre, const Vector3d& normal, double radius) {
  ContactRegion region;
  const Vector3d u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
  ContactLoop loop;
  loop.closed = true;
  for (int i = 0; i < 60; ++i) {
    const double t = 2 * 3.14159265358979 * i / 60;
    loop.points.push_back(centre + radius * (std::cos(t) * u + std::sin(t) * v));
  }
  region.loops.push_back(loop);
  return region;
}

void gallery_3d(render::Rasterizer& r, const std::string& folder) {
  const LrbRep a = dented(icosphere(1), 2, 0.25), b = dented(icosphere(0, 0.7), 3, 0.2);
  Wrapper wa(a), wb(b);
  const Pose pose_b = Pose::rotation({1, 2, 3}, 0.7, {1.25, -0.35, 0.25});
  for (RegionId i = 0; i < a.region_count(); ++i) {
    if ((Pose{}.apply(a.vertices()[a.face(a.lids(i)[0])[0]]) - Vector3d(1, -0.3, 0.2)).norm() < 0.75)
      wa.refine(i);
  }
  for (RegionId i = 0; i < 7; ++i) wb.refine(i);
  std::vector<render::SceneBody> bodies = {{&a, &wa, {}, {}, ""}, {&b, &wb, pose_b, {}, ""}};
  const auto points = all_points(bodies);
  const auto save = [&](const char* name, const render::Scene& scene, const std::string& title) {
    render::write_png(frame(r, scene, points, title), folder + "/scene_" + name + ".png");
  };
  render::SceneHighlight highlight;
  highlight.refining[0] = {33};
  highlight.refining[1] = {9};
  highlight.under_test = {a.first_simplex(a.lids(30)[0]), b.first_simplex(b.lids(2)[0])};
  const std::vector<ContactRegion> contacts = {ring({0.72, -0.22, 0.15}, {1.25, -0.35, 0.25}, 0.42)};
  highlight.contacts = contacts;
  save("kind", render::build_scene(bodies, highlight), "Dented balls, partly refined");
  render::SceneOptions options;
  options.colour_by = render::ColourBy::layer;
  save("layer", render::build_scene(bodies, {}, options), "By layer");
  options.colour_by = render::ColourBy::region;
  save("region", render::build_scene(bodies, {}, options), "By region");
  std::vector<double> va(a.face_count()), vb(b.face_count());
  for (FaceId f = 0; f < a.face_count(); ++f) va[f] = std::max(0.0, 400 * a.vertices()[a.face(f)[0]].x());
  for (FaceId f = 0; f < b.face_count(); ++f) vb[f] = f % 300;
  bodies[0].face_values = va, bodies[1].face_values = vb;
  options.colour_by = render::ColourBy::value;
  save("value", render::build_scene(bodies, {}, options), "By face tests");
  options = {};
  options.isolate[0] = {20, 21, 33};
  options.isolate[1] = {3};
  save("isolate", render::build_scene(bodies, {}, options), "Regions on their own");
  options = {};
  options.explode = 0.5;
  options.colour_by = render::ColourBy::region;
  render::Scene exploded =
      render::build_scene(std::vector<render::SceneBody>{{&a, nullptr, {}, {}, ""}}, {}, options);
  render::write_png(frame(r, exploded, render::extent_points(exploded.list), "Exploded"),
                    folder + "/scene_explode.png");
}

void gallery_2d(render::Rasterizer& r, const std::string& folder) {
  const LrbRep a = dented(circle(7), 3, 0.22), b = dented(circle(5, 0.7), 3, 0.2);
  std::vector<render::Panel> panels;
  for (int step = 0; step < 4; ++step) {
    Wrapper w(a);
    for (RegionId i = 0; i < a.region_count(); ++i) {
      if (a.layer(i) >= 3 - step && (step < 3 || i % 2 == 0 || a.layer(i) > 0)) w.refine(i);
    }
    const std::vector<render::SceneBody> body = {{&a, &w, {}, {}, ""}};
    const render::Scene scene = render::build_scene(body);
    render::RasterOptions o;
    o.width = 520, o.height = 400;
    panels.push_back({r.draw(scene.list, render::fit_top(all_points(body), o.width, o.height), o), ""});
  }
  render::write_png(render::montage(panels), folder + "/scene_2d_sequence.png");
  Wrapper wa(a), wb(b);
  for (const RegionId i : std::initializer_list<RegionId>{0, 1, 7, 8, 9, 22}) wa.refine(i);
  for (const RegionId i : std::initializer_list<RegionId>{2, 3}) wb.refine(i);
  const std::vector<render::SceneBody> bodies = {
      {&a, &wa, {}, {}, ""}, {&b, &wb, Pose::rotation({0, 0, 1}, 0.3, {1.35, 0.2, 0}), {}, ""}};
  render::SceneHighlight highlight;
  highlight.refining[0] = {2};
  highlight.refining[1] = {1};
  highlight.under_test = {a.first_simplex(a.outermost_faces()[0]), b.first_simplex(b.outermost_faces()[3])};
  ContactRegion point;
  point.loops.push_back({{{0.77, 0.3, 0}}, false});
  const std::vector<ContactRegion> contacts = {point};
  highlight.contacts = contacts;
  const auto points = all_points(bodies);
  render::write_png(
      frame(r, render::build_scene(bodies, highlight), points, "Two bodies in the plane", 1280, 720, true),
      folder + "/scene_2d_pair.png");
  render::SceneOptions options;
  options.colour_by = render::ColourBy::layer;
  Wrapper all(a);
  render::write_png(
      frame(r, render::build_scene(std::vector<render::SceneBody>{{&a, &all, {}, {}, ""}}, {}, options),
            render::body_points(a, {}), "By layer", 1280, 720, true),
      folder + "/scene_2d_layer.png");
  options.colour_by = render::ColourBy::region;
  options.explode = 0.5;
  const render::Scene exploded =
      render::build_scene(std::vector<render::SceneBody>{{&a, &all, {}, {}, ""}}, {}, options);
  render::write_png(frame(r, exploded, render::extent_points(exploded.list), "Exploded", 1280, 720, true),
                    folder + "/scene_2d_explode.png");
}

}  // namespace

void scene_gallery(const std::string& folder) {
  render::Rasterizer r;
  gallery_3d(r, folder);
  gallery_2d(r, folder);
}

}  // namespace lrb::test

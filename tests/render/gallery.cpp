/// Writes pictures to look at, one per thing the renderer can do: render_gallery FOLDER.

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include "render/montage.hpp"
#include "render/overlay.hpp"
#include "render/palette.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "tests/render/scene_gallery.hpp"
#include "tests/render/triangles.hpp"

using namespace lrb;
using Eigen::Vector3d;

namespace {

DrawList two_bodies() {
  DrawList list;
  DrawTriangle solid;
  solid.edges = 7;
  solid.edge_style = list.edge_style({{20, 20, 20, 150}, 0.9F});
  solid.colour = {86, 140, 200, 255};
  test::add(list, test::sphere_triangles(4, 1, {-0.7, 0, 0}), solid);
  solid.colour = {230, 170, 60, 255};
  test::add(list, test::sphere_triangles(3, 0.8, {0.8, 0.2, 0.2}), solid, 100000);
  DrawTriangle lid = solid;
  lid.layer = Layer::translucent;
  lid.colour = {86, 140, 200, 60};
  lid.edge_style = list.edge_style({{30, 60, 110, 160}, 1.2F});
  test::add(list, test::sphere_triangles(0, 1.35, {-0.7, 0, 0}), lid);
  lid.colour = {230, 170, 60, 60};
  lid.edge_style = list.edge_style({{150, 100, 10, 160}, 1.2F});
  test::add(list, test::sphere_triangles(0, 1.1, {0.8, 0.2, 0.2}), lid);
  DrawLine curve;
  curve.closed = true;
  const Vector3d d = Vector3d(1.5, 0.2, 0.2), n = d.normalized();
  const double dist = d.norm(), along = (dist * dist + 1 - 0.64) / (2 * dist),
               r = std::sqrt(1 - along * along);
  const Vector3d u = n.unitOrthogonal(), w = n.cross(u);
  for (int i = 0; i < 90; ++i) {
    const double t = i * 2 * 3.14159265358979 / 90;
    curve.points.push_back(Vector3d(-0.7, 0, 0) + along * n + r * (std::cos(t) * u + std::sin(t) * w));
  }
  curve.layer = Layer::on_top;
  curve.colour = {200, 30, 30, 255};
  curve.width = 3;
  curve.halo = kWhite;
  curve.halo_width = 1.5;
  list.lines.push_back(curve);
  list.points.push_back({curve.points[0], {200, 30, 30, 255}, 5, kWhite, 1.5, Layer::on_top, 1});
  list.labels.push_back({curve.points[0], "contact", {150, 0, 0, 255}, 18, 0, -22, kWhite});
  return list;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "out/gallery";
  std::filesystem::create_directories(folder);
  Rasterizer r;
  const auto save = [&](const char* name, const DrawList& list, const Camera& camera,
                        const RasterOptions& o) {
    const auto t0 = std::chrono::steady_clock::now();
    const Image image = r.draw(list, camera, o);
    const auto t1 = std::chrono::steady_clock::now();
    write_png(image, folder + "/" + name + ".png");
    const auto t2 = std::chrono::steady_clock::now();
    std::printf("%s: draw %.0f ms, png %.0f ms\n", name,
                std::chrono::duration<double, std::milli>(t1 - t0).count(),
                std::chrono::duration<double, std::milli>(t2 - t1).count());
  };
  const DrawList list = two_bodies();
  RasterOptions o;
  FitOptions fit;
  const auto points = extent_points(list);
  save("two_bodies", list, fit_camera(points, o.width, o.height, fit), o);
  save("two_bodies_again", list, fit_camera(points, o.width, o.height, fit), o);
  fit.orthographic = true;
  save("two_bodies_ortho", list, fit_camera(points, o.width, o.height, fit), o);
  fit.orthographic = false;
  save("contact", list, fit_contact(list.lines[0].points, bounds(list), o.width, o.height, fit), o);

  Overlay overlay;
  overlay.title = "Ball against ball, step 12 of 60";
  overlay.event = "Event 1 204: face test, pseudo face 17 of A against real face 5 120 of B: they cross";
  overlay.event_colour = palette::event(EventKind::face_test);
  overlay.counters = {{"face tests", group_digits(1204)},
                      {"refinements", group_digits(87)},
                      {"wrapper A", "112 faces"},
                      {"wrapper B", "98 faces"},
                      {"contacts", group_digits(23)}};
  using Mark = LegendItem::Mark;
  overlay.key = {{Mark::solid, palette::body(Side::a), "A, real faces"},
                 {Mark::translucent, palette::body(Side::a), "A, pseudo faces"},
                 {Mark::solid, palette::body(Side::b), "B, real faces"},
                 {Mark::translucent, palette::body(Side::b), "B, pseudo faces"},
                 {Mark::solid, palette::kRefining, "region being refined"},
                 {Mark::solid, palette::kUnderTest, "pair under test"},
                 {Mark::line, palette::kContact, "contact"},
                 {Mark::dashed, palette::kContact, "contact, hidden"}};
  overlay.scale = ScaleBar{"face tests per face", 0, 1234};
  fit = {};
  for (const auto& [w, h] : {std::pair{640, 360}, {1280, 720}, {1920, 1080}, {600, 800}}) {
    const OverlayLayout layout = lay_out(overlay, w, h);
    o.width = layout.picture.width, o.height = layout.picture.height;
    const Image picture = r.draw(list, fit_camera(points, o.width, o.height, fit), o);
    write_png(compose_frame(picture, layout.picture, overlay, w, h),
              folder + "/frame_" + std::to_string(w) + ".png");
  }
  o.width = 480, o.height = 360;
  std::vector<Panel> panels;
  for (int i = 0; i < 4; ++i) {
    fit.view = view_from_angles(-0.8 + i * 0.7, 0.4);
    panels.push_back(
        {r.draw(list, fit_camera(points, o.width, o.height, fit), o), "seen from " + std::to_string(i)});
  }
  panels[2].caption = "a caption that is long enough to need a second line, to see how it wraps";
  write_png(montage(panels), folder + "/montage.png");

  Image colours(900, 300);
  for (int i = 0; i < 60; ++i)
    colours.fill({i * 15, 0, 15, 60}, palette::category(static_cast<std::uint32_t>(i)));
  for (int x = 0; x < 900; ++x) colours.fill({x, 70, 1, 60}, palette::viridis(x / 899.0));
  const Rgba named[] = {palette::body(Side::a), palette::body(Side::b), palette::kContact,
                        palette::kRefining,     palette::kUnderTest,    palette::kPurple};
  for (int i = 0; i < 6; ++i) {
    colours.fill({i * 150, 140, 150, 70}, named[i]);
    const auto grey = static_cast<std::uint8_t>(luma(named[i]));
    colours.fill({i * 150, 215, 150, 70}, {grey, grey, grey});
  }
  write_png(colours, folder + "/colours.png");
  test::scene_gallery(folder);
  return 0;
}

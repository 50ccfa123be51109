/// Writes pictures to look at, one per thing the renderer can do: render_gallery FOLDER.

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include "tests/render/scene_gallery.hpp"
#include "tests/render/triangles.hpp"
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/style.hpp>

using namespace lrb;
using Eigen::Vector3d;

namespace {

render::DrawList two_bodies() {
  render::DrawList list;
  render::DrawTriangle solid;
  solid.edges = 7;
  solid.edge_style = list.edge_style({{20, 20, 20, 150}, 0.9F});
  solid.colour = {86, 140, 200, 255};
  test::add(list, test::sphere_triangles(4, 1, {-0.7, 0, 0}), solid);
  solid.colour = {230, 170, 60, 255};
  test::add(list, test::sphere_triangles(3, 0.8, {0.8, 0.2, 0.2}), solid, 100000);
  render::DrawTriangle lid = solid;
  lid.layer = render::Layer::translucent;
  lid.colour = {86, 140, 200, 60};
  lid.edge_style = list.edge_style({{30, 60, 110, 160}, 1.2F});
  test::add(list, test::sphere_triangles(0, 1.35, {-0.7, 0, 0}), lid);
  lid.colour = {230, 170, 60, 60};
  lid.edge_style = list.edge_style({{150, 100, 10, 160}, 1.2F});
  test::add(list, test::sphere_triangles(0, 1.1, {0.8, 0.2, 0.2}), lid);
  render::DrawLine curve;
  curve.closed = true;
  const Vector3d d = Vector3d(1.5, 0.2, 0.2), n = d.normalized();
  const double dist = d.norm(), along = (dist * dist + 1 - 0.64) / (2 * dist),
               r = std::sqrt(1 - along * along);
  const Vector3d u = n.unitOrthogonal(), w = n.cross(u);
  for (int i = 0; i < 90; ++i) {
    const double t = i * 2 * 3.14159265358979 / 90;
    curve.points.push_back(Vector3d(-0.7, 0, 0) + along * n + r * (std::cos(t) * u + std::sin(t) * w));
  }
  curve.layer = render::Layer::on_top;
  curve.colour = {200, 30, 30, 255};
  curve.width = 3;
  curve.halo = render::kWhite;
  curve.halo_width = 1.5;
  list.lines.push_back(curve);
  list.points.push_back(
      {curve.points[0], {200, 30, 30, 255}, 5, render::kWhite, 1.5, render::Layer::on_top, 1});
  list.labels.push_back({curve.points[0], "contact", {150, 0, 0, 255}, 18, 0, -22, render::kWhite});
  return list;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "out/gallery";
  std::filesystem::create_directories(folder);
  render::Rasterizer r;
  const auto save = [&](const char* name, const render::DrawList& list, const render::Camera& camera,
                        const render::RasterOptions& o) {
    const auto t0 = std::chrono::steady_clock::now();
    const render::Image image = r.draw(list, camera, o);
    const auto t1 = std::chrono::steady_clock::now();
    render::write_png(image, folder + "/" + name + ".png");
    const auto t2 = std::chrono::steady_clock::now();
    std::printf("%s: draw %.0f ms, png %.0f ms\n", name,
                std::chrono::duration<double, std::milli>(t1 - t0).count(),
                std::chrono::duration<double, std::milli>(t2 - t1).count());
  };
  const render::DrawList list = two_bodies();
  render::RasterOptions o;
  render::FitOptions fit;
  const auto points = render::extent_points(list);
  save("two_bodies", list, render::fit_camera(points, o.width, o.height, fit), o);
  save("two_bodies_again", list, render::fit_camera(points, o.width, o.height, fit), o);
  fit.orthographic = true;
  save("two_bodies_ortho", list, render::fit_camera(points, o.width, o.height, fit), o);
  fit.orthographic = false;
  save("contact", list,
       render::fit_contact(list.lines[0].points, render::bounds(list), o.width, o.height, fit), o);

  render::Overlay overlay;
  overlay.title = "Ball against ball, step 12 of 60";
  overlay.event = "Event 1 204: face test, pseudo face 17 of A against real face 5 120 of B: they cross";
  overlay.event_colour = render::palette::event(EventKind::face_test);
  overlay.counters = {{"face tests", render::group_digits(1204)},
                      {"refinements", render::group_digits(87)},
                      {"wrapper A", "112 faces"},
                      {"wrapper B", "98 faces"},
                      {"contacts", render::group_digits(23)}};
  using Mark = render::LegendItem::Mark;
  overlay.key = {{Mark::solid, render::palette::body(Side::a), "A, real faces"},
                 {Mark::translucent, render::palette::body(Side::a), "A, pseudo faces"},
                 {Mark::solid, render::palette::body(Side::b), "B, real faces"},
                 {Mark::translucent, render::palette::body(Side::b), "B, pseudo faces"},
                 {Mark::solid, render::palette::kRefining, "region being refined"},
                 {Mark::solid, render::palette::kUnderTest, "pair under test"},
                 {Mark::line, render::palette::kContact, "contact"},
                 {Mark::dashed, render::palette::kContact, "contact, hidden"}};
  overlay.scale = render::ScaleBar{"face tests per face", 0, 1234};
  fit = {};
  for (const auto& [w, h] : {std::pair{640, 360}, {1280, 720}, {1920, 1080}, {600, 800}}) {
    const render::OverlayLayout layout = render::lay_out(overlay, w, h);
    o.width = layout.picture.width, o.height = layout.picture.height;
    const render::Image picture = r.draw(list, render::fit_camera(points, o.width, o.height, fit), o);
    render::write_png(render::compose_frame(picture, layout.picture, overlay, w, h),
                      folder + "/frame_" + std::to_string(w) + ".png");
  }
  o.width = 480, o.height = 360;
  std::vector<render::Panel> panels;
  for (int i = 0; i < 4; ++i) {
    fit.view = render::view_from_angles(-0.8 + i * 0.7, 0.4);
    panels.push_back({r.draw(list, render::fit_camera(points, o.width, o.height, fit), o),
                      "seen from " + std::to_string(i)});
  }
  panels[2].caption = "a caption that is long enough to need a second line, to see how it wraps";
  render::write_png(render::montage(panels), folder + "/montage.png");

  render::Image colours(900, 300);
  for (int i = 0; i < 60; ++i)
    colours.fill({i * 15, 0, 15, 60}, render::palette::category(static_cast<std::uint32_t>(i)));
  for (int x = 0; x < 900; ++x) colours.fill({x, 70, 1, 60}, render::palette::viridis(x / 899.0));
  const render::Rgba named[] = {render::palette::body(Side::a), render::palette::body(Side::b),
                                render::palette::kContact,      render::palette::kRefining,
                                render::palette::kUnderTest,    render::palette::kPurple};
  for (int i = 0; i < 6; ++i) {
    colours.fill({i * 150, 140, 150, 70}, named[i]);
    const auto grey = static_cast<std::uint8_t>(render::luma(named[i]));
    colours.fill({i * 150, 215, 150, 70}, {grey, grey, grey});
  }
  render::write_png(colours, folder + "/colours.png");
  test::scene_gallery(folder);
  return 0;
}

/// Prints the hashes of a few pictures: run with several LP_NUM_THREADS, it must print the same.

#include <cstdio>

#include "tests/render/triangles.hpp"
#include <lrbscope/render/rasterize.hpp>

using namespace lrb;

int main() {
  render::DrawList list;
  render::DrawTriangle t;
  t.edges = 7;
  t.colour = {52, 126, 190};
  test::add(list, test::sphere_triangles(3), t);
  test::add(list, test::box_triangles({0.2, -0.4, -0.3}, {1.9, 0.7, 0.5}), t);
  t.layer = render::Layer::translucent;
  t.colour = {230, 159, 0, 70};
  test::add(list, test::sphere_triangles(1, 1.3), t);
  test::add(list, test::sphere_triangles(1, 1.2, {0.5, 0.1, 0}), t);
  list.lines.push_back({{{-1, -1, -1}, {1, 1, 1}, {1, -1, 0}},
                        true,
                        {196, 18, 48},
                        3,
                        5,
                        render::kWhite,
                        1,
                        render::Layer::on_top});
  list.points.push_back({{0, 1, 0}, {196, 18, 48}, 6, render::kWhite, 2, render::Layer::on_top});
  render::Rasterizer rasterizer;
  const auto points = render::extent_points(list);
  for (const auto& [width, height, samples] : {std::array{641, 359, 2}, {320, 240, 1}, {200, 300, 4}}) {
    render::RasterOptions o;
    o.width = width, o.height = height, o.supersample = samples;
    render::FitOptions fit;
    fit.orthographic = samples == 1;
    const render::Image image = rasterizer.draw(list, render::fit_camera(points, width, height, fit), o);
    std::printf("%016llx %dx%d\n", static_cast<unsigned long long>(render::hash(image)), width, height);
  }
  return 0;
}

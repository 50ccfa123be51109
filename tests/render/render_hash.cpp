/// Prints the hashes of a few pictures: run with several LP_NUM_THREADS, it must print the same.

#include <cstdio>

#include "render/rasterize.hpp"
#include "tests/render/triangles.hpp"

using namespace lrb;

int main() {
  DrawList list;
  DrawTriangle t;
  t.edges = 7;
  t.colour = {52, 126, 190};
  test::add(list, test::sphere_triangles(3), t);
  test::add(list, test::box_triangles({0.2, -0.4, -0.3}, {1.9, 0.7, 0.5}), t);
  t.layer = Layer::translucent;
  t.colour = {230, 159, 0, 70};
  test::add(list, test::sphere_triangles(1, 1.3), t);
  test::add(list, test::sphere_triangles(1, 1.2, {0.5, 0.1, 0}), t);
  list.lines.push_back(
      {{{-1, -1, -1}, {1, 1, 1}, {1, -1, 0}}, true, {196, 18, 48}, 3, 5, kWhite, 1, Layer::on_top});
  list.points.push_back({{0, 1, 0}, {196, 18, 48}, 6, kWhite, 2, Layer::on_top});
  Rasterizer rasterizer;
  const auto points = extent_points(list);
  for (const auto& [width, height, samples] : {std::array{641, 359, 2}, {320, 240, 1}, {200, 300, 4}}) {
    RasterOptions o;
    o.width = width, o.height = height, o.supersample = samples;
    FitOptions fit;
    fit.orthographic = samples == 1;
    const Image image = rasterizer.draw(list, fit_camera(points, width, height, fit), o);
    std::printf("%016llx %dx%d\n", static_cast<unsigned long long>(hash(image)), width, height);
  }
  return 0;
}

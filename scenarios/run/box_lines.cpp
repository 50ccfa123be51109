#include "scenarios/run/box_lines.hpp"

namespace lrb::run {

void add_box(render::DrawList& list, const Eigen::Vector3d& centre,
             const std::array<Eigen::Vector3d, 3>& half, const BoxLook& look) {
  const auto corner = [&](int x, int y, int z) -> Eigen::Vector3d {
    return centre + (x * 2 - 1) * half[0] + (y * 2 - 1) * half[1] + (z * 2 - 1) * half[2];
  };
  render::DrawLine line;
  line.colour = look.colour;
  line.width = look.width;
  line.dash = look.dash;
  line.layer = look.through ? render::Layer::on_top : render::Layer::translucent;
  for (int z = 0; z < 2; ++z) {
    line.points = {corner(0, 0, z), corner(1, 0, z), corner(1, 1, z), corner(0, 1, z)};
    line.closed = true;
    list.lines.push_back(line);
  }
  line.closed = false;
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y) {
      line.points = {corner(x, y, 0), corner(x, y, 1)};
      list.lines.push_back(line);
    }
}

}  // namespace lrb::run

#pragma once

#include <vector>

#include <Eigen/Core>

namespace lrb::run {

/// The frame of a page's view: x_page = (x - origin) / unit, in floats.
struct SceneFrame {
  Eigen::Vector3d origin{0, 0, 0};
  double unit = 1;

  void add_point(std::vector<float>& out, const Eigen::Vector3d& x) const { add(out, (x - origin) / unit); }
  /// A direction with a length.
  void add_vector(std::vector<float>& out, const Eigen::Vector3d& v) const { add(out, v / unit); }

 private:
  static void add(std::vector<float>& out, const Eigen::Vector3d& x) {
    for (int i = 0; i < 3; ++i) out.push_back(static_cast<float>(x[i]));
  }
};

}  // namespace lrb::run

#include "render/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

namespace lrb::render {
namespace flip {
namespace {

// Section numbers are the paper's. Constants are its values.
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
const double kPixelsPerDegree = 0.7 * (3840 / 0.7) * kPi / 180;

/// A picture of colours with real components.
struct ColourPlane {
  int width = 0, height = 0;
  std::vector<Vector3d> pixels;
};

double linear(int srgb) {
  const double c = srgb / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// sRGB primaries to CIE XYZ, and the white point that it maps (1, 1, 1) to.
const Eigen::Matrix3d kToXyz =
    (Eigen::Matrix3d() << 10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,
     2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897, 1425312.0 / 73733382,
     8788810.0 / 73733382, 70074185.0 / 73733382)
        .finished();
const Eigen::Matrix3d kFromXyz = kToXyz.inverse();
const Vector3d kWhitePoint = kToXyz * Vector3d(1, 1, 1);

/// The opponent colours YCxCz of 4.1: achromatic, red to green, blue to yellow.
Vector3d opponent(const Vector3d& rgb) {
  const Vector3d n = (kToXyz * rgb).cwiseQuotient(kWhitePoint);
  return {116 * n.y() - 16, 500 * (n.x() - n.y()), 200 * (n.y() - n.z())};
}

Vector3d rgb_of(const Vector3d& opponent) {
  const double y = (opponent.x() + 16) / 116;
  const Vector3d n(y + opponent.y() / 500, y, y - opponent.z() / 200);
  return kFromXyz * n.cwiseProduct(kWhitePoint);
}

/// CIELAB, with chroma reduced in dark colours (Hunt effect, 4.1.1).
Vector3d hunt_lab(const Vector3d& rgb) {
  const Vector3d n = (kToXyz * rgb).cwiseQuotient(kWhitePoint);
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const double l = 116 * f(n.y()) - 16;
  return {l, 0.01 * l * 500 * (f(n.x()) - f(n.y())), 0.01 * l * 200 * (f(n.y()) - f(n.z()))};
}

double hyab(const Vector3d& x, const Vector3d& y) {
  return std::abs(x[0] - y[0]) + std::hypot(x[1] - y[1], x[2] - y[2]);
}

using Kernel = std::vector<double>;

/// Convolves one component of each pixel by a separable kernel. Pixels beyond the border repeat it.
std::vector<double> convolve(const std::vector<double>& in, int width, int height, const Kernel& across,
                             const Kernel& down) {
  const int r = static_cast<int>(across.size()) / 2;
  std::vector<double> rows(in.size()), out(in.size());
  const auto at = [width](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int i = -r; i <= r; ++i) sum += across[i + r] * in[at(std::clamp(x + i, 0, width - 1), y)];
      rows[at(x, y)] = sum;
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int i = -r; i <= r; ++i) sum += down[i + r] * rows[at(x, std::clamp(y + i, 0, height - 1))];
      out[at(x, y)] = sum;
    }
  return out;
}

std::vector<double> component(const ColourPlane& p, int c) {
  std::vector<double> out;
  out.reserve(p.pixels.size());
  for (const Vector3d& v : p.pixels) out.push_back(v[c]);
  return out;
}

/// Removes details that an eye does not resolve (4.1): filters each opponent colour by its contrast
/// sensitivity, the sum of at most two Gaussians with weight a and width b.
ColourPlane filtered(const ColourPlane& in) {
  struct Sensitivity {
    double a[2], b[2];
  };
  constexpr Sensitivity kSensitivity[3] = {
      {{1, 0}, {0.0047, 1e-5}}, {{1, 0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}};
  const int r = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * kPixelsPerDegree));
  ColourPlane out = in;
  for (Vector3d& p : out.pixels) p.setZero();
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> values = component(in, c);
    double whole = 0;  // sum of the kernel's weights
    std::array<Kernel, 2> kernels;
    std::array<double, 2> weights{};
    for (int g = 0; g < 2; ++g) {
      const double b = kSensitivity[c].b[g];
      weights[g] = kSensitivity[c].a[g] * std::sqrt(kPi / b);
      double sum = 0;
      for (int i = -r; i <= r; ++i) {
        const double x = i / kPixelsPerDegree;
        kernels[g].push_back(std::exp(-kPi * kPi * x * x / b));
        sum += kernels[g].back();
      }
      whole += weights[g] * sum * sum;
    }
    for (int g = 0; g < 2; ++g) {
      if (weights[g] == 0) continue;
      const std::vector<double> part = convolve(values, in.width, in.height, kernels[g], kernels[g]);
      for (std::size_t i = 0; i < part.size(); ++i) out.pixels[i][c] += weights[g] / whole * part[i];
    }
  }
  return out;
}

/// The strengths of edges and of points at each pixel (4.2.1), of the achromatic component in [0, 1].
std::array<std::vector<double>, 2> features(const ColourPlane& p) {
  const double sd = 0.5 * 0.082 * kPixelsPerDegree;
  const int r = static_cast<int>(std::ceil(3 * sd));
  Kernel gauss, edge, point;
  double sum = 0, edge_sum = 0, plus = 0, minus = 0;
  for (int i = -r; i <= r; ++i) {
    const double g = std::exp(-i * i / (2 * sd * sd));
    gauss.push_back(g);
    edge.push_back(-i * g);
    point.push_back((i * i / (sd * sd) - 1) * g);
    sum += g;
    edge_sum += i < 0 ? -i * g : 0;
    (point.back() > 0 ? plus : minus) += std::abs(point.back());
  }
  // Positive weights add up to 1, and negative ones to -1.
  for (double& g : gauss) g /= sum;
  for (double& e : edge) e /= edge_sum;
  for (double& x : point) x /= x > 0 ? plus : minus;
  std::vector<double> y = component(p, 0);
  for (double& v : y) v = (v + 16) / 116;
  const auto length = [&](const Kernel& kernel) {
    std::vector<double> x = convolve(y, p.width, p.height, kernel, gauss);
    const std::vector<double> down = convolve(y, p.width, p.height, gauss, kernel);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], down[i]);
    return x;
  };
  return {length(edge), length(point)};
}

ColourPlane opponent_plane(const Image& image) {
  std::array<double, 256> linear_of{};
  for (int i = 0; i < 256; ++i) linear_of[i] = linear(i);
  ColourPlane out{image.width(), image.height(), {}};
  out.pixels.reserve(image.pixels().size());
  for (const Rgba c : image.pixels())
    out.pixels.push_back(opponent({linear_of[c.r], linear_of[c.g], linear_of[c.b]}));
  return out;
}

}  // namespace
}  // namespace flip

double mean_flip(const Image& expected, const Image& actual) {
  using namespace flip;
  constexpr double kColourPower = 0.7, kKnee = 0.4, kKneeError = 0.95, kFeaturePower = 0.5;
  // The largest colour difference: of green and blue (4.1.3).
  const double most = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColourPower);
  const ColourPlane x = opponent_plane(expected), y = opponent_plane(actual);
  const ColourPlane seen_x = filtered(x), seen_y = filtered(y);
  const auto features_x = features(x), features_y = features(y);
  const auto lab = [](const Vector3d& opponent) {
    return hunt_lab(rgb_of(opponent).cwiseMax(0.0).cwiseMin(1.0));
  };
  double sum = 0;
  for (std::size_t i = 0; i < x.pixels.size(); ++i) {
    const double d = std::pow(hyab(lab(seen_x.pixels[i]), lab(seen_y.pixels[i])), kColourPower);
    const double knee = kKnee * most;
    const double colour =
        d < knee ? kKneeError / knee * d : kKneeError + (d - knee) / (most - knee) * (1 - kKneeError);
    const double feature = std::max(std::abs(features_x[0][i] - features_y[0][i]),
                                    std::abs(features_x[1][i] - features_y[1][i]));
    sum += std::pow(colour, 1 - std::pow(feature / std::numbers::sqrt2, kFeaturePower));
  }
  return x.pixels.empty() ? 0 : sum / static_cast<double>(x.pixels.size());
}

}  // namespace lrb::render

#include "engine/lrb/thickness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;  // 2D: the second corner twice

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A lid's triangle is cut at most this many times, and not where the bound is within this factor of a value
/// that is certain.
constexpr int kMostCuts = 3;
constexpr double kTight = 1.25;

/// Returns the distance to some point of the segment, the nearest but for rounding: never less than the true
/// distance.
double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d d = b - a;
  const double square = d.squaredNorm();
  const double s = square > 0 ? std::clamp((p - a).dot(d) / square, 0.0, 1.0) : 0;
  return (p - (a + s * d)).norm();
}

/// Does the same for a triangle.
double distance_to(const Vector3d& p, const Triangle& t) {
  const Vector3d u = t[1] - t[0], v = t[2] - t[0], w = p - t[0], n = u.cross(v);
  const double area_sq = n.squaredNorm();
  if (area_sq > 0) {
    const double s = w.cross(v).dot(n) / area_sq, r = u.cross(w).dot(n) / area_sq;
    if (s >= 0 && r >= 0 && s + r <= 1) return (w - s * u - r * v).norm();
  }
  return std::min({distance_to_segment(p, t[0], t[1]), distance_to_segment(p, t[1], t[2]),
                   distance_to_segment(p, t[2], t[0])});
}

struct Target {
  Triangle triangle;
  double off;  ///< bound on the distance from any of its points to a real face
};

/// Computes the thickness of all regions. Works in units, so that squares neither overflow nor vanish.
class ThicknessFinder {
 public:
  explicit ThicknessFinder(const LrbRep& rep)
      : rep_(rep),
        unit_(rep.tree().unit()),
        state_(rep.region_count(), State::unknown),
        off_(rep.region_count(), kInfinity),
        inside_(rep.region_count(), kInfinity) {}

  std::vector<double> run() {
    for (RegionId r = 0; r < rep_.region_count(); ++r) find(r);
    std::vector<double> out(rep_.region_count());
    for (RegionId r = 0; r < rep_.region_count(); ++r) out[r] = (inside_[r] + kThicknessRounding) * unit_;
    return out;
  }

 private:
  enum class State : std::uint8_t { unknown, at_work, known };

  /// Measures a region, and first the regions under its floor. Uses a stack of its own, because there can be
  /// many layers.
  void find(RegionId root) {
    std::vector<RegionId> stack = {root};
    while (!stack.empty()) {
      const RegionId r = stack.back();
      bool waits = false;
      if (state_[r] == State::unknown) {
        state_[r] = State::at_work;
        for (const FaceId f : rep_.floor(r)) {
          const CellId under = rep_.inner_cell(f);
          if (!is_region(under) || state_[under] != State::unknown) continue;
          stack.push_back(under.as_region());
          waits = true;
        }
      }
      if (waits) continue;
      stack.pop_back();
      if (state_[r] == State::at_work) measure(r);
      state_[r] = State::known;
    }
  }

  /// Measures a region from what is known of the regions under its floor. One of these that is still at work
  /// hides this region in turn: its bound is still infinite then.
  void measure(RegionId r) {
    targets_.clear();
    double floor_off = 0;
    for (const FaceId f : rep_.floor(r)) {
      const CellId under = rep_.inner_cell(f);
      const double off = is_region(under) ? off_[under] : 0;
      floor_off = std::max(floor_off, off);
      for_each_triangle(f, [&](const Triangle& t) { targets_.push_back({t, off}); });
    }
    double worst = 0;
    for (const FaceId f : rep_.lids(r))
      for_each_triangle(f, [&](const Triangle& t) { worst = std::max(worst, lid_off(t, worst, 0)); });
    off_[r] = worst + kThicknessRounding;
    inside_[r] = std::max(off_[r], floor_off) + half_width(r);
  }

  /// Returns a bound on the distance from any point of a lid's triangle to a real face, or `enough` if that
  /// is larger.
  double lid_off(const Triangle& t, double enough, int cuts) {
    double bound = kInfinity;
    std::array<double, 3> at_corner = {kInfinity, kInfinity, kInfinity};
    for (const Target& target : targets_) {
      double most = 0;
      for (int k = 0; k < 3; ++k) {
        const double d = distance_to(t[k], target.triangle) + target.off;
        at_corner[k] = std::min(at_corner[k], d);
        most = std::max(most, d);
      }
      bound = std::min(bound, most);
      if (bound <= enough) return enough;
    }
    const double certain = std::max({at_corner[0], at_corner[1], at_corner[2], enough});
    if (cuts == kMostCuts || bound <= kTight * certain || !std::isfinite(bound)) return bound;
    const Vector3d m[3] = {0.5 * (t[0] + t[1]), 0.5 * (t[1] + t[2]), 0.5 * (t[2] + t[0])};
    double worst = enough;
    for (const Triangle& part : {Triangle{t[0], m[0], m[2]}, Triangle{m[0], t[1], m[1]},
                                 Triangle{m[2], m[1], t[2]}, Triangle{m[0], m[1], m[2]}})
      worst = std::max(worst, lid_off(part, worst, cuts + 1));
    return std::min(worst, std::max(bound, enough));
  }

  /// Returns half the region's least width along the axes and the mean direction of the lids.
  double half_width(RegionId r) const {
    Vector3d normal = Vector3d::Zero();
    for (const FaceId f : rep_.lids(r))
      for_each_triangle(f, [&](const Triangle& t) {
        if (rep_.dim() == 3)
          normal += (t[1] - t[0]).cross(t[2] - t[0]);
        else
          normal += Vector3d(t[1].y() - t[0].y(), t[0].x() - t[1].x(), 0);
      });
    double least = kInfinity;
    for (const Vector3d& d : {Vector3d(normal.normalized()), Vector3d(Vector3d::UnitX()),
                              Vector3d(Vector3d::UnitY()), Vector3d(Vector3d::UnitZ())}) {
      if (!(d.squaredNorm() > 0.5) || (rep_.dim() == 2 && d.z() != 0)) continue;
      double low = kInfinity, high = -kInfinity;
      for (const FaceId f : rep_.collector(r))
        for (const VertexId v : rep_.face(f)) {
          const double h = d.dot(rep_.vertices()[v] / unit_);
          low = std::min(low, h);
          high = std::max(high, h);
        }
      least = std::min(least, (high - low) / 2);
    }
    return least;
  }

  template <class Visit>
  void for_each_triangle(FaceId f, Visit visit) const {
    const std::size_t count = Mesh::simplices_of(rep_.face(f).size(), rep_.dim());
    for (std::size_t i = 0; i < count; ++i) {
      VertexId v[3] = {};
      rep_.simplex(SimplexId(rep_.first_simplex(f) + i), v);
      if (rep_.dim() == 2) v[2] = v[1];
      visit(Triangle{rep_.vertices()[v[0]] / unit_, rep_.vertices()[v[1]] / unit_,
                     rep_.vertices()[v[2]] / unit_});
    }
  }

  const LrbRep& rep_;
  double unit_;
  std::vector<State> state_;
  /// Units: bounds from any point of the region's lids, and from any point of the region.
  std::vector<double> off_, inside_;
  std::vector<Target> targets_;
};

}  // namespace

std::vector<double> region_thickness(const LrbRep& rep) {
  return ThicknessFinder(rep).run();
}

}  // namespace lrb

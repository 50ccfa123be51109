#include "scenarios/levels/lid_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.hpp"
#include "engine/lrb/nearest_face.hpp"

namespace lrb::levels {
namespace {

using Eigen::Vector3d;

/// Cuts a triangle at the middle of its longest edge until all are short. Neighbours cut an edge that they
/// share at the same points, so that no cracks appear.
void cut_triangle(LidPiece triangle, double longest, std::vector<LidPiece>& out) {
  std::vector<LidPiece> left = {triangle};
  while (!left.empty()) {
    const LidPiece t = left.back();
    left.pop_back();
    double length[3];
    for (int i = 0; i < 3; ++i) length[i] = (t.x[(i + 1) % 3] - t.x[i]).norm();
    const int k = static_cast<int>(std::max_element(length, length + 3) - length);
    if (!(length[k] > longest)) {
      out.push_back(t);
      continue;
    }
    const Vector3d a = t.x[k], b = t.x[(k + 1) % 3], c = t.x[(k + 2) % 3], middle = (a + b) / 2;
    left.push_back({{a, middle, c}, 0});
    left.push_back({{middle, b, c}, 0});
  }
}

void cut_segment(const Vector3d& a, const Vector3d& b, double longest, std::vector<LidPiece>& out) {
  const int count = std::max(1, static_cast<int>(std::ceil((b - a).norm() / longest)));
  for (int i = 0; i < count; ++i)
    out.push_back({{a + (b - a) * i / count, a + (b - a) * (i + 1) / count, Vector3d::Zero()}, 0});
}

void cut_lid(const LrbRep& rep, FaceId lid, double longest, std::vector<LidPiece>& out) {
  const auto corners = rep.face(lid);
  const auto x = [&](std::size_t i) { return rep.vertices()[corners[i]]; };
  if (rep.dim() == 2) return cut_segment(x(0), x(1), longest, out);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    cut_triangle({{x(0), x(i), x(i + 1)}, 0}, longest, out);
}

/// Measures points one after another; the face that was nearest to one is tried first for the next.
class Gauge {
 public:
  Gauge(const LrbRep& rep, const std::vector<Vector3d>& vertices)
      : unit_(rep.tree().unit()), nearest_(rep, vertices) {}

  double off(const Vector3d& x) {
    const Vector3d p = x / unit_;
    if (last_.simplex != kNull) last_.distance = nearest_.distance(p, last_.simplex);
    last_ = nearest_.find(p, last_);
    return last_.distance * unit_;
  }

 private:
  double unit_;
  NearestFace nearest_;
  NearFace last_;
};

}  // namespace

MeasuredLids measure_lids(const LrbRep& rep, std::span<const FaceId> lids, double longest, unsigned threads) {
  constexpr std::size_t kAtOnce = 16;  // lids
  const std::vector<Vector3d> vertices = vertices_in_units(rep);
  std::vector<MeasuredLids> parts((lids.size() + kAtOnce - 1) / kAtOnce);
  const int corners = rep.dim();
  Workers(threads).for_each(parts.size(), [&](std::size_t i, unsigned) {
    MeasuredLids& part = parts[i];
    Gauge gauge(rep, vertices);
    for (const FaceId lid : lids.subspan(i * kAtOnce, std::min(kAtOnce, lids.size() - i * kAtOnce))) {
      const std::size_t first = part.pieces.size();
      cut_lid(rep, lid, longest, part.pieces);
      for (std::size_t k = first; k < part.pieces.size(); ++k) {
        LidPiece& p = part.pieces[k];
        Vector3d sum = p.x[0] + p.x[1];
        if (corners == 3) sum += p.x[2];
        p.off = gauge.off(sum / corners);
        part.largest = std::max(part.largest, p.off);
      }
      for (const VertexId v : rep.face(lid))
        part.largest = std::max(part.largest, gauge.off(rep.vertices()[v]));
    }
  });
  MeasuredLids out;
  for (MeasuredLids& part : parts) {
    out.pieces.insert(out.pieces.end(), part.pieces.begin(), part.pieces.end());
    out.largest = std::max(out.largest, part.largest);
  }
  return out;
}

}  // namespace lrb::levels

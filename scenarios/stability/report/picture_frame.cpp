#include "scenarios/stability/report/picture_frame.hpp"

#include <array>
#include <limits>
#include <string>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "engine/core/error.hpp"

namespace lrb::stability {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_100;
using WidePoint = std::array<Wide, 3>;

struct WidePiece {
  std::vector<WidePoint> corners;
  std::vector<bool> edges;
};

/// Does one pass of Sutherland and Hodgman (I. Sutherland, G. Hodgman, "Reentrant Polygon Clipping", 1974):
/// keeps the part with sign * x[axis] <= reach.
WidePiece clip(const WidePiece& in, std::size_t axis, int sign, const Wide& reach) {
  WidePiece out;
  const std::size_t n = in.corners.size();
  const auto beyond = [&](const WidePoint& p) -> Wide { return sign * p[axis] - reach; };
  for (std::size_t i = 0; i < n; ++i) {
    if (n == 2 && i == 1) {  // a segment has no second side
      if (beyond(in.corners[1]) <= 0) out.corners.push_back(in.corners[1]), out.edges.push_back(false);
      break;
    }
    const WidePoint &p = in.corners[i], &q = in.corners[(i + 1) % n];
    const Wide dp = beyond(p), dq = beyond(q);
    if (dp <= 0) out.corners.push_back(p), out.edges.push_back(in.edges[i]);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
      const Wide t = dp / (dp - dq);
      WidePoint cut;
      for (std::size_t k = 0; k < 3; ++k) cut[k] = p[k] + t * (q[k] - p[k]);
      // On leaving, the next side runs along the cube, which is not an outline; on entering, along the old
      // side.
      out.corners.push_back(cut), out.edges.push_back(dp > 0 && in.edges[i]);
    }
  }
  return out;
}

bool inside(const Piece& piece, double reach) {
  for (const Eigen::Vector3d& p : piece.corners)
    if (!(p.cwiseAbs().maxCoeff() <= reach)) return false;
  return true;
}

}  // namespace

PosedBody::PosedBody(const LrbRep& rep, const Pose& pose) : rep_(&rep) {
  x_.reserve(rep.vertices().size());
  for (const Eigen::Vector3d& v : rep.vertices()) x_.push_back(pose.apply(v));
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) {
      if (!x_[v].allFinite())
        throw InputError("vertex " + std::to_string(v) +
                         ": its world coordinates are not finite: the case cannot be drawn");
      box_.extend(x_[v]);
    }
}

Piece PosedBody::simplex(SimplexId s) const {
  VertexId v[3];
  rep_->simplex(s, v);
  if (rep_->dim() == 2) return {{x_[v[0]], x_[v[1]]}, {true, false}};
  const FaceId f = rep_->face_of_simplex(s);
  const std::uint32_t i = s - rep_->first_simplex(f);
  return {{x_[v[0]], x_[v[1]], x_[v[2]]}, {i == 0, true, i + 3 == rep_->face(f).size()}};
}

Eigen::AlignedBox3d PosedBody::box(SimplexId s) const {
  Eigen::AlignedBox3d out;
  for (const Eigen::Vector3d& p : simplex(s).corners) out.extend(p);
  return out;
}

double diagonal(const Eigen::AlignedBox3d& box) {
  return box.isEmpty() ? 0 : (box.max() / 4 - box.min() / 4).stableNorm() * 4;
}

PictureFrame::PictureFrame(const Eigen::AlignedBox3d& box) {
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (largest > 0x1p1000) before_ = 0x1p-2;
  const Eigen::Vector3d low = box.min() * before_, high = box.max() * before_;
  middle_ = low / 2 + high / 2;
  radius_ = (high - low).maxCoeff() / 2;
  // Bodies that have collapsed to a point are drawn as a point, so that any size will do.
  if (!(radius_ > 0)) radius_ = std::max(largest * before_, std::numeric_limits<double>::min());
}

Piece PictureFrame::cut(const Piece& world, double reach) const {
  Piece near = world;
  for (Eigen::Vector3d& p : near.corners) p = (*this)(p);
  if (inside(near, reach)) return near;
  WidePiece wide;
  wide.edges = world.edges;
  for (const Eigen::Vector3d& p : world.corners) {
    WidePoint& q = wide.corners.emplace_back();
    for (int k = 0; k < 3; ++k)
      q[static_cast<std::size_t>(k)] = (Wide(p[k]) * before_ - Wide(middle_[k])) / Wide(radius_);
  }
  for (std::size_t axis = 0; axis < 3 && !wide.corners.empty(); ++axis)
    for (const int sign : {-1, 1}) wide = clip(wide, axis, sign, reach);
  Piece out;
  out.edges = wide.edges;
  for (const WidePoint& q : wide.corners)
    out.corners.emplace_back(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]));
  return out;
}

}  // namespace lrb::stability

#include "engine/query/clash/parting.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/clash_tolerances.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/query/collide_impl.hpp"

namespace lrb::parting {

Parting::Parting(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                 const UnitBodies& bodies)
    : a_(a), b_(b), pose_a_(pose_a), pose_b_(pose_b), frame_(bodies.frame) {
  // Real faces alone, so that regions change nothing.
  for (FaceId f = 0; f < b.real_face_count(); ++f)
    for (const VertexId v : b.face(f))
      reach_ = std::max(reach_, pose_b.apply(b.vertices()[v]).cwiseAbs().maxCoeff());
}

Parting::Moved Parting::moved(const Vector3d& n, double s) const {
  Moved m{pose_b_, Vector3d::Zero()};
  for (int k = 0; k < 3; ++k) m.pose.t[k] += frame_.length_to_world(s * n[k]);
  m.by = m.pose.t - pose_b_.t;
  return m;
}

bool Parting::is_apart(const Vector3d& n, double s) {
  const Moved m = moved(n, s);
  if (!m.pose.t.allFinite() || !(reach_ + m.by.cwiseAbs().maxCoeff() < kLargestMoved)) return false;
  ++asked_;
  CollideRequest request;
  request.mode = Mode::any_pair;
  NullProbe probe;
  return collide(a_, pose_a_, b_, m.pose, request, query_, probe).relation == Relation::separate;
}

/// The query's corners of B are fl(q + t'), those of the contract fl(q + t), with the same q: they differ
/// from a translation by t' - t by a rounding of each, u times coordinates of at most reach_ and reach_ +
/// |by|; and m.by is t' - t rounded: in each coordinate u |by| off. In length together less than 2 u (2
/// reach_ + 2 |by|), u = 2^-53, plus what denormals lose. Bodies that are further apart than this are apart
/// after the exact translation, too: on the way between the two surfaces do not meet.
bool Parting::is_proved(const Moved& m, double more) {
  if (!m.pose.t.allFinite() || !(reach_ + m.by.cwiseAbs().maxCoeff() < kLargestMoved)) return false;
  const double rounding = 0x1p-51 * (reach_ + m.by.norm()) + more + kWorldUnderflow;
  ++asked_;
  DistanceRequest request;
  request.within = rounding;
  const DistanceResult result = distance(a_, pose_a_, b_, m.pose, request, distance_);
  return result.relation == Relation::separate && result.within && !*result.within;
}

std::optional<PartingMove> Parting::prove(const Vector3d& n, double s) {
  const double rounding = std::ldexp(0x1p-50 * (reach_ + frame_.length_to_world(s)), -frame_.exponent);
  for (double more = kPartingMargin + 2 * rounding; more < kMostPartingMargin; more *= 8) {
    const Moved m = moved(n, s + more);
    if (is_proved(m, 0)) return PartingMove{m.by, m.by.stableNorm() * (1 + 0x1p-50)};
  }
  return std::nullopt;
}

std::optional<double> Parting::prove_along(const Vector3d& n, double s) {
  const double rounding = std::ldexp(0x1p-50 * (reach_ + frame_.length_to_world(s)), -frame_.exponent);
  for (double more = kPartingMargin + 2 * rounding; more < kMostPartingMargin; more *= 8) {
    const Moved m = moved(n, s + more);
    Vector3d wanted;
    for (int k = 0; k < 3; ++k) wanted[k] = frame_.length_to_world((s + more) * n[k]);
    // Products and the difference are rounded: u times what they are, each.
    if (is_proved(m, (m.by - wanted).norm() * 2 + 0x1p-50 * wanted.norm())) return s + more;
  }
  return std::nullopt;
}

double Parting::least_apart(const Vector3d& n, double most, int samples) {
  double met = 0, apart = most;
  for (int i = 1; i < samples; ++i) {
    const double s = most * i / samples;
    if (is_apart(n, s)) {
      apart = s;
      break;
    }
    met = s;
  }
  while (apart - met > kPartingMargin) {
    const double middle = 0.5 * (met + apart);
    if (!(middle > met && middle < apart)) break;
    (is_apart(n, middle) ? apart : met) = middle;
  }
  return apart;
}

}  // namespace lrb::parting

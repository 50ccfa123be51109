#include "engine/clash/separation_search.hpp"

#include <algorithm>
#include <cmath>

#include "engine/clash/clash_tolerances.hpp"
#include "engine/collide/collide_into.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb {

SeparationSearch::SeparationSearch(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                   const UnitBodies& bodies)
    : a_(a), b_(b), pose_a_(pose_a), pose_b_(pose_b), frame_(bodies.frame) {
  // Real faces only, so that the result does not depend on the regions.
  for (FaceId f = 0; f < b.real_face_count(); ++f)
    for (const VertexId v : b.face(f))
      reach_ = std::max(reach_, pose_b.apply(b.vertices()[v]).cwiseAbs().maxCoeff());
  double smaller = kSmallBody;
  for (const UnitBody& body : bodies.body) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& x : body.points) box.extend(x);
    smaller = std::min(smaller, box.sizes().maxCoeff());
  }
  margin_ = kSeparationMargin * (smaller / kSmallBody);
}

SeparationSearch::Moved SeparationSearch::moved(const Vector3d& n, double s) const {
  Moved m{pose_b_, Vector3d::Zero()};
  for (int k = 0; k < 3; ++k) m.pose.t[k] += frame_.length_to_world(s * n[k]);
  // The actual displacement, rounded once. The pose is rounded as well, so this differs from s n.
  m.by = m.pose.t - pose_b_.t;
  return m;
}

bool SeparationSearch::is_separated(const Vector3d& n, double s) {
  const Moved m = moved(n, s);
  // Coordinates could overflow. NaN is rejected as well.
  if (!m.pose.t.allFinite() || !(reach_ + m.by.cwiseAbs().maxCoeff() < kLargestMoved)) return false;
  ++query_count_;
  // One intersecting pair is enough to reject a translation.
  CollideRequest request;
  request.mode = Mode::any_pair;
  NullProbe probe;
  return collide(a_, pose_a_, b_, m.pose, request, query_, probe).relation == Relation::separate;
}

/// The query uses corners fl(q + t') of B, the contract fl(q + t), with the same q. They differ from a
/// translation by t' - t by one rounding of each, which is u times coordinates of at most reach_ and reach_ +
/// |by|. m.by is t' - t with an error of at most u |by| in each coordinate. The total is less than 2 u (2
/// reach_ + 2 |by|) in length, u = 2^-53, plus the loss near underflow. Bodies that are farther apart than
/// this are separate after the exact translation as well, because the surfaces do not intersect between the
/// two positions.
bool SeparationSearch::is_proved(const Moved& m, double more) {
  if (!m.pose.t.allFinite() || !(reach_ + m.by.cwiseAbs().maxCoeff() < kLargestMoved)) return false;
  // 0x1p-51 is 4 u, from the derivation above; `more` is the caller's own error.
  const double rounding = 0x1p-51 * (reach_ + m.by.norm()) + more + kWorldUnderflow;
  ++query_count_;
  DistanceRequest request;
  // The distance query decides whether the bodies are farther apart than the rounding.
  request.within = rounding;
  const DistanceResult result = distance(a_, pose_a_, b_, m.pose, request, distance_);
  // Separate, not contained in each other, and farther apart than the rounding.
  return result.relation == Relation::separate && result.within && !*result.within;
}

std::optional<SeparatingTranslation> SeparationSearch::prove(const Vector3d& n, double s) {
  // Rounding of world coordinates, in units.
  const double rounding = std::ldexp(0x1p-50 * (reach_ + frame_.length_to_world(s)), -frame_.exponent);
  // Add a margin that grows by a factor of 8 until the proof succeeds.
  for (double more = margin_ + 2 * rounding; more < kMaxSeparationMargin; more *= 8) {
    const Moved m = moved(n, s + more);
    if (is_proved(m, 0)) return SeparatingTranslation{m.by, stable_norm3(m.by) * (1 + 0x1p-50)};
  }
  return std::nullopt;
}

std::optional<double> SeparationSearch::prove_along(const Vector3d& n, double s) {
  // As in prove(), but the direction must be n itself.
  const double rounding = std::ldexp(0x1p-50 * (reach_ + frame_.length_to_world(s)), -frame_.exponent);
  for (double more = margin_ + 2 * rounding; more < kMaxSeparationMargin; more *= 8) {
    const Moved m = moved(n, s + more);
    Vector3d wanted;
    for (int k = 0; k < 3; ++k) wanted[k] = frame_.length_to_world((s + more) * n[k]);
    // Deviation from the requested translation. Products and the difference are rounded by u times their size
    // each.
    if (is_proved(m, (m.by - wanted).norm() * 2 + 0x1p-50 * wanted.norm())) return s + more;
  }
  return std::nullopt;
}

double SeparationSearch::least_separation(const Vector3d& n, double most, int samples, double resolution) {
  // A linear search for the first sample that separates: concave bodies may collide again farther out.
  double met = 0, apart = most;
  for (int i = 1; i < samples; ++i) {
    const double s = most * i / samples;
    if (is_separated(n, s)) {
      apart = s;
      break;
    }
    met = s;
  }
  // Bisection between the last colliding and the first separating sample.
  while (apart - met > std::max(margin_, resolution)) {
    const double midpoint = 0.5 * (met + apart);
    // No double lies between the two.
    if (!(midpoint > met && midpoint < apart)) break;
    (is_separated(n, midpoint) ? apart : met) = midpoint;
  }
  return apart;
}

}  // namespace lrb

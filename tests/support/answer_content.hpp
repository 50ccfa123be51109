#pragma once
/// All that answers have in common when they are the same to the last bit.

#include <array>
#include <optional>
#include <tuple>
#include <vector>

#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/point_distance.hpp>

namespace lrb::test {

inline auto content(const ProvedInterval& x) {
  return std::tuple(x.lower, x.upper);
}
inline auto content(const std::optional<ProvedInterval>& x) {
  return std::tuple(x.has_value(), content(x.value_or(ProvedInterval{})));
}
inline auto content(const Eigen::Vector3d& x) {
  return std::array{x.x(), x.y(), x.z()};
}
inline auto content(const Witness& x) {
  return std::tuple(content(x.point), x.simplex, x.face, x.corners, x.corner_count);
}
inline auto content(const SurfacePieces& x) {
  return std::tuple(x.inside, x.outside, x.max_outside, x.on_same, x.on_opposite);
}
inline auto content(const ContactRegion& x) {
  return std::tuple(x.pairs, x.length, x.area, content(x.centroid), content(x.normal), x.depth_estimate);
}
inline auto content(const NearPair& x) {
  return std::tuple(x.a, x.b, x.meet, x.lower, x.upper, content(x.point[0]), content(x.point[1]));
}
inline auto content(const ManifoldPoint& x) {
  return std::tuple(x.id, content(x.point[0]), content(x.point[1]), x.depth, x.on[0], x.on[1]);
}
inline auto content(const ContactManifold& x);
inline auto content(const PointDistance& x);
template <class T>
auto content(const std::vector<T>& list) {
  std::vector<decltype(content(T{}))> out;
  for (const T& x : list) out.push_back(content(x));
  return out;
}
inline auto content(const ContactManifold& x) {
  return std::tuple(content(x.normal), content(x.points), x.pairs, x.region, x.intersects);
}
inline auto content(const CollideResult& x) {
  return std::tuple(x.relation, x.interiors_overlap, x.mode, x.pairs, x.meets, x.opened, x.error_bound,
                    x.finished, x.separation, content(x.regions), x.contacts.size(), x.counters);
}
inline auto content(const NearPairsResult& x) {
  return std::tuple(content(x.pairs), static_cast<const NearPairsNumbers&>(x), x.counters);
}
inline auto content(const ManifoldResult& x) {
  return std::tuple(content(x.pairs), content(x.manifolds), x.next_id);
}
inline auto content(const PointDistance& x) {
  return std::tuple(x.lower, x.upper, x.side, content(x.closest));
}
inline auto content(const DistanceResult& x) {
  return std::tuple(x.lower, x.upper, x.meet, x.within, x.finished, x.relation, content(x.witness[0]),
                    content(x.witness[1]), x.counters);
}
inline auto content(const ClashResult& x) {
  return std::tuple(x.kind, x.reason, x.shares_faces, x.interiors_overlap, content(x.pieces[0]),
                    content(x.pieces[1]), content(x.distance), content(x.depth), content(x.translation),
                    content(x.along), content(x.volume));
}
inline auto content(const FirstContactResult& x) {
  return std::tuple(x.outcome, x.t0, x.t1, x.at_start, x.grazing, x.passed, x.finished, x.unresolved,
                    x.at_begin, x.ambiguous, x.pair, content(x.witness[0]), content(x.witness[1]),
                    content(x.normal), x.speed, x.counters);
}

}  // namespace lrb::test

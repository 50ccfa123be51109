#include "engine/query/collide_probe.hpp"

#include "engine/query/collide_impl.hpp"
#include "engine/query/teller.hpp"

namespace lrb {
void CollideProbe::face_test(SimplexId, SimplexId, exact::Meet, std::uint32_t, std::uint32_t) {}
void CollideProbe::refine(Side, RegionId, std::uint32_t) {}
void CollideProbe::coarsen(Side, RegionId, std::uint32_t) {}
void CollideProbe::contact(SimplexId, SimplexId, exact::Meet) {}
EventLevel CollideProbe::level() const {
  return EventLevel::faces;
}
std::uint32_t CollideProbe::node_pair(const NodeVisit&) {
  return kNull;
}
void CollideProbe::plane_test(SimplexId, SimplexId, Side) {}
void CollideProbe::tested_by(TestedBy) {}
void CollideProbe::point(Side, VertexId, Where) {}
void CollideProbe::begin(Phase, std::uint32_t, std::uint32_t) {}
void CollideProbe::end(Phase, std::uint64_t) {}

CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request, CollideProbe& probe) {
  QueryContext context;
  Teller teller(probe);
  return collide(a, pose_a, b, pose_b, request, context, teller);
}

}  // namespace lrb

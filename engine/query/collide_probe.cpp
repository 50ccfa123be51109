#include "engine/query/collide_probe.hpp"

#include "engine/query/collide_impl.hpp"

namespace lrb {
namespace {

/// A CollideProbe as the query's templates take it.
class Teller {
 public:
  static constexpr bool kEnabled = true;

  explicit Teller(CollideProbe& probe) : probe_(probe) {}
  void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a, std::uint32_t depth_b) {
    probe_.face_test(a, b, meet, depth_a, depth_b);
  }
  void refine(Side side, RegionId region, std::uint32_t faces_added) {
    probe_.refine(side, region, faces_added);
  }
  void coarsen(Side side, RegionId region, std::uint32_t faces_removed) {
    probe_.coarsen(side, region, faces_removed);
  }
  void contact(SimplexId a, SimplexId b, exact::Meet meet) { probe_.contact(a, b, meet); }
  EventLevel level() const { return probe_.level(); }
  std::uint32_t node_pair(const NodeVisit& visit) { return probe_.node_pair(visit); }
  void plane_test(SimplexId a, SimplexId b, Side whose) { probe_.plane_test(a, b, whose); }
  void tested_by(TestedBy how) { probe_.tested_by(how); }
  void point(Side whose, VertexId v, Where where) { probe_.point(whose, v, where); }
  void begin(Phase phase, std::uint32_t walked_a, std::uint32_t walked_b) {
    probe_.begin(phase, walked_a, walked_b);
  }
  void end(Phase phase, std::uint64_t count) { probe_.end(phase, count); }

 private:
  CollideProbe& probe_;
};

}  // namespace

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

#pragma once
/// Passes what a query tells on to a CollideProbe.

#include <cstdint>

#include "engine/query/collide_probe.hpp"

namespace lrb {

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

}  // namespace lrb

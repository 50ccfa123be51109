#include "scenarios/cli/pose_lines.hpp"

#include "engine/query/collide_impl.hpp"

namespace lrb::cli {

void PoseLines::check(const LrbRep& a, const LrbRep& b) const {
  check_query(a, Pose{}, b, Pose{});
  for (std::size_t i = 0; i < poses.size(); ++i) at(i, [&] { check_query(a, Pose{}, b, poses[i]); });
}

}  // namespace lrb::cli

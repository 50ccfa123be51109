// Penetration depths of non-convex bodies: running time, and ratio of the lower bound to the upper one.
#include <algorithm>

#include "bench/micro/poses.hpp"
#include <lrbscope/clash.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace {

constexpr Depth kDepths[] = {{"1 %", 0.01}, {"5 %", 0.05}, {"20 %", 0.2}};

void add_all(const Subject& s) {
  for (const Depth& d : kDepths)
    add(s, d.name, [&s, depth = d.depth](benchmark::State& state) {
      const std::vector<Pose>& poses = poses_at(s, depth, 8);
      ClashRequest request;
      request.volume = false;
      double least = 1;
      const auto tightness = [&](const Pose& p) {
        const ClashResult r = clash(s.body, {}, s.body, p, request);
        const double share = r.depth && r.depth->upper > 0 ? r.depth->lower / r.depth->upper : 1;
        least = std::min(least, share);
        return share;
      };
      at_all_poses(state, poses, tightness);
      state.counters["lower/upper"] = mean(poses, tightness);
      state.counters["least"] = least;
    })->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv, add_all);
}

// Coarse queries with tolerances and time limits, and exact ones at the same poses. Tolerances and error
// bounds are shares of the longest side of the body's box. `lrbscope chart` compares them with other methods.
#include <cmath>

#include "bench/micro/poses.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace {

constexpr Depth kDepths[] = {{"separate 0.5 %", -0.005},
                             {"touching", 0},
                             {"barely 0.1 %", 0.001},
                             {"shallow 1 %", 0.01},
                             {"deep 10 %", 0.1}};

void add_request(const Subject& s, const Depth& depth, const std::string& what,
                 const CollideRequest& request) {
  add(s, std::string(depth.name) + "/" + what, [&s, at = depth.depth, request](benchmark::State& state) {
    const std::vector<Pose>& poses = poses_at(s, at);
    Workspace workspace;
    const auto ask = [&](const Pose& p) -> const CollideResult& {
      return collide(s.body, {}, s.body, p, request, workspace).value();
    };
    at_all_poses(state, poses, ask);
    state.counters["pairs"] = mean(poses, [&](const Pose& p) { return ask(p).pairs.size(); });
    state.counters["known"] =
        mean(poses, [&](const Pose& p) { return ask(p).relation != Relation::unresolved; });
    state.counters["finished"] = mean(poses, [&](const Pose& p) { return ask(p).finished; });
    state.counters["error_bound"] = mean(poses, [&](const Pose& p) { return ask(p).error_bound / s.size; });
  });
}

void add_all(const Subject& s) {
  s.body.rep().levels();
  for (const Depth& depth : kDepths) {
    add_request(s, depth, "exact", {});
    for (const double share : {0.01, 0.02}) {
      CollideRequest request;
      request.tolerance = share * s.size;
      add_request(s, depth, "tolerance " + io::number_text(share), request);
    }
    CollideRequest request;
    request.max_tests = ~std::uint64_t{0};
    add_request(s, depth, "limits never reached", request);
  }
  for (double limit = 8; limit <= 512; limit *= 2) {
    CollideRequest request;
    request.max_time = 1e-6 * limit;
    add_request(s, kDepths[4], io::number_text(limit) + " us", request);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv, add_all);
}

// The packaged FCL's continuousCollide() of two BVHModels. Motions that turn by more than FCL's can are put
// to it piece by piece, until one meets. The body that moves is FCL's first: of a second body that comes
// nearer its advancement sees nothing. Its ray shooting takes no meshes.
#include "tests/bench/sweep_methods.hpp"

#ifdef LRB_WITH_FCL

#include <fcl/narrowphase/continuous_collision.h>

#include "tests/bench/fcl_model.hpp"
#include "tests/bench/timing.hpp"

namespace lrb::bench {
namespace {

using MotionPointer = std::shared_ptr<fcl::MotionBased>;

/// From one pose to another; the reference point of a motion that turns is named, as FCL leaves it undefined.
MotionPointer fcl_motion(const Pose& from, const Pose& to, bool straight) {
  if (straight) return std::make_shared<fcl::TranslationMotiond>(fcl_pose(from), fcl_pose(to));
  const Eigen::Vector3d origin(0, 0, 0);
  return std::make_shared<fcl::InterpMotion<double>>(from.r, from.t, to.r, to.t, origin);
}

template <class Volume>
SweepMethod by_solver(const std::string& name, fcl::CCDSolverType solver, std::size_t iterations) {
  fcl::ContinuousCollisionRequestd request;
  request.ccd_solver_type = solver;
  request.num_max_iterations = iterations;
  const auto make = [request](const SweptFamily& family) -> SweepAsker {
    const auto a = fcl_model<Volume>(family.a), b = fcl_model<Volume>(family.b);
    return [a, b, request](const SweptMotion& m) {
      SweepAnswer answer;
      const auto start = std::chrono::steady_clock::now();
      const std::size_t pieces = m.stations.size() - 1;
      for (std::size_t i = 0; i < pieces && !answer.contact; ++i) {
        const MotionPointer still = fcl_motion({}, {}, m.straight),
                            moves = fcl_motion(m.stations[i], m.stations[i + 1], m.straight);
        fcl::ContinuousCollisionResultd result;
        fcl::continuousCollide<double>(b.get(), moves.get(), a.get(), still.get(), request, result);
        answer.contact = result.is_collide;
        answer.t = (static_cast<double>(i) + result.time_of_contact) / static_cast<double>(pieces);
      }
      answer.t0 = answer.t;
      answer.microseconds = 1e6 * seconds_since(start);
      return answer;
    };
  };
  return {name, false, make};
}

/// The solver of polynomials looks at vertices without their poses, and moves the model: a model for each
/// motion, already where the motion begins, made outside of the clock.
template <class Volume>
SweepMethod by_polynomials(const std::string& name) {
  const auto make = [](const SweptFamily& family) -> SweepAsker {
    return [&family](const SweptMotion& m) {
      const auto a = fcl_model<Volume>(family.a), b = fcl_model<Volume>(family.b, m.stations.front());
      const Pose way = Pose::translation(m.stations.back().t - m.stations.front().t);
      fcl::ContinuousCollisionRequestd request;
      request.ccd_solver_type = fcl::CCDC_POLYNOMIAL_SOLVER;
      const auto start = std::chrono::steady_clock::now();
      const MotionPointer still = fcl_motion({}, {}, true), moves = fcl_motion({}, way, true);
      fcl::ContinuousCollisionResultd result;
      fcl::continuousCollide<double>(b.get(), moves.get(), a.get(), still.get(), request, result);
      SweepAnswer answer;
      answer.contact = result.is_collide;
      answer.t = answer.t0 = result.time_of_contact;
      answer.microseconds = 1e6 * seconds_since(start);
      return answer;
    };
  };
  return {name, true, make};
}

}  // namespace

std::vector<SweepMethod> fcl_sweep_methods() {
  const auto advancement = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
  return {by_solver<fcl::OBBRSSd>("FCL, naive", fcl::CCDC_NAIVE, 10),
          by_solver<fcl::OBBRSSd>("FCL, naive, 1000", fcl::CCDC_NAIVE, 1000),
          by_solver<fcl::RSSd>("FCL, advancement, RSS", advancement, 10),
          by_solver<fcl::OBBRSSd>("FCL, advancement, OBBRSS", advancement, 10),
          by_solver<fcl::AABBd>("FCL, advancement, AABB", advancement, 10),
          by_polynomials<fcl::OBBRSSd>("FCL, polynomials")};
}

}  // namespace lrb::bench

#else

namespace lrb::bench {
std::vector<SweepMethod> fcl_sweep_methods() {
  return {};
}
}  // namespace lrb::bench

#endif

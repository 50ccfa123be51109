/// The distance query; distance.hpp names its sources. Steps:
/// 1. Measure one pair of simplices for a first upper bound: the candidate of the previous step, or any pair.
/// 2. Traverse both trees, best first: in float where that is accurate enough, otherwise in double.
/// 3. Measure the pairs that are left, in double and, where needed, in integers.
/// 4. Complete the answer: closest points and relation of the bodies.

#include "engine/query/distance/distance.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/query/collide_impl.hpp"
#include "engine/query/distance/distance_impl.hpp"
#include "engine/query/distance/world_walk.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {
namespace {

DistanceResult of_nothing(const DistanceRequest& request) {
  DistanceResult result;
  result.lower = result.upper = std::numeric_limits<double>::infinity();
  if (request.within) result.within = false;
  return result;
}

void check_number(double x, const char* name) {
  if (!(x >= 0) || std::isinf(x))
    throw InputError(std::string("the distance query's ") + name + " is " + std::to_string(x) +
                     "; give a finite number that is not negative");
}

}  // namespace

void check_request(const DistanceRequest& request) {
  if (request.within) check_number(*request.within, "`within`");
  check_number(request.tolerance, "`tolerance`");
  check_number(request.relative_tolerance, "`relative_tolerance`");
}

DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, DistanceContext& context, KnownFromBefore* before,
                        BoundsProbe* probe) {
  check_query(a, pose_a, b, pose_b);
  check_request(request);
  // A body without faces is infinitely far from everything.
  if (a.tree().empty() || b.tree().empty()) return of_nothing(request);
  QueryContext& query = context.query;
  query.body[0].begin(a, pose_a, WrapperMode::regularised);
  query.body[1].begin(b, pose_b, WrapperMode::regularised);
  NearestPairs found(query, request, context.pairs);
  // Only coherent queries accept that the last digits depend on the order of the pairs.
  if (before != nullptr) found.spare_equal_pairs();
  DistanceResult result;
  const bool is_likely = before != nullptr && before->likely[0] != kNull;
  if (is_likely) {
    // Step 1, coherent: the candidate is often still the closest. If it intersects, the query ends here.
    const std::array<SimplexId, 2>& likely = before->likely;
    if (!found.measure(likely[0], likely[1], 0) && found.pair_meets(likely)) {
      found.finish(0, true, result);
      return result;
    }
  } else if (request.max_steps > 0 || request.within) {  // there must be an upper end, however early it stops
    // Step 1, otherwise: an early stop needs some upper bound, and any pair gives one.
    found.measure(a.tree().blocks()[0].simplex[0], b.tree().blocks()[0].simplex[0], 0);
  }
  // Step 2: bring both bodies into one frame, and choose the traversal by its accuracy.
  const TreeKernel tree = set_up_any_kernel(a.tree(), pose_a, b.tree(), pose_b, a.dim(), query.affine);
  bool finished = false;
  double rest = 0;
  std::optional<BoundsTeller> told;
  if (probe != nullptr) told.emplace(*probe);
  BoundsTeller* const teller = told ? &*told : nullptr;
  if (suits_floats(tree)) {
    // A likely candidate has given an upper bound already: no descent to a first pair.
    FloatWalk walk(context, found, request, tree, query_unit(a.tree(), b.tree()), !is_likely,
                   before != nullptr ? &before->far : nullptr);
    finished = walk.run(teller);
    // Step 3. In the other traversal, pairs are measured as they are found.
    if (!found.known_to_meet()) rest = walk.measure();
    walk.count(result.counters);
  } else {
    WorldWalk walk(query, found);
    finished = walk.run(request.max_steps, teller);
    rest = walk.rest();
    result.counters.steps = walk.steps();
    result.counters.box_tests = walk.box_tests();
  }
  // The probe sees the bounds before and after the exact measurements.
  if (told && !found.known_to_meet())
    told->tell(result.counters.steps + found.measured(), found.lower(rest), found.upper());
  // Step 4.
  found.finish(rest, finished, result);
  if (told) told->tell(result.counters.steps + found.measured(), result.lower, result.upper);
  return result;
}

DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request) {
  DistanceContext context;
  return distance(a, pose_a, b, pose_b, request, context);
}

DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, BoundsProbe& probe) {
  DistanceContext context;
  return distance(a, pose_a, b, pose_b, request, context, nullptr, &probe);
}

std::vector<DistanceResult> distances(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                      std::span<const Pose> poses_b, const DistanceRequest& request,
                                      unsigned threads) {
  Workers workers(threads);
  std::vector<DistanceContext> contexts(workers.count());
  std::vector<DistanceResult> results(poses_b.size());
  // Results do not depend on which worker computes which pose: contexts only lend memory.
  workers.for_each(poses_b.size(), [&](std::size_t i, unsigned worker) {
    results[i] = distance(a, pose_a, b, poses_b[i], request, contexts[worker]);
  });
  return results;
}

}  // namespace lrb

/// The distance query; distance.hpp names its sources. Steps:
/// 1. Measure one pair of simplices for a first upper bound: the candidate of the previous step, or any pair.
/// 2. Traverse both trees, best first: in float where that is accurate enough, otherwise in double.
/// 3. Measure the pairs that are left, in double and, where needed, in integers.
/// 4. Complete the answer: closest points and relation of the bodies.

#include <cmath>
#include <limits>
#include <string>

#include "engine/collide/collide_into.hpp"
#include "engine/distance/distance_context.hpp"
#include "engine/distance/far_pairs.hpp"
#include "engine/distance/world_walk.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

// Distances along a motion. Kept from the previous step:
// - The pair of simplices that was closest. Measured at the new poses, it gives an upper bound and the
//   direction of slabs before the traversal begins. If the surfaces intersected in it and still do, nothing
//   is traversed.
// - The relation of the bodies. If the surfaces were disjoint, and no points can have approached by as much
//   as the distance was, they do not intersect anywhere on the path between the steps: one body contains the
//   other now if it did then.
// - Planes that separate pairs of nodes: as long as they do, these nodes are not expanded.
// That no other pair is closer is proven anew in each step.

class CoherentDistance::Work {
 public:
  Work(const LrbRep& a, const LrbRep& b, const DistanceRequest& request) : a_(a), b_(b), request_(request) {}

  DistanceResult distance(const Pose& pose_a, const Pose& pose_b) {
    const PosePair now{pose_a, pose_b};
    const bool lies_as_before = request_.relation && is_relation_kept(now);
    // A relation that is kept need not be computed.
    DistanceRequest ask = request_;
    ask.relation = request_.relation && !lies_as_before;
    DistanceResult result = lrb::distance(a_, pose_a, b_, pose_b, ask, context_, &before_);
    // Kept only if this step proves a positive distance, which an early stop may not.
    if (lies_as_before) result.relation = result.lower > 0 ? relation_ : Relation::unresolved;
    // Where the bounds of the next step begin.
    before_.likely = {result.witness[0].simplex, result.witness[1].simplex};
    apart_ = result.lower;
    relation_ = result.relation;
    poses_ = now;
    return result;
  }

 private:
  bool is_relation_kept(const PosePair& now) const {
    // Only for solids: the relation of open bodies is decided by boxes, which move with each pose. NaN or an
    // unknown distance keeps nothing.
    return a_.closed() && b_.closed() && apart_ > 0 && std::isfinite(apart_) &&
           nearer_by(a_, b_, poses_, now, apart_) < apart_;
  }

  const LrbRep &a_, &b_;
  const DistanceRequest request_;
  DistanceContext context_;
  // Of the last answer:
  KnownFromBefore before_;
  double apart_ = 0;  ///< the lower end
  Relation relation_ = Relation::undefined;
  PosePair poses_;
};

CoherentDistance::CoherentDistance(const LrbRep& a, const LrbRep& b, const DistanceRequest& request)
    : work_(std::make_unique<Work>(a, b, request)) {}
CoherentDistance::~CoherentDistance() = default;
CoherentDistance::CoherentDistance(CoherentDistance&&) noexcept = default;
CoherentDistance& CoherentDistance::operator=(CoherentDistance&&) noexcept = default;

DistanceResult CoherentDistance::distance(const Pose& pose_a, const Pose& pose_b) {
  return work_->distance(pose_a, pose_b);
}

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

/// The pairs within a distance; near_pairs.hpp lists the steps.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "engine/collide/candidate_cache.hpp"
#include "engine/collide/tree_query.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/distance/near_pairs_context.hpp"
#include "engine/distance/pair_bounds.hpp"
#include "engine/exact/pair_distance.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/near_pairs.hpp>

namespace lrb {
namespace {

/// Maximum deviation of poses from rotations for which the trees of the bodies are traversed. The margin
/// below grows with it.
constexpr double kMaxDefect = 0x1p-6;
/// Capacity of the kernel's buffer, number of candidates that are found before they are measured, which
/// bounds the memory, and number that one thread measures at a time.
constexpr std::size_t kBuffered = 4096, kCandidatesAtOnce = 1U << 22, kCandidatesOfChunk = 512;

/// Returns the body with its world coordinates as the coordinates of its vertices.
LrbRep in_world(const LrbRep& rep, const Pose& pose) {
  Mesh mesh;
  mesh.dim = rep.dim();
  for (const Eigen::Vector3d& x : rep.vertices()) mesh.vertices.push_back(pose.apply(x));
  for (FaceId f = 0; f < rep.real_face_count(); ++f) mesh.add_face(rep.face(f));
  return LrbRep::without_regions(mesh, false, false);
}

/// Measures pairs; one for each thread.
class PairMeter {
 public:
  PairMeter(WorldVertices& a, WorldVertices& b, double within)
      : dim_(a.rep().dim()), within_(within), world_{&a, &b} {}

  /// Writes the pair to `out`. Returns false if its distance exceeds `within`.
  bool measure(SimplexPair pair, NearPair& out) {
    const double *of_a[3], *of_b[3];
    world_[0]->corners(pair.a, of_a);
    world_[1]->corners(pair.b, of_b);
    // Neighbouring candidates often have the same separating slab.
    if (distance_along(direction_, within_, of_a, of_b, dim_) > within_) return false;
    const PairBounds bounds = bound_distance(of_a, of_b, dim_);
    const bool is_measured = std::isfinite(bounds.upper) && bounds.lower > 0;
    if (is_measured && bounds.lower > within_) {
      direction_ = bounds.direction;
      return false;
    }
    out = {pair.a,       pair.b,       exact::Meet::disjoint,
           bounds.lower, bounds.upper, {bounds.point[0], bounds.point[1]}};
    return (is_measured && bounds.upper <= within_) || decide(of_a, of_b, is_measured, out);
  }

  std::uint64_t pairs_exact() const { return pairs_exact_; }

 private:
  /// Decides a pair in integers, and completes it. is_measured: the bounds exclude contact.
  bool decide(const double* const* of_a, const double* const* of_b, bool is_measured, NearPair& out) {
    ++pairs_exact_;
    if (!is_measured) {
      out.meet = dim_ == 3 ? exact::meet_triangles(of_a, of_b) : exact::meet_segments(of_a, of_b);
      if (out.meet != exact::Meet::disjoint) {
        // Both closest points are a corner of the intersection.
        const exact::PairContact contact =
            dim_ == 3 ? exact::contact_of_triangles(of_a, of_b) : exact::contact_of_segments(of_a, of_b);
        out.lower = out.upper = 0;
        out.point[0] = out.point[1] = contact.corners[0].x;
        return true;
      }
    }
    if (exact::compare_distance(of_a, of_b, dim_, within_) > 0) return false;
    if (is_measured) {
      out.upper = within_;
      return true;
    }
    const exact::PairDistance exact = exact::distance_of_simplices(of_a, of_b, dim_);
    out.lower = exact.lower;
    out.upper = std::min(exact.upper, within_);
    out.point[0] = exact.point[0];
    out.point[1] = exact.point[1];
    return true;
  }

  int dim_;
  double within_;
  WorldVertices* world_[2];
  Eigen::Vector3d direction_{0, 0, 0};  ///< normal of a slab that was wide enough
  std::uint64_t pairs_exact_ = 0;
};

/// Orders pairs by their lower bounds, then by their ids.
bool is_nearer(const NearPair& x, const NearPair& y) {
  return std::tie(x.lower, x.upper, x.a, x.b) < std::tie(y.lower, y.upper, y.a, y.b);
}

/// The search in the trees of two bodies whose poses are nearly rotations.
class NearPairsSearch {
 public:
  NearPairsSearch(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const NearPairsRequest& request, Workers& workers, QueryContext& query,
                  NearPairsContext& context, NearPairsResult& result)
      : a_(a),
        b_(b),
        pose_a_(pose_a),
        pose_b_(pose_b),
        request_(request),
        workers_(workers),
        query_(query),
        context_(context),
        result_(result) {
    // Wrappers are not needed: only the poses and the trees of the bodies are set.
    for (int side = 0; side < 2; ++side) {
      query.body[side].world.begin(side == 0 ? a : b, side == 0 ? pose_a : pose_b);
      query.body[side].query_body();
    }
    // The calling thread uses the vertices of the query.
    context.worlds.resize(2 * (workers.count() - 1));
    for (std::size_t i = 0; i < context.worlds.size(); ++i)
      context.worlds[i].begin(i % 2 == 0 ? a : b, i % 2 == 0 ? pose_a : pose_b);
    meters_.emplace_back(query.body[0].world, query.body[1].world, request.within);
    for (std::size_t i = 0; i < context.worlds.size(); i += 2)
      meters_.emplace_back(context.worlds[i], context.worlds[i + 1], request.within);
  }

  void run() {
    context_.candidates.clear();
    TreeKernel k = start_rigid_kernel(query_, pose_a_, pose_b_, kBuffered);
    aim(k);
    // An infinite margin would cull nothing, and a NaN would be ignored.
    k.margin < std::numeric_limits<float>::infinity() ? traverse(k) : take_all();
    measure();
    for (const PairMeter& meter : meters_) result_.counters.pairs_exact += meter.pairs_exact();
    const auto by_ids = [](const NearPair& x, const NearPair& y) {
      return x.a != y.a ? x.a < y.a : x.b < y.b;
    };
    std::vector<NearPair>& pairs = result_.pairs;
    if (request_.nearest > 0)
      std::sort_heap(pairs.begin(), pairs.end(), is_nearer);
    else if (!std::is_sorted(pairs.begin(), pairs.end(), by_ids))
      std::sort(pairs.begin(), pairs.end(), by_ids);
  }

 private:
  /// Makes the kernel keep all pairs that are at most `within` apart in the world.
  void aim(TreeKernel& k) const {
    const Eigen::Matrix3d to_a = pose_a_.r.transpose();
    Sweep sweep;
    sweep.mid_pose = {to_a * pose_b_.r, to_a * (pose_b_.t - pose_a_.t)};
    // A distance on A's axes is at most this much longer than in the world.
    sweep.width = request_.within * stretch(pose_a_) * (1 + kWorldRounding);
    // Rounding of world coordinates, and the deviation of R_A^T from the inverse of R_A: see
    // relative_motion.hpp.
    const double rounding = wrapper_margin(pose_a_, a_.tree(), pose_b_, b_.tree()) +
                            2 * rotation_defect(pose_a_.r) * a_.tree().extent();
    aim_at(sweep, rounding, query_unit(a_.tree(), b_.tree()), k);
  }

  void traverse(TreeKernel& k) {
    while (!is_done(k)) {
      k.out_size = 0;
      run_tree_kernel(k);
      for (std::uint32_t i = 0; i < k.out_size; ++i) take({k.out[i].a, k.out[i].b});
    }
    result_.counters.node_pairs = k.node_pairs;
    result_.counters.box_tests = k.box_tests;
  }

  void take_all() {
    for (SimplexId s = 0; s < a_.real_simplex_count(); ++s)
      for (SimplexId t = 0; t < b_.real_simplex_count(); ++t) take({s, t});
  }

  void take(SimplexPair candidate) {
    context_.candidates.push_back(candidate);
    if (context_.candidates.size() == kCandidatesAtOnce) measure();
  }

  /// Measures the candidates in ascending order, on all threads, and adds those that are near.
  void measure() {
    std::vector<SimplexPair>& candidates = context_.candidates;
    result_.counters.candidates += candidates.size();
    context_.order.sort(candidates);
    if (workers_.count() == 1) {
      NearPair pair;
      for (const SimplexPair& candidate : candidates)
        if (meters_[0].measure(candidate, pair)) add(pair);
    } else {
      measure_in_chunks();
    }
    candidates.clear();
  }

  void measure_in_chunks() {
    const std::vector<SimplexPair>& candidates = context_.candidates;
    const std::size_t chunks = (candidates.size() + kCandidatesOfChunk - 1) / kCandidatesOfChunk;
    std::vector<std::vector<NearPair>>& near = context_.near;
    if (near.size() < chunks) near.resize(chunks);
    workers_.for_each(chunks, [&](std::size_t i, unsigned worker) {
      near[i].clear();
      NearPair pair;
      const std::size_t end = std::min(candidates.size(), (i + 1) * kCandidatesOfChunk);
      for (std::size_t c = i * kCandidatesOfChunk; c < end; ++c)
        if (meters_[worker].measure(candidates[c], pair)) near[i].push_back(pair);
    });
    for (std::size_t i = 0; i < chunks; ++i)
      for (const NearPair& pair : near[i]) add(pair);
  }

  void add(const NearPair& pair) {
    ++result_.found;
    std::vector<NearPair>& pairs = result_.pairs;
    if (request_.nearest == 0) {
      const std::uint64_t limit = request_.max_pairs > 0 ? request_.max_pairs : kMaxPairs;
      if (pairs.size() == limit)
        throw InputError("more than " + std::to_string(limit) +
                         " pairs of triangles are within the distance, the limit set by max_pairs; raise it "
                         "(--max-pairs), or ask for the nearest ones (--nearest)");
      pairs.push_back(pair);
      return;
    }
    // A heap with the farthest of the nearest pairs on top.
    if (pairs.size() == request_.nearest) {
      if (!is_nearer(pair, pairs.front())) return;
      std::pop_heap(pairs.begin(), pairs.end(), is_nearer);
      pairs.pop_back();
    }
    pairs.push_back(pair);
    std::push_heap(pairs.begin(), pairs.end(), is_nearer);
  }

  const LrbRep &a_, &b_;
  const Pose &pose_a_, &pose_b_;
  const NearPairsRequest& request_;
  Workers& workers_;
  QueryContext& query_;
  NearPairsContext& context_;
  NearPairsResult& result_;
  std::vector<PairMeter> meters_;  ///< (threads)
};

}  // namespace

void check_request(const NearPairsRequest& request) {
  if (!(request.within >= 0) || std::isinf(request.within))
    throw InputError("near pairs: expected a finite distance `within` of at least 0, found " +
                     std::to_string(request.within));
}

void near_pairs_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const NearPairsRequest& request, Workers& workers, QueryContext& query,
                     NearPairsContext& context, NearPairsResult& result) {
  check_query(a, pose_a, b, pose_b);
  check_request(request);
  result.pairs.clear();
  result.found = 0;
  result.counters = {};
  if (a.tree().empty() || b.tree().empty()) return;
  if (rotation_defect(pose_a.r) <= kMaxDefect &&
      rotation_defect(pose_a.r.transpose() * pose_b.r) <= kMaxDefect) {
    NearPairsSearch(a, pose_a, b, pose_b, request, workers, query, context, result).run();
    return;
  }
  // Scaled or sheared bodies: the kernel has no margin for their poses.
  const LrbRep world_a = in_world(a, pose_a), world_b = in_world(b, pose_b);
  const Pose identity;
  NearPairsSearch(world_a, identity, world_b, identity, request, workers, query, context, result).run();
}

NearPairsResult near_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                           const NearPairsRequest& request, unsigned threads) {
  Workers workers(threads);
  QueryContext query;
  NearPairsContext context;
  NearPairsResult result;
  near_pairs_into(a, pose_a, b, pose_b, request, workers, query, context, result);
  return result;
}

}  // namespace lrb

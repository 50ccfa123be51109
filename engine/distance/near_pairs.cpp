/// The pairs within a distance; near_pairs.hpp lists the steps.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

#include "engine/collide/candidate_cache.hpp"
#include "engine/collide/query_context.hpp"
#include "engine/collide/tree_query.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/distance/pair_bounds.hpp"
#include "engine/exact/pair_distance.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {
namespace {

/// Maximum deviation of poses from rotations for which the trees of the bodies are traversed. The margin
/// below grows with it.
constexpr double kMaxDefect = 0x1p-6;
/// Number of candidates that are found before they are measured, and that one thread measures at a time.
constexpr std::size_t kCandidatesAtOnce = 1U << 16, kCandidatesOfChunk = 512;

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
  PairMeter(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b, double within)
      : dim_(a.dim()), within_(within) {
    world_[0].begin(a, pose_a);
    world_[1].begin(b, pose_b);
  }

  /// Returns the pair, or nullopt if its distance exceeds `within`.
  std::optional<NearPair> measure(SimplexPair pair) {
    const double *of_a[3], *of_b[3];
    world_[0].corners(pair.a, of_a);
    world_[1].corners(pair.b, of_b);
    // Neighbouring candidates often have the same separating slab.
    if (distance_along(direction_, within_, of_a, of_b, dim_) > within_) return std::nullopt;
    const PairBounds bounds = bound_distance(of_a, of_b, dim_);
    const bool is_measured = std::isfinite(bounds.upper) && bounds.lower > 0;
    if (is_measured && bounds.lower > within_) {
      direction_ = bounds.direction;
      return std::nullopt;
    }
    NearPair out{pair.a,       pair.b,       exact::Meet::disjoint,
                 bounds.lower, bounds.upper, {bounds.point[0], bounds.point[1]}};
    if (is_measured && bounds.upper <= within_) return out;
    ++pairs_exact_;
    if (!is_measured) {
      // Doubles do not exclude contact.
      out.meet = dim_ == 3 ? exact::meet_triangles(of_a, of_b) : exact::meet_segments(of_a, of_b);
      if (out.meet != exact::Meet::disjoint) return met(out, of_a, of_b);
    }
    if (exact::compare_distance(of_a, of_b, dim_, within_) > 0) return std::nullopt;
    if (is_measured) {
      out.upper = within_;
    } else {
      const exact::PairDistance exact = exact::distance_of_simplices(of_a, of_b, dim_);
      out.lower = exact.lower;
      out.upper = exact.upper;
      out.point[0] = exact.point[0];
      out.point[1] = exact.point[1];
    }
    return out;
  }

  std::uint64_t pairs_exact() const { return pairs_exact_; }

 private:
  /// Completes a pair that intersects: both closest points are a corner of the intersection.
  NearPair met(NearPair& out, const double* const* of_a, const double* const* of_b) const {
    const exact::PairContact contact =
        dim_ == 3 ? exact::contact_of_triangles(of_a, of_b) : exact::contact_of_segments(of_a, of_b);
    out.lower = out.upper = 0;
    out.point[0] = out.point[1] = contact.corners[0].x;
    return out;
  }

  int dim_;
  double within_;
  WorldVertices world_[2];
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
                  const NearPairsRequest& request, unsigned threads)
      : a_(a), b_(b), pose_a_(pose_a), pose_b_(pose_b), request_(request), workers_(threads) {
    meters_.assign(workers_.count(), PairMeter(a, pose_a, b, pose_b, request.within));
  }

  NearPairsResult run() {
    context_.body[0].begin(a_, pose_a_, WrapperMode::regularised);
    context_.body[1].begin(b_, pose_b_, WrapperMode::regularised);
    TreeKernel k = start_rigid_kernel(context_, pose_a_, pose_b_, kCandidatesAtOnce);
    aim(k);
    // An infinite margin would cull nothing, and a NaN would be ignored.
    k.margin < std::numeric_limits<float>::infinity() ? traverse(k) : take_all();
    for (const PairMeter& meter : meters_) result_.counters.pairs_exact += meter.pairs_exact();
    const auto by_ids = [](const NearPair& x, const NearPair& y) {
      return x.a != y.a ? x.a < y.a : x.b < y.b;
    };
    request_.nearest > 0 ? std::sort_heap(result_.pairs.begin(), result_.pairs.end(), is_nearer)
                         : std::sort(result_.pairs.begin(), result_.pairs.end(), by_ids);
    return std::move(result_);
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
    std::vector<SimplexPair> found;
    while (!is_done(k)) {
      k.out_size = 0;
      run_tree_kernel(k);
      found.clear();
      for (std::uint32_t i = 0; i < k.out_size; ++i) found.push_back({k.out[i].a, k.out[i].b});
      measure(found);
    }
    result_.counters.node_pairs = k.node_pairs;
    result_.counters.box_tests = k.box_tests;
  }

  void take_all() {
    std::vector<SimplexPair> found;
    for (SimplexId s = 0; s < a_.real_simplex_count(); ++s) {
      found.clear();
      for (SimplexId t = 0; t < b_.real_simplex_count(); ++t) found.push_back({s, t});
      measure(found);
    }
  }

  /// Measures candidates on all threads and adds those that are near, in their order.
  void measure(const std::vector<SimplexPair>& candidates) {
    result_.counters.candidates += candidates.size();
    const std::size_t chunks = (candidates.size() + kCandidatesOfChunk - 1) / kCandidatesOfChunk;
    if (near_.size() < chunks) near_.resize(chunks);
    workers_.for_each(chunks, [&](std::size_t i, unsigned worker) {
      near_[i].clear();
      const std::size_t end = std::min(candidates.size(), (i + 1) * kCandidatesOfChunk);
      for (std::size_t c = i * kCandidatesOfChunk; c < end; ++c)
        if (const auto pair = meters_[worker].measure(candidates[c])) near_[i].push_back(*pair);
    });
    for (std::size_t i = 0; i < chunks; ++i)
      for (const NearPair& pair : near_[i]) add(pair);
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
  const Pose pose_a_, pose_b_;
  const NearPairsRequest& request_;
  Workers workers_;
  std::vector<PairMeter> meters_;            ///< (threads)
  std::vector<std::vector<NearPair>> near_;  ///< (chunks)
  QueryContext context_;
  NearPairsResult result_;
};

}  // namespace

void check_request(const NearPairsRequest& request) {
  if (!(request.within >= 0) || std::isinf(request.within))
    throw InputError("near pairs: expected a finite distance `within` of at least 0, found " +
                     std::to_string(request.within));
}

NearPairsResult near_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                           const NearPairsRequest& request, unsigned threads) {
  check_query(a, pose_a, b, pose_b);
  check_request(request);
  if (a.tree().empty() || b.tree().empty()) return {};
  // Scaled or sheared bodies: the kernel has no margin for their poses.
  if (!(rotation_defect(pose_a.r) <= kMaxDefect &&
        rotation_defect(pose_a.r.transpose() * pose_b.r) <= kMaxDefect))
    return NearPairsSearch(in_world(a, pose_a), Pose{}, in_world(b, pose_b), Pose{}, request, threads).run();
  return NearPairsSearch(a, pose_a, b, pose_b, request, threads).run();
}

}  // namespace lrb

/// The pairs within a distance; near_pairs.hpp lists the steps.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <tuple>

#include "engine/collide/candidate_cache.hpp"
#include "engine/collide/tree_query.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/distance/near_kernel.hpp"
#include "engine/distance/near_pairs_context.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/pair_distance.hpp>

namespace lrb {
namespace {

/// Maximum deviation of poses from rotations for which the trees of the bodies are traversed. The margin
/// below grows with it.
constexpr double kMaxDefect = 0x1p-6;
/// Capacity of the kernel's buffer, number of candidates that are found before they are measured, which
/// bounds the memory, and number that one thread measures at a time.
constexpr std::size_t kBuffered = 512, kCandidatesAtOnce = 1U << 22, kCandidatesOfChunk = 512;

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
      : rep_{&a, &b}, pose_{&pose_a, &pose_b} {
    kernel_.within = within;
    const int dim = a.dim();
    for (int side = 0; side < 2; ++side)
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
          kernel_.r[side][row][column] = row < dim ? pose_[side]->r(row, column) : 0;
        kernel_.t[side][row] = row < dim ? pose_[side]->t[row] : 0;
      }
  }

  /// Appends the pairs whose distance is at most `within`, in their order.
  void measure(std::span<const SimplexPair> pairs, std::vector<NearPair>& near) {
    for (; !pairs.empty(); pairs = pairs.subspan(std::min(pairs.size(), kAtOnce)))
      measure_some(pairs.first(std::min(pairs.size(), kAtOnce)), near);
  }

  std::uint64_t pairs_exact() const { return pairs_exact_; }

 private:
  static constexpr std::size_t kEights = 8, kAtOnce = 8 * kEights;

  void measure_some(std::span<const SimplexPair> pairs, std::vector<NearPair>& near) {
    kernel_.pairs = eights_;
    kernel_.block_count = static_cast<std::uint32_t>((pairs.size() + 7) / 8);
    for (std::size_t i = 0; i < 8 * kernel_.block_count; ++i) {
      // The last pair fills up the last eight.
      const SimplexPair& pair = pairs[std::min(i, pairs.size() - 1)];
      load(0, pair.a, i);
      load(1, pair.b, i);
    }
    run_pair_bounds_kernel(kernel_);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const EightPairsMeasured& eight = eights_[i / 8];
      const double lower = eight.lower[i % 8], upper = eight.upper[i % 8];
      if (lower > kernel_.within) continue;
      NearPair& pair = near.emplace_back();
      pair.a = pairs[i].a, pair.b = pairs[i].b;
      pair.lower = lower, pair.upper = upper;
      for (int side = 0; side < 2; ++side)
        for (int x = 0; x < 3; ++x) pair.point[side][x] = eight.point[side][x][i % 8];
      if (!(lower > 0 && upper <= kernel_.within) && !decide(lower > 0 && std::isfinite(upper), pair))
        near.pop_back();
    }
  }

  void load(int side, SimplexId s, std::size_t i) {
    VertexId v[3] = {};
    rep_[side]->simplex(s, v);
    if (rep_[side]->dim() == 2) v[2] = v[1];
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d& x = rep_[side]->vertices()[v[corner]];
      for (int axis = 0; axis < 3; ++axis) eights_[i / 8].corner[side][corner][axis][i % 8] = x[axis];
    }
  }

  /// Decides a pair in integers, and completes it. is_measured: the bounds exclude contact. Returns false if
  /// its distance exceeds `within`.
  bool decide(bool is_measured, NearPair& out) {
    ++pairs_exact_;
    const int dim = rep_[0]->dim();
    Eigen::Vector3d world[2][3];
    const double *of_a[3], *of_b[3];
    for (int side = 0; side < 2; ++side) {
      VertexId v[3] = {};
      rep_[side]->simplex(side == 0 ? out.a : out.b, v);
      for (int corner = 0; corner < dim; ++corner) {
        world[side][corner] = pose_[side]->apply(rep_[side]->vertices()[v[corner]]);
        (side == 0 ? of_a : of_b)[corner] = world[side][corner].data();
      }
    }
    if (!is_measured) {
      out.meet = dim == 3 ? exact::meet_triangles(of_a, of_b) : exact::meet_segments(of_a, of_b);
      if (out.meet != exact::Meet::disjoint) {
        // Both closest points are a corner of the intersection.
        const exact::PairContact contact =
            dim == 3 ? exact::contact_of_triangles(of_a, of_b) : exact::contact_of_segments(of_a, of_b);
        out.lower = out.upper = 0;
        out.point[0] = out.point[1] = contact.corners[0].x;
        return true;
      }
    }
    if (exact::compare_distance(of_a, of_b, dim, kernel_.within) > 0) return false;
    if (is_measured) {
      out.upper = kernel_.within;
      return true;
    }
    const exact::PairDistance exact = exact::distance_of_simplices(of_a, of_b, dim);
    out.lower = exact.lower;
    out.upper = std::min(exact.upper, kernel_.within);
    out.point[0] = exact.point[0];
    out.point[1] = exact.point[1];
    return true;
  }

  const LrbRep* rep_[2];
  const Pose* pose_[2];
  std::uint64_t pairs_exact_ = 0;
  PairBoundsKernel kernel_;
  EightPairsMeasured eights_[kEights];
};

/// Orders pairs by their lower bounds, then by their ids.
bool is_nearer(const NearPair& x, const NearPair& y) {
  return std::tie(x.lower, x.upper, x.a, x.b) < std::tie(y.lower, y.upper, y.a, y.b);
}

/// The search in the trees of two bodies whose poses are nearly rotations.
class NearPairsSearch {
 public:
  NearPairsSearch(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const NearPairsRequest& request, Workers& workers, NearPairsContext& context,
                  NearPairsResult& result)
      : a_(a),
        b_(b),
        pose_a_(pose_a),
        pose_b_(pose_b),
        request_(request),
        workers_(workers),
        context_(context),
        result_(result) {
    for (unsigned i = 0; i < workers.count(); ++i) meters_.emplace_back(a, pose_a, b, pose_b, request.within);
  }

  void run() {
    context_.candidates.clear();
    TreeKernel k = start();
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
    else if (!is_sorted_)
      std::sort(pairs.begin(), pairs.end(), by_ids);
  }

 private:
  /// Returns a kernel that keeps all pairs that are at most `within` apart in the world.
  TreeKernel start() {
    TreeKernel k = set_up_kernel(a_.tree(), pose_a_, b_.tree(), pose_b_);
    const std::size_t room = near_stack_room(a_.tree().height(), b_.tree().height());
    if (context_.stack.size() < room) context_.stack.resize(room);
    k.stack = context_.stack.data();
    start_at(k, {0, 0});
    context_.found.resize(kBuffered);
    k.out = context_.found.data();
    k.out_capacity = static_cast<std::uint32_t>(kBuffered);
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
    return k;
  }

  void traverse(TreeKernel& k) {
    while (!is_done(k)) {
      k.out_size = 0;
      run_near_kernel(k);
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
    is_sorted_ = result_.found == 0;
    const std::size_t chunks = (candidates.size() + kCandidatesOfChunk - 1) / kCandidatesOfChunk;
    const auto chunk = [&](std::size_t i) {
      const auto rest = std::span(candidates).subspan(i * kCandidatesOfChunk);
      return rest.first(std::min(rest.size(), kCandidatesOfChunk));
    };
    if (workers_.count() == 1 && request_.nearest == 0) {
      // Without a copy.
      for (std::size_t i = 0; i < chunks; ++i) {
        meters_[0].measure(chunk(i), result_.pairs);
        result_.found = result_.pairs.size();
        check_limit();
      }
      return candidates.clear();
    }
    // On one thread, one chunk at a time, so that pairs need little memory.
    const std::size_t at_once = workers_.count() == 1 ? 1 : chunks;
    std::vector<std::vector<NearPair>>& near = context_.near;
    if (near.size() < at_once) near.resize(at_once);
    for (std::size_t first = 0; first < chunks; first += at_once) {
      workers_.for_each(at_once, [&](std::size_t i, unsigned worker) {
        near[i].clear();
        meters_[worker].measure(chunk(first + i), near[i]);
      });
      for (std::size_t i = 0; i < at_once; ++i)
        for (const NearPair& pair : near[i]) add(pair);
    }
    candidates.clear();
  }

  void check_limit() const {
    const std::uint64_t limit = request_.max_pairs > 0 ? request_.max_pairs : kMaxPairs;
    if (result_.pairs.size() > limit)
      throw InputError("more than " + std::to_string(limit) +
                       " pairs of triangles are within the distance, the limit set by max_pairs; raise it "
                       "(--max-pairs), or ask for the nearest ones (--nearest)");
  }

  void add(const NearPair& pair) {
    ++result_.found;
    std::vector<NearPair>& pairs = result_.pairs;
    if (request_.nearest == 0) {
      pairs.push_back(pair);
      check_limit();
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
  NearPairsContext& context_;
  NearPairsResult& result_;
  std::vector<PairMeter> meters_;  ///< (threads)
  bool is_sorted_ = true;          ///< the pairs found so far are in order
};

}  // namespace

void check_request(const NearPairsRequest& request) {
  if (!(request.within >= 0) || std::isinf(request.within))
    throw InputError("near pairs: expected a finite distance `within` of at least 0, found " +
                     std::to_string(request.within));
}

void near_pairs_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const NearPairsRequest& request, Workers& workers, NearPairsContext& context,
                     NearPairsResult& result) {
  const FloatMode float_mode;
  check_query(a, pose_a, b, pose_b);
  check_request(request);
  result.pairs.clear();
  static_cast<NearPairsNumbers&>(result) = {};
  result.counters = {};
  if (a.tree().empty() || b.tree().empty()) return;
  if (rotation_defect(pose_a.r) <= kMaxDefect &&
      rotation_defect(pose_a.r.transpose() * pose_b.r) <= kMaxDefect) {
    NearPairsSearch(a, pose_a, b, pose_b, request, workers, context, result).run();
    return;
  }
  // Scaled or sheared bodies: the kernel has no margin for their poses.
  const LrbRep world_a = in_world(a, pose_a), world_b = in_world(b, pose_b);
  const Pose identity;
  NearPairsSearch(world_a, identity, world_b, identity, request, workers, context, result).run();
}

NearPairsResult near_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                           const NearPairsRequest& request, unsigned threads) {
  Workers workers(threads);
  NearPairsContext context;
  NearPairsResult result;
  near_pairs_into(a, pose_a, b, pose_b, request, workers, context, result);
  return result;
}

}  // namespace lrb

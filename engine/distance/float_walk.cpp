/// Runs the float kernel and measures the remaining pairs in double:
/// 1. Convert the bounds of the request to floats, rounded so that the kernel drops no relevant pair.
/// 2. Run the kernel. When it stops, grow its buffers, decide contact by the exact query, or report; then
///    resume.
/// 3. Measure the remaining pairs, closest first.
///
/// The cache of separating planes along a motion: passed to the kernel at each step, and cleared when the
/// relative rotation accumulated since the planes were stored, which weakens them, becomes too large.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/core/tolerances.hpp"
#include "engine/distance/distance_context.hpp"
#include "engine/distance/distance_kernel.hpp"

namespace lrb {

namespace {

/// Maximum number of cache slots. Smaller: pairs evict each other and are expanded again; larger: the cache
/// exceeds a processor's L2 cache.
constexpr std::size_t kMaxSlots = 4096;
/// Accumulated rotation of B at which all planes are cleared. Larger: the float sum has larger errors, and
/// planes separate less.
constexpr double kMaxTurned = 0.5;
constexpr FarNodes kNone = {~0U, ~0U, {0, 0, 0}, 0, 0};

/// Returns the Frobenius norm of the change of a map. kFloatUp covers its rounding, and that of sums.
double change(const double (&from)[3][4], const double (&to)[3][4]) {
  double square = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) square += std::pow(to[column][row] - from[column][row], 2);
  return std::sqrt(square);
}

}  // namespace

void FarPairs::lend(DistanceKernel& k, std::size_t node_pairs) {
  // A power of two, because the slot is the masked hash.
  nodes_.resize(std::bit_ceil(std::clamp<std::size_t>(node_pairs, 1, kMaxSlots)), kNone);
  // The length of the path of the relative rotation bounds its change since any earlier step.
  turned_ += change(m_, k.tree.m);
  // Too much rotation, or NaN. The first step, which starts from a zero map, is such a case.
  if (!(turned_ <= kMaxTurned)) {
    std::fill(nodes_.begin(), nodes_.end(), kNone);
    turned_ = 0;
  }
  for (int column = 0; column < 3; ++column) std::copy_n(k.tree.m[column], 4, m_[column]);
  k.far = nodes_.data();
  k.far_slots = static_cast<std::uint32_t>(nodes_.size());
  // One rounded up, the other down: their difference is never less than the true one.
  k.turned = rounded_up(turned_);
  k.min_turned = rounded_down(turned_);
}

namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Returns the approximate direction from A to B, in A's frame.
Eigen::Vector3d direction_of(const DistanceContext& context, const NearestPairs& found,
                             const TreeKernel& tree) {
  // If a pair was measured, the direction between its closest points, mapped to A's axes by the transpose.
  const Eigen::Vector3d towards = context.query.body[0].world.pose().r.transpose() * found.towards();
  if (towards.squaredNorm() > 0) return towards.normalized();
  // Otherwise the direction between the origins of the roots.
  Eigen::Vector3d between_centres;
  for (int i = 0; i < 3; ++i) {
    const double *a = tree.nodes_a[0].origin, *b = tree.nodes_b[0].origin;
    const double at_b = tree.m[0][i] * b[0] + tree.m[1][i] * b[1] + tree.m[2][i] * b[2];
    between_centres[i] = at_b * tree.ratio_b + tree.t[i] - a[i] * tree.ratio_a;
  }
  return between_centres.squaredNorm() > 0 ? Eigen::Vector3d(between_centres.normalized()) : between_centres;
}

}  // namespace

bool suits_floats(const TreeKernel& tree) {
  constexpr float kTooRough = 0x1p-10F;
  // The kernel supports rotations only; from a slack of kTooRough on, rounding outweighs the shapes.
  if (tree.affine != nullptr || !(tree.slack < kTooRough)) return false;
  for (int axis = 0; axis < 3; ++axis)
    // Too far apart to distinguish near sides from far ones. NaN is rejected as well.
    if (!(std::abs(tree.t[axis]) < kFarForFloats)) return false;
  return true;
}

FloatWalk::FloatWalk(DistanceContext& context, NearestPairs& found, const DistanceRequest& request,
                     const TreeKernel& tree, double unit, bool descend, FarPairs* far)
    : context_(context), found_(found), unit_(unit), k_{} {
  k_.tree = tree;
  k_.tree.max_node_pairs = request.max_steps > 0 ? request.max_steps : kNoLimit;
  // Rounded to the safe side: upper bounds up, tolerances and the distance at which to stop down.
  k_.upper = rounded_up(found.upper() / unit);
  k_.spare = rounded_down(request.tolerance / unit);
  k_.share = std::min(1.0F, rounded_down(request.relative_tolerance));
  k_.widest = request.within ? rounded_up(*request.within / unit) : kNothing;
  k_.enough = request.within ? rounded_down(*request.within / unit) : -1;
  k_.best_a = k_.best_b = kNull;
  // The first slab direction.
  const Eigen::Vector3d direction = direction_of(context, found, tree);
  for (int i = 0; i < 3; ++i) k_.direction[0][i] = static_cast<float>(direction[i]);
  k_.next_descent = descend ? 0 : kDescentAfter;
  begin_ends();
  // Coherent queries: planes that earlier steps cached.
  if (far != nullptr)
    far->lend(k_, context.query.body[0].tree().nodes().size() * context.query.body[1].tree().nodes().size());
  if (context.waiting.size() < 4 * kRoomForStep) context.waiting.resize(16 * kRoomForStep);
  if (context.near.size() < 4 * kRoomForStep) context.near.resize(16 * kRoomForStep);
  // Start with the pair of roots, whose bound is unknown.
  context.waiting[0] = {-kNothing, 0, 0, kNoEntry, {0, 0, 0}};
  k_.next = 0;
  k_.waiting_size = k_.waiting_end = 1;
  k_.unused = kNoEntry;
}

/// Allocates the projections of all nodes. Entries of other directions need not be cleared, because each
/// direction has its own number.
void FloatWalk::begin_ends() {
  constexpr std::uint32_t kLastTurn = 0xf0000000;
  // Before the numbers run out, start again with a cleared cache; 2^28 numbers remain for the current query.
  const bool begins_again = context_.turn > kLastTurn;
  if (begins_again) context_.turn = 0;
  for (int side = 0; side < 2; ++side) {
    std::vector<NodeEnd>& ends = context_.ends[side];
    if (begins_again) std::fill(ends.begin(), ends.end(), NodeEnd{0, 0});
    const std::size_t nodes = context_.query.body[side].tree().nodes().size();
    if (ends.size() < nodes) ends.resize(nodes);
    k_.ends[side] = ends.data();
  }
  k_.turn = context_.turn;
}

void FloatWalk::give_room() {
  // Doubling keeps the number of copies small; a kernel step needs kRoomForStep free entries.
  if (context_.waiting.size() - k_.waiting_size < kRoomForStep)
    context_.waiting.resize(2 * context_.waiting.size());
  context_.ready.resize(context_.waiting.size());
  if (context_.near.size() - k_.near_size < kRoomForStep) context_.near.resize(2 * context_.near.size());
  // Growth may have moved the buffers.
  k_.waiting = context_.waiting.data();
  k_.ready = context_.ready.data();
  k_.near = context_.near.data();
  k_.waiting_capacity = static_cast<std::uint32_t>(context_.waiting.size());
  k_.near_capacity = static_cast<std::uint32_t>(context_.near.size());
}

void FloatWalk::notify(BoundsProbeAdapter& adapter) const {
  // The least bound of all pairs that were dropped, wait, or will be measured.
  double lower = dropped();
  for (std::uint32_t i = 0; i < k_.near_size; ++i)
    lower = std::min(lower, static_cast<double>(k_.near[i].lower) * unit_);
  adapter.notify(k_.tree.node_pairs, lower, std::min(found_.upper(), static_cast<double>(k_.upper) * unit_));
}

bool FloatWalk::run(BoundsProbeAdapter* adapter) {
  // Without contact the kernel need not stop at ambiguous pairs.
  k_.apart = found_.known_apart();
  const std::uint64_t most = k_.tree.max_node_pairs;
  for (;;) {
    give_room();
    // With a probe, stop after a while to report.
    if (adapter != nullptr)
      k_.tree.max_node_pairs = std::min(most, BoundsProbeAdapter::next_look(k_.tree.node_pairs));
    run_distance_kernel(k_);
    context_.turn = k_.turn;
    if (k_.stop == KernelStop::undecided) {
      // Contact is possible: decide it once, and continue if the surfaces are disjoint.
      if (found_.surfaces_meet()) return true;
      k_.apart = true;
    } else if (k_.stop == KernelStop::limit && k_.tree.node_pairs < most) {
      // Stopped only to report: the real limit is not reached.
      notify(*adapter);
    } else if (k_.stop != KernelStop::room) {
      return k_.stop == KernelStop::done;
    }
  }
}

double FloatWalk::waiting_lower() const {
  // When the kernel is done, every waiting pair is beyond the pruning distance, which dropped() includes.
  if (k_.stop == KernelStop::done) return kNothing;
  float bound = kNothing;
  for (std::uint32_t i = 0; i < k_.waiting_end; ++i) bound = std::min(bound, k_.waiting[i].bound);
  // Bounds are squared distances; those of overlapping boxes are not positive.
  return bound > 0 ? std::sqrt(static_cast<double>(bound)) * (1 - kDistanceRounding) * unit_ : 0;
}

/// Returns a lower bound on the distances of all pairs that are not in `near`; world units.
double FloatWalk::dropped() const {
  return std::min(waiting_lower(), static_cast<double>(dropped_from(k_)) * unit_);
}

double FloatWalk::measure() {
  FloatPair* const end = context_.near.data() + k_.near_size;
  const float limit = dropped_from(k_);
  // The upper bound may have fallen since these pairs were collected: remove the ones beyond it.
  FloatPair* const last = std::partition(context_.near.data(), end,
                                         [limit](const FloatPair& pair) { return pair.lower <= limit; });
  k_.near_size = static_cast<std::uint32_t>(last - context_.near.data());
  // Closest first; ties by index, so that the order does not depend on the traversal.
  std::sort(context_.near.data(), last, [](const FloatPair& x, const FloatPair& y) {
    return x.lower != y.lower ? x.lower < y.lower : x.a != y.a ? x.a < y.a : x.b < y.b;
  });
  // The pair that gave the kernel's upper bound is measured first: it tightens the pruning distance.
  if (k_.best_a != kNull) found_.measure(k_.best_a, k_.best_b, 0);
  double rest = dropped();
  for (const FloatPair* pair = context_.near.data(); pair != last; ++pair) {
    const double lower = static_cast<double>(pair->lower) * unit_;
    // The pairs are sorted: all remaining ones are at least this far.
    if (lower >= found_.dropped_from()) return std::min(rest, lower);
    if (found_.is_near_enough()) return std::min(rest, lower);
    found_.measure(pair->a, pair->b, lower);
  }
  return rest;
}

void FloatWalk::count(DistanceCounters& counters) const {
  counters.steps += k_.tree.node_pairs;
  counters.box_tests += k_.tree.box_tests;
  counters.pairs_in_floats += k_.triangle_pairs;
}

}  // namespace lrb

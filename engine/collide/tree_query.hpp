#pragma once
/// The complete query: a dual traversal of the two OBB trees.
///
/// Completeness. Suppose that real simplices s of A and t of B intersect at a point of the world. In every
/// pair of tree nodes above them, the bounds of each node contain one of the two, so the bounds, grown by all
/// errors, overlap. The traversal drops a pair of nodes only if its bounds are proven disjoint, so by
/// induction it reaches the pair of leaves that contain s and t. There it drops the pair (s, t) only if boxes
/// or a plane are proven to separate the two; the remaining pairs are decided within proven bounds on float
/// errors, or exactly. The proof uses neither the nesting of regions nor their embedding: a poor LRB-rep can
/// cost time, but never a contact.
///
/// The errors that "proven disjoint" has to cover are listed in set_up_kernel() for rotations (for node OBBs
/// in kernel_whole.inl), and in kernel_setup.hpp for all other maps.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/collide/query_context.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/observe.hpp>

namespace lrb {

// Runs the tree kernel one pair of nodes at a time and reports the outcome of each to a probe. The kernel,
// the order of pairs and the outcomes are the same as in a query without a probe.

/// Returns the kernel's action for a pair of nodes whose own boxes overlap.
inline NodeStep step_of(const TreeKernel& k, const NodePair& pair) {
  const TreeNode &a = k.nodes_a[pair.a], &b = k.nodes_b[pair.b];
  const auto size = [&](const TreeNode& n, int side) {
    return n.radius * (k.affine != nullptr ? k.affine->span[side] : side == 0 ? k.ratio_a : k.ratio_b);
  };
  if (a.is_leaf && b.is_leaf) return NodeStep::leaves;
  const bool hold_a = a.is_leaf || size(b, 1) > kMuchLarger * size(a, 0);
  const bool hold_b = b.is_leaf || size(a, 0) > kMuchLarger * size(b, 1);
  if (!a.is_leaf && hold_b) return NodeStep::descend_a;
  return !b.is_leaf && hold_a ? NodeStep::descend_b : NodeStep::descend_both;
}

template <class Probe>
class NodeWatch {
 public:
  NodeWatch(QueryContext& ctx, Probe& probe)
      : probe_(probe),
        parents_(ctx.parents),
        rejected_(ctx.rejected),
        rejected_nodes_(ctx.rejected_nodes),
        all_(probe.level() == EventLevel::all) {
    rejected_.resize(kMaxPairs);
    rejected_nodes_.resize(ctx.stack.size());
  }

  /// Replaces run_tree_kernel(). May be called again, also on another NodeWatch, to continue.
  void run(TreeKernel& k) {
    const std::uint64_t most = k.max_node_pairs;
    if (k.node_pairs == 0) parents_.clear();
    k.rejected = all_ ? rejected_.data() : nullptr;
    k.rejected_nodes = rejected_nodes_.data();
    while (!is_done(k) && k.out_capacity - k.out_size >= kMaxPairs && k.node_pairs < most) {
      k.max_node_pairs = k.node_pairs + 1;
      step(k);
    }
    k.max_node_pairs = most;
  }

 private:
  static constexpr std::uint32_t kMaxPairs = kTreeWidth * kTreeWidth;

  void step(TreeKernel& k) {
    const std::uint32_t out_before = k.out_size;
    const std::uint64_t boxes_before = k.box_tests, pairs_before = k.prefilter_tests;
    k.rejected_size = k.rejected_nodes_size = 0;
    run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.rejected_nodes_size; ++i) report_rejected(k.rejected_nodes[i]);
    if (k.rejected_nodes_size != 0) return;
    const NodePair& pair = k.opened;
    NodeVisit visit{.a = pair.a, .b = pair.b, .parent = take_parent(pair), .step = step_of(k, pair)};
    visit.box_tests = static_cast<std::uint8_t>(k.box_tests - boxes_before);
    visit.met = static_cast<std::uint8_t>(k.stack_size - k.opened_at);
    if (visit.step == NodeStep::leaves) {
      const std::uint32_t left = k.out_size - out_before;
      visit.met = static_cast<std::uint8_t>(k.prefilter_tests - pairs_before);
      visit.rejected = static_cast<std::uint8_t>(visit.met - left);
      visit.certain = static_cast<std::uint8_t>(
          std::count_if(k.out + out_before, k.out + k.out_size, [](const Candidate& c) {
            return c.certainty == Certainty::cross || c.certainty == Certainty::disjoint;
          }));
    }
    const std::uint32_t reported = probe_.node_pair(visit);
    for (std::uint32_t i = k.opened_at; i < k.stack_size; ++i) parents_.emplace(key_of(k.stack[i]), reported);
    for (std::uint32_t i = 0; i < k.rejected_size; ++i)
      probe_.plane_test(k.rejected[i].a, k.rejected[i].b, k.rejected[i].whose);
  }

  void report_rejected(const NodePair& pair) {
    probe_.node_pair(
        {.a = pair.a, .b = pair.b, .parent = take_parent(pair), .step = NodeStep::whole, .box_tests = 1});
  }

  static std::uint64_t key_of(const NodePair& pair) { return std::uint64_t{pair.a} << 32 | pair.b; }

  /// Returns the probe's value for the parent pair, or kNull without one, and erases it: each pair is visited
  /// once.
  std::uint32_t take_parent(const NodePair& pair) {
    const auto found = parents_.extract(key_of(pair));
    return found.empty() ? kNull : found.mapped();
  }

  Probe& probe_;
  std::unordered_map<std::uint64_t, std::uint32_t>& parents_;  ///< of waiting pairs: see take_parent()
  std::vector<RejectedPair>& rejected_;
  std::vector<NodePair>& rejected_nodes_;
  bool all_;
};

/// Sets up a kernel for two bodies' own trees.
inline TreeKernel set_up_kernel(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  return set_up_kernel(a.tree(), pose_a, b.tree(), pose_b);
}

template <class Probe>
[[gnu::noinline]] void open_regions_from(QueryContext& ctx, Side side, CellId innermost,
                                         CollideResult& result, Probe& probe) {
  Wrapper& wrapper = *ctx[side].wrapper;
  const std::size_t before = wrapper.excluded().size();
  result.counters.refinements += wrapper.refine_path(innermost);
  if constexpr (Probe::kEnabled)
    for (const RegionId r : std::span(wrapper.excluded()).subspan(before))
      probe.refine(side, r, static_cast<std::uint32_t>(wrapper.rep().floor(r).size()));
}

/// Returns a kernel at the roots of the queried trees, at the bodies' poses. Uses the context's buffers, with
/// capacity for `capacity` candidates.
TreeKernel start_kernel(QueryContext& ctx, std::size_t capacity);
/// Returns such a kernel at other poses, set up by set_up_kernel() even if they are not rotations.
TreeKernel start_rigid_kernel(QueryContext& ctx, const Pose& pose_a, const Pose& pose_b,
                              std::size_t capacity);

/// Refines the wrapper of a body until a face is on its boundary: refines the regions that hide it, from the
/// outside inward. Usually the face is on the boundary already. Returns the number of regions between the
/// face and the outside.
template <class Probe>
inline std::uint32_t show_face(QueryContext& ctx, Side side, FaceId f, CollideResult& result, Probe& probe) {
  const LrbRep& rep = ctx[side].rep();
  const CellId outer = rep.outer_cell(f);
  if (!is_region(outer)) return 0;
  if (ctx[side].wrapper->included(outer)) open_regions_from(ctx, side, outer, result, probe);
  return rep.depth(outer.as_region());
}

/// The rules of the exact query; coarse_query.hpp defines others.
struct ExactRules {
  static constexpr bool kLimited = false;   ///< may stop before the answer is complete
  static constexpr bool kWrappers = false;  ///< the queried trees are wrappers that enclose the bodies
  static constexpr bool kTrial = false;     ///< may give up after a crossing pair
};

/// Counts a query that ends at the roots (roots_are_apart()): one test of their bounds.
inline void count_roots_apart(Counters& counters) {
  ++counters.node_pairs;
  ++counters.box_tests;
}

/// Returns 1 if two points are equal bit by bit, else 0. Points that differ only in the sign of a zero are
/// left to the exact test.
inline unsigned has_bits_of(const double* x, const double* y) {
  std::uint64_t difference = 0;
  for (int i = 0; i < 3; ++i)
    difference |= std::bit_cast<std::uint64_t>(x[i]) ^ std::bit_cast<std::uint64_t>(y[i]);
  return difference == 0;
}

// World: WorldVertices or CornersAtPose.

/// Returns true if the candidate's marked corners are also corners of the other simplex. Compares each with
/// all three without branches, because the match cannot be predicted.
template <class World>
bool shares_corners(const Candidate& c, World& a, World& b) {
  const double *own[3], *others[3];
  a.corners(c.a, c.side == Side::a ? own : others);
  b.corners(c.b, c.side == Side::a ? others : own);
  unsigned shared = 1;
  for (unsigned left = c.corners; left != 0; left &= left - 1) {
    const double* const corner = own[std::countr_zero(left)];
    shared &=
        has_bits_of(corner, others[0]) | has_bits_of(corner, others[1]) | has_bits_of(corner, others[2]);
  }
  return shared != 0;
}

/// Returns the Meet of a candidate. The kernel has decided most: then no corner is transformed to the world.
/// `exactly`: 3D, and floats may not decide alone. Inlined in each caller: as a call it makes queries in
/// contact 6 % slower (instructions; tests/guard).
template <class World>
[[gnu::always_inline]] inline exact::Meet meet_of(const Candidate& c, World& a, World& b, int dim,
                                                  bool exactly) {
  if (c.certainty == Certainty::cross) return exact::Meet::cross;
  if (c.certainty == Certainty::disjoint) return exact::Meet::disjoint;
  if (c.certainty == Certainty::touch_if_shared && exactly && shares_corners(c, a, b))
    return exact::Meet::touch;
  return test_simplices(a, b, dim, c.a, c.b);
}

// A query in deep contact is split once: after kNodePairsBeforeSplit pairs of nodes, each pair that waits is
// traversed on its own, with everything below it, the last one first. The order of the candidates, in which
// regions are opened, is therefore the same on any number of threads.

/// About two pairs of nodes are visited for each pair of simplices that intersects.
inline constexpr std::uint64_t kNodePairsBeforeSplit = 2048;

/// Moves the kernel's pairs of nodes to `waiting`.
inline void split(TreeKernel& k, std::vector<NodePair>& waiting) {
  waiting.insert(waiting.end(), k.stack, k.stack + k.stack_size);
  waiting.insert(waiting.end(), k.tested, k.tested + k.tested_size);
  k.stack_size = k.tested_size = 0;
}

/// If the kernel is done, starts it at the next waiting pair. Returns false if there is none.
inline bool go_on(TreeKernel& k, std::vector<NodePair>& waiting) {
  if (!is_done(k)) return true;
  if (waiting.empty()) return false;
  start_at(k, waiting.back());
  waiting.pop_back();
  return true;
}

/// A candidate with its Meet.
struct TestedPair {
  SimplexId a, b;
  exact::Meet meet;
};

/// The candidates below one pair of nodes, and the work that was done to find and test them.
struct TestedPart {
  std::vector<TestedPair> pairs;
  std::uint64_t node_pairs = 0, box_tests = 0, prefilter_tests = 0, exact_fallbacks = 0;
};

/// Finds and tests the candidates below some pairs of nodes on the context's threads. `k`: a kernel of this
/// query. Throws InputError if more than `pair_limit` pairs intersect, with the `found` ones.
std::vector<TestedPart> test_parts(const QueryContext& ctx, const TreeKernel& k,
                                   std::span<const NodePair> parts, std::uint64_t found,
                                   std::uint64_t pair_limit);

template <class Probe, class Rules = ExactRules>
class TreeQuery {
 public:
  TreeQuery(QueryContext& ctx, const CollideRequest& request, CollideResult& result, Probe& probe,
            Rules rules = {})
      : ctx_(ctx),
        mode_(request.mode),
        pair_limit_(request.pair_limit()),
        result_(result),
        probe_(probe),
        rules_(rules) {}

  const Rules& rules() const { return rules_; }
  /// Returns true if run() has proven the bounds of the roots disjoint, so that neither body is inside the
  /// other.
  bool ends_at_roots() const { return ends_at_roots_; }

  /// `may_end_at_roots`: false if roots_are_apart() has returned false.
  void run(bool may_end_at_roots = true) {
    const ObbTree &a = ctx_[Side::a].tree(), &b = ctx_[Side::b].tree();
    if (a.empty() || b.empty()) return;
    if (!reports_details(probe_)) {
      walk(may_end_at_roots);
      return;
    }
    probe_.begin(Phase::walk, ctx_[Side::a].walked(), ctx_[Side::b].walked());
    probe_.end(Phase::walk, walk(may_end_at_roots));
  }

 private:
  /// Traverses the trees. Returns the number of node pairs.
  std::uint64_t walk(bool may_end_at_roots) {
    if (!Rules::kWrappers && may_end_at_roots)
      if (const QueryBody& a = ctx_[Side::a], &b = ctx_[Side::b];
          roots_are_apart(a.tree(), a.world.pose(), b.tree(), b.world.pose())) {
        ends_at_roots_ = true;
        count_roots_apart(result_.counters);
        if (reports_details(probe_))
          probe_.node_pair({.a = 0, .b = 0, .parent = kNull, .step = NodeStep::whole, .box_tests = 1});
        return 1;
      }
    // Use a small buffer if one pair may be enough, so that the traversal does not run far beyond it.
    const bool one_may_do = Rules::kTrial || mode_ != Mode::all_pairs;
    TreeKernel k = start_kernel(ctx_, one_may_do ? 64 : 1024);
    k.nearest_first = one_may_do;
    if constexpr (Rules::kWrappers) allow_for_wrappers(k);
    bool done = false;
    bool splits = kSplits && !one_may_do;
    if (splits) k.max_node_pairs = kNodePairsBeforeSplit;
    ctx_.waiting.clear();
    while (!done && go_on(k, ctx_.waiting)) {
      k.out_size = 0;
      if constexpr (Rules::kLimited) k.max_node_pairs = rules_.max_node_pairs(k.node_pairs);
      reports_details(probe_) ? NodeWatch<Probe>(ctx_, probe_).run(k) : run_tree_kernel(k);
      if constexpr (Rules::kLimited) done = rules_.time_is_up(result_.pairs.size());
      if constexpr (Rules::kTrial) rules_.came_to(k.node_pairs, k.stack_size + k.tested_size);
      for (std::uint32_t i = 0; i < k.out_size && !done; ++i) done = test(k.out[i]);
      const bool too_many = result_.pairs.size() > pair_limit_;
      if constexpr (Rules::kTrial)
        if (rules_.gives_up(too_many)) break;
      if (too_many) reject_pairs(pair_limit_);
      if (!splits || k.node_pairs < k.max_node_pairs) continue;
      splits = false;
      k.max_node_pairs = kNoLimit;
      split(k, ctx_.waiting);
      if (!Probe::kEnabled && ctx_.has_threads() && ctx_.waiting.size() > 1) {
        test_together(k, ctx_.waiting);
        ctx_.waiting.clear();
      }
    }
    // If the roots' own boxes had overlapped, their children's boxes would have been tested.
    ends_at_roots_ = k.box_tests == 1 && !(k.nodes_a[0].is_leaf && k.nodes_b[0].is_leaf);
    result_.counters.node_pairs += k.node_pairs;
    result_.counters.box_tests += k.box_tests;
    result_.counters.prefilter_tests += k.prefilter_tests;
    return k.node_pairs;
  }

  /// Tests what is below some pairs of nodes on several threads, as walk() would test it afterwards.
  void test_together(TreeKernel& k, std::span<const NodePair> parts) {
    const std::uint64_t fallbacks = exact::exact_fallbacks();
    std::vector<TestedPart> tested = test_parts(ctx_, k, parts, result_.pairs.size(), pair_limit_);
    // Those of this thread are counted by the query and by the parts.
    result_.counters.exact_fallbacks -= exact::exact_fallbacks() - fallbacks;
    // The last pair that waits is next.
    for (auto part = tested.rbegin(); part != tested.rend(); ++part) {
      for (const TestedPair& p : part->pairs) {
        show_and_count(p.a, p.b);
        if (p.meet != exact::Meet::disjoint) record_pair(result_, probe_, p.a, p.b, p.meet);
      }
      part->pairs = std::vector<TestedPair>();  // frees the memory
      k.node_pairs += part->node_pairs;
      k.box_tests += part->box_tests;
      k.prefilter_tests += part->prefilter_tests;
      result_.counters.exact_fallbacks += part->exact_fallbacks;
    }
  }

  /// Refines the wrappers until both faces of a test are on their boundaries, and counts the test. Returns
  /// the faces' depths, as show_face().
  std::pair<std::uint32_t, std::uint32_t> show_and_count(SimplexId a, SimplexId b) {
    const LrbRep &rep_a = ctx_[Side::a].rep(), &rep_b = ctx_[Side::b].rep();
    const FaceId fa = rep_a.face_of_simplex(a), fb = rep_b.face_of_simplex(b);
    const std::uint32_t depth_a = show_face(ctx_, Side::a, fa, result_, probe_);
    const std::uint32_t depth_b = show_face(ctx_, Side::b, fb, result_, probe_);
    count_face_test(rep_a.is_real(fa) && rep_b.is_real(fb), std::max(depth_a, depth_b), result_.counters);
    return {depth_a, depth_b};
  }

  /// Tests a candidate. Returns true if the answer is complete. One pair is enough in any_pair mode, and in
  /// first_pair mode if it crosses. In first_pair mode a touching pair is kept while the search for a
  /// crossing one continues, so that the relation is exact in that mode as well.
  bool test(const Candidate& c) {
    if constexpr (Rules::kLimited)
      if (rules_.no_test_left(result_.counters.face_tests, c.certainty != Certainty::none,
                              result_.pairs.size()))
        return true;
    const auto [depth_a, depth_b] = show_and_count(c.a, c.b);
    const std::uint64_t fallbacks = reports_details(probe_) ? exact::exact_fallbacks() : 0;
    exact::Meet meet = meet_of(c);
    if constexpr (Rules::kWrappers)
      if (meet == exact::Meet::disjoint && c.certainty != Certainty::disjoint)
        meet = rules_.meet_of_near(ctx_, c.a, c.b);
    if constexpr (Probe::kEnabled) {
      probe_.face_test(c.a, c.b, meet, depth_a, depth_b);
      if (reports_details(probe_)) probe_.tested_by(tested_by(c, fallbacks));
    }
    if (meet == exact::Meet::disjoint) return false;
    if (mode_ == Mode::first_pair && !result_.pairs.empty()) {
      if (meet != exact::Meet::cross) return false;
      result_.pairs.clear();
      result_.meets.clear();
    }
    record_pair(result_, probe_, c.a, c.b, meet);
    if constexpr (Rules::kWrappers)
      if (mode_ != Mode::all_pairs) return true;
    if constexpr (Rules::kTrial)
      if (mode_ == Mode::all_pairs && meet == exact::Meet::cross && rules_.crossed()) return true;
    return mode_ == Mode::any_pair || (mode_ == Mode::first_pair && meet == exact::Meet::cross);
  }

  exact::Meet meet_of(const Candidate& c) {
    return lrb::meet_of(c, ctx_[Side::a].world, ctx_[Side::b].world, ctx_[Side::a].rep().dim(), exactly_);
  }

  /// Returns the method that decided a candidate. fallbacks: exact::exact_fallbacks() before the test.
  TestedBy tested_by(const Candidate& c, std::uint64_t fallbacks) {
    if (c.certainty == Certainty::cross || c.certainty == Certainty::disjoint) return TestedBy::floats;
    if (exact::exact_fallbacks() != fallbacks) return TestedBy::expansions;
    const bool shares = c.certainty == Certainty::touch_if_shared && exactly_ &&
                        shares_corners(c, ctx_[Side::a].world, ctx_[Side::b].world);
    return shares ? TestedBy::shared_corners : TestedBy::filter;
  }

  /// Queries without limits for all pairs are split.
  static constexpr bool kSplits = !Rules::kLimited && !Rules::kWrappers && !Rules::kTrial;

  QueryContext& ctx_;
  Mode mode_;
  std::uint64_t pair_limit_;
  CollideResult& result_;
  Probe& probe_;
  Rules rules_;
  bool ends_at_roots_ = false;
  const bool exactly_ = ctx_[Side::a].rep().dim() == 3 && !exact::only_floating();
};

}  // namespace lrb

#include "engine/collide/tree_query.hpp"

#include <atomic>
#include <memory>

namespace lrb {

namespace {

void give_buffers(QueryContext& ctx, std::size_t capacity, TreeKernel& k) {
  start_at_roots(k, ctx[Side::a].tree(), ctx[Side::b].tree(), ctx.stack);
  // Buffers only grow: later queries of the same size allocate nothing.
  if (ctx.candidates.size() < capacity) ctx.candidates.resize(capacity);
  k.out = ctx.candidates.data();
  k.out_capacity = static_cast<std::uint32_t>(capacity);
}

}  // namespace

TreeKernel start_kernel(QueryContext& ctx, std::size_t capacity) {
  const QueryBody &a = ctx[Side::a], &b = ctx[Side::b];
  TreeKernel k =
      set_up_any_kernel(a.tree(), a.world.pose(), b.tree(), b.world.pose(), a.rep().dim(), ctx.affine);
  give_buffers(ctx, capacity, k);
  return k;
}

TreeKernel start_rigid_kernel(QueryContext& ctx, const Pose& pose_a, const Pose& pose_b,
                              std::size_t capacity) {
  TreeKernel k = set_up_kernel(ctx[Side::a].tree(), pose_a, ctx[Side::b].tree(), pose_b);
  give_buffers(ctx, capacity, k);
  return k;
}

namespace {

/// Traverses the parts of a query that a thread is given.
class PartTester {
 public:
  PartTester(const QueryContext& ctx, const TreeKernel& k, std::size_t room, bool only_floating)
      : kernel_(k),
        stack_(room),
        found_(1024),
        a_(ctx.body[0].world),
        b_(ctx.body[1].world),
        dim_(ctx.body[0].rep().dim()),
        only_floating_(only_floating) {}

  /// Adds the number of intersecting pairs to `intersecting`.
  TestedPart test(const NodePair& from, std::atomic<std::uint64_t>& intersecting, std::uint64_t pair_limit) {
    const exact::FloatingPredicates floating(only_floating_);
    const std::uint64_t fallbacks = exact::exact_fallbacks();
    // Two stacks, as start_at_roots() allocates them.
    kernel_.stack = stack_.data();
    kernel_.tested = kernel_.stack + stack_.size() / 2;
    kernel_.out = found_.data();
    kernel_.out_capacity = static_cast<std::uint32_t>(found_.size());
    kernel_.max_node_pairs = kNoLimit;
    kernel_.node_pairs = kernel_.box_tests = kernel_.prefilter_tests = 0;
    start_at(kernel_, from);
    TestedPart part;
    while (!is_done(kernel_)) {
      kernel_.out_size = 0;
      run_tree_kernel(kernel_);
      std::uint64_t met = 0;
      for (const Candidate& c : std::span(found_).first(kernel_.out_size)) {
        const exact::Meet meet = meet_of(c, a_, b_, dim_, dim_ == 3 && !only_floating_);
        met += meet != exact::Meet::disjoint;
        part.pairs.push_back({c.a, c.b, meet});
      }
      if (met > 0 && intersecting.fetch_add(met) + met > pair_limit) reject_pairs(pair_limit);
    }
    part.node_pairs = kernel_.node_pairs;
    part.box_tests = kernel_.box_tests;
    part.prefilter_tests = kernel_.prefilter_tests;
    part.exact_fallbacks = exact::exact_fallbacks() - fallbacks;
    return part;
  }

 private:
  TreeKernel kernel_;
  std::vector<NodePair> stack_;
  std::vector<Candidate> found_;
  CornersAtPose a_, b_;
  int dim_;
  bool only_floating_;
};

}  // namespace

std::vector<TestedPart> test_parts(const QueryContext& ctx, const TreeKernel& k,
                                   std::span<const NodePair> parts, std::uint64_t found,
                                   std::uint64_t pair_limit) {
  std::vector<TestedPart> tested(parts.size());
  // Each thread makes its memory when it gets its first part.
  std::vector<std::unique_ptr<PartTester>> testers(ctx.workers->count());
  const bool only_floating = exact::only_floating();
  std::atomic<std::uint64_t> intersecting = found;
  ctx.workers->for_each(parts.size(), [&](std::size_t i, unsigned worker) {
    auto& tester = testers[worker];
    if (!tester) tester = std::make_unique<PartTester>(ctx, k, ctx.stack.size(), only_floating);
    tested[i] = tester->test(parts[i], intersecting, pair_limit);
  });
  return tested;
}

}  // namespace lrb

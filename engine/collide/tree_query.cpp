#include "engine/collide/tree_query.hpp"

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

}  // namespace lrb

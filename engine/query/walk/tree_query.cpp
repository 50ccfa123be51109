#include "engine/query/walk/tree_query.hpp"

namespace lrb {

namespace {

void give_buffers(QueryContext& ctx, std::size_t capacity, TreeKernel& k) {
  const ObbTree &a = ctx[Side::a].tree(), &b = ctx[Side::b].tree();
  const std::size_t deepest = 64 * (a.height() + b.height()) + 64;
  if (ctx.stack.size() < deepest) ctx.stack.resize(deepest);
  if (ctx.candidates.size() < capacity) ctx.candidates.resize(capacity);
  k.stack = ctx.stack.data();
  k.stack[0] = {0, 0};
  k.stack_size = 1;
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

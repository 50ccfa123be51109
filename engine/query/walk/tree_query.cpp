#include "engine/query/walk/tree_query.hpp"

namespace lrb {

TreeKernel start_kernel(QueryContext& ctx, const Pose& pose_a, const Pose& pose_b, std::size_t capacity) {
  const ObbTree &a = ctx[Side::a].tree(), &b = ctx[Side::b].tree();
  TreeKernel k = set_up_kernel(a, pose_a, b, pose_b);
  ctx.stack.resize(64 * (a.height() + b.height()) + 64);
  if (ctx.candidates.size() < capacity) ctx.candidates.resize(capacity);
  k.stack = ctx.stack.data();
  k.stack[0] = {0, 0};
  k.stack_size = 1;
  k.out = ctx.candidates.data();
  k.out_capacity = static_cast<std::uint32_t>(capacity);
  return k;
}

}  // namespace lrb

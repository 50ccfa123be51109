#include "engine/distance/distance_kernel.hpp"

#include "engine/distance/near_kernel.hpp"
#include "engine/tree/kernel_choice.hpp"

namespace lrb {

LRB_KERNEL(run_distance_kernel, DistanceKernel&)
LRB_KERNEL(run_near_kernel, TreeKernel&)
LRB_KERNEL(run_pair_bounds_kernel, const PairBoundsKernel&)

}  // namespace lrb

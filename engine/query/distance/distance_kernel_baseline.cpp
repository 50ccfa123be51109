#define LRB_DISTANCE_KERNEL_NAME run_distance_kernel_baseline
#include "engine/query/distance/distance_kernel.inl"

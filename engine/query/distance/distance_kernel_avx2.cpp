#define LRB_DISTANCE_KERNEL_NAME run_distance_kernel_avx2
#include "engine/query/distance/distance_kernel.inl"

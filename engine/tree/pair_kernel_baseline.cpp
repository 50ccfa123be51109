#define LRB_PAIR_KERNEL_NAME run_pair_kernel_baseline
#include "engine/tree/pair_kernel.inl"

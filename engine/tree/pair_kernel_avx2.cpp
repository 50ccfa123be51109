#define LRB_PAIR_KERNEL_NAME run_pair_kernel_avx2
#include "engine/tree/pair_kernel.inl"

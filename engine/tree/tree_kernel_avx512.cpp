#define LRB_KERNEL_NAME run_tree_kernel_avx512
#include "engine/tree/tree_kernel.inl"

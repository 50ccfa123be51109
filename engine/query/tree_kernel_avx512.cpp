#define LRB_KERNEL_NAME run_tree_kernel_avx512
#include "engine/query/tree_kernel.inl"

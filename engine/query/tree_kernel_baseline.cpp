#define LRB_KERNEL_NAME run_tree_kernel_baseline
#include "engine/query/tree_kernel.inl"

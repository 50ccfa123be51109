#define LRB_KERNEL_NAME run_tree_kernel_baseline
#include "engine/tree/tree_kernel.inl"

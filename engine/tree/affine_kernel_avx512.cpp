#define LRB_AFFINE_KERNEL_NAME run_affine_kernel_avx512
#include "engine/tree/affine_kernel.inl"

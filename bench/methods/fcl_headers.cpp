// FCL again, with its templates instantiated here: see fcl_instantiated.hpp.
#define LRB_FCL_HEADERS
#include "bench/methods/fcl.cpp"

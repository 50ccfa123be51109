// FCL again, with every template of its library instantiated here. FCL declares them as `extern template`, so
// that users of its headers run the packaged code, compiled for any x86-64; without that keyword the
// declarations are instantiations. Headers that FCL includes from elsewhere are included first, because the
// keyword must stay there.

#ifdef LRB_HAS_FCL

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <Eigen/StdVector>
#include <bits/stdc++.h>  // all of the standard library
#include <ccd/ccd.h>
#include <ccd/quat.h>
#include <ccd/vec3.h>
#include <fcl/config.h>
#include <unsupported/Eigen/AutoDiff>
#if FCL_HAVE_OCTOMAP
#include <octomap/OcTree.h>
#include <octomap/octomap.h>
#endif
#include <fcl/narrowphase/detail/convexity_based_algorithm/alloc.h>
#include <fcl/narrowphase/detail/convexity_based_algorithm/list.h>
#include <fcl/narrowphase/detail/convexity_based_algorithm/polytope.h>
#include <fcl/narrowphase/detail/convexity_based_algorithm/simplex.h>
#include <fcl/narrowphase/detail/convexity_based_algorithm/support.h>

#define extern
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#undef extern

#endif

#define LRB_FCL_HEADERS
#include "bench/methods/fcl.cpp"

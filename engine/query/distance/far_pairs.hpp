#pragma once
/// Planes that separate pairs of nodes, kept from step to step of a motion.

#include <cstddef>
#include <vector>

#include "engine/query/distance/distance_kernel.hpp"

namespace lrb {

class FarPairs {
 public:
  /// Lends the cache to the kernel for one step. k.tree: of the same trees at each step. node_pairs: the
  /// number of pairs of nodes of both trees.
  void lend(DistanceKernel& k, std::size_t node_pairs);

 private:
  std::vector<FarNodes> nodes_;
  double m_[3][4] = {};  ///< TreeKernel::m of the last step; 0 before the first, which counts as a large turn
  double turned_ = 0;    ///< the norms of its changes since planes were last forgotten, added up
};

}  // namespace lrb

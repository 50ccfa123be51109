#pragma once
/// What a motion keeps from step to step: planes that hold pairs of nodes apart.

#include <cstddef>
#include <vector>

#include "engine/query/distance/distance_kernel.hpp"

namespace lrb {

class FarPairs {
 public:
  /// Lets the walk of a step use what is kept, and add to it. k.tree: of the same trees at each step.
  /// node_pairs: of the two trees.
  void lend(DistanceKernel& k, std::size_t node_pairs);

 private:
  std::vector<FarNodes> nodes_;
  double m_[3][4] = {};  ///< TreeKernel::m of the last step; 0 before the first, which counts as a large turn
  double turned_ = 0;    ///< the norms of its changes since planes were last forgotten, added up
};

}  // namespace lrb

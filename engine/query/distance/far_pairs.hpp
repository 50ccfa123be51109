#pragma once
/// What a motion keeps from step to step: planes that hold pairs of nodes apart.

#include <vector>

#include "engine/query/distance/distance_kernel.hpp"

namespace lrb {

class FarPairs {
 public:
  /// Lets the walk of a step use what is kept, and add to it. k.tree: of the same trees at each step.
  void lend(DistanceKernel& k);

 private:
  std::vector<FarNodes> nodes_;
  double m_[3][4] = {};  ///< TreeKernel::m of the last step
  double turned_ = 0;    ///< by how much it changed since the first
};

}  // namespace lrb

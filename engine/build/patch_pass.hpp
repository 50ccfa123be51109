#pragma once
/// One pass: patches all over the hull, and a cap on each.

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "engine/build/body_bounds.hpp"
#include "engine/build/complex_builder.hpp"
#include "engine/build/embed_check.hpp"
#include "engine/build/hull_mesh.hpp"
#include "engine/build/patch_cap.hpp"
#include "engine/build/patch_grow.hpp"
#include "engine/build/random.hpp"
#include "engine/build/slot_tree.hpp"

namespace lrb {

class PatchPass {
 public:
  /// `frozen` (|real faces|): not to be covered. `component_boxes`: of the hull's components, or of parts of
  /// them that tell whether the component is somewhere as a whole.
  PatchPass(HullMesh& hull, ComplexBuilder& complex, const BodyBounds& bounds,
            const std::vector<bool>& frozen, const std::vector<Eigen::AlignedBox3d>& component_boxes);

  /// Covers what it can with regions of this layer, seeds in random order. `worth`: largest share of the
  /// triangles it covers that a cap may have.
  void run(const GrowLimits& limits, double worth, std::uint16_t layer, Random& random);

 private:
  bool make_cap(const Patch& patch, double worth);

  HullMesh& hull_;
  ComplexBuilder& complex_;
  const std::vector<bool>& frozen_;
  SlotTree tree_;
  EmbedCheck check_;
  CapSurface cap_;
  PatchCap collapse_;
};

}  // namespace lrb

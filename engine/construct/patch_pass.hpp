#pragma once
/// One pass: covers the front with patches, and each patch with a cap.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/builders.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/embed_check.hpp"
#include "engine/construct/front_mesh.hpp"
#include "engine/construct/front_update.hpp"
#include "engine/construct/half_spaces.hpp"
#include "engine/construct/patch_cap.hpp"
#include "engine/construct/patch_grow.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/core/random.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb::construct {

/// The result is the same as processing one seed after the other: grow its patch, make its cap, apply the cap
/// to the front.
///
/// Several threads do this in batches. Patches grow in order until one reaches a vertex of an earlier patch
/// of the batch; that one begins the next batch. So neither a patch of a batch, nor any triangle that its
/// growth read, has a vertex in common with another. All caps are then made at once, on the unchanged front,
/// and applied in order. A cap whose proof read a part of space in which an earlier cap of the batch changed
/// the front is made again first.
class PatchPass {
 public:
  /// `frozen` (|real faces|): faces that must not be covered. `component_boxes`: boxes of the front's
  /// components, or of parts of them that determine where the component is. `tree`: over the front; kept up
  /// to date. `probe`: null, or notified of patches, caps and regions.
  PatchPass(FrontMesh& front, AabbTree& tree, ComplexBuilder& complex, const BodyBounds& bounds,
            const std::vector<bool>& frozen, const std::vector<Eigen::AlignedBox3d>& component_boxes,
            Workers& workers, ConstructProbe* probe);

  /// Covers the front with regions of this layer where possible, taking seeds in random order. `worth`: most
  /// faces of a cap relative to those that it covers. Returns statistics.
  PassEnd run(const GrowLimits& limits, double worth, std::uint16_t layer, Random& random);

 private:
  /// The buffers that one worker needs to make caps.
  struct Bench {
    Bench(const FrontMesh& front, const AabbTree& tree, const BodyBounds& bounds,
          const std::vector<Eigen::AlignedBox3d>& component_boxes)
        : check(front, tree), collapse(cap, bounds) {
      check.set_component_boxes(component_boxes);
    }
    CapSurface cap;
    EmbedCheck check;
    PatchCap collapse;
  };
  struct Job {
    Patch patch;
    std::uint32_t no_patch = 0;  ///< earlier vertices at which no patch could be grown
    std::array<TriedCap, 2> tried;
    std::size_t tries = 0;
    bool has_cap = false;
    Sheet sheet;               ///< the cap, if has_cap
    Eigen::AlignedBox3d seen;  ///< space in which the front was read
  };

  void grow_batch(PatchGrower& grower);
  void make_cap(Job& job, double worth, Bench& bench) const;
  void find_cap(Job& job, double worth, Bench& bench) const;
  CapVerdict simplify(const Patch& patch, double worth, Bench& bench, bool careful) const;
  std::uint32_t bar_faces(PatchGrower& grower) const;
  std::vector<FrontMesh::Corner> find_seeds(Random& random) const;
  void notify(const Job& job) const;
  void put_on(const Job& job, std::uint16_t layer, PatchGrower& grower);

  FrontMesh& front_;
  ComplexBuilder& complex_;
  const std::vector<bool>& frozen_;
  Workers& workers_;
  AabbTree& tree_;
  ConstructProbe* probe_;
  std::vector<std::unique_ptr<Bench>> benches_;  ///< one for each worker
  std::vector<FrontMesh::Corner> seeds_;
  std::size_t next_seed_ = 0;
  std::vector<bool> tried_;  ///< (points at the start)
  std::vector<Job> jobs_;
  std::size_t batch_ = 0;       ///< number of jobs_ in use
  std::uint32_t no_patch_ = 0;  ///< vertices at which no patch could be grown since the last job
  std::vector<Eigen::AlignedBox3d> changed_;  ///< space in which the batch has changed the front so far
};

}  // namespace lrb::construct

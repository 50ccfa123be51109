#pragma once
/// Contact manifolds: their points, corners of the overlay of two patches, reduced to at most 4; and the
/// query with buffers that later queries reuse. Internal: users of the installed engine include
/// contact_manifold.hpp.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/collide/query_context.hpp"
#include "engine/distance/near_pairs_context.hpp"
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb {

/// The real simplices around each vertex. Vertices with equal coordinates, as along texture seams, count as
/// the first of them.
class VertexStars {
 public:
  /// Prepares a body; returns at once if it is the same as before.
  void begin(const LrbRep& rep);
  /// Returns the vertex that stands for all vertices at the location of v.
  VertexId at(VertexId v) const { return place_[v]; }
  /// Returns the simplices around a vertex returned by at(), ascending.
  std::span<const SimplexId> around(VertexId v) const {
    return {simplices_.data() + offsets_[v], offsets_[v + 1] - offsets_[v]};
  }
  /// Returns the diagonal of the body's box, mesh units.
  double diagonal() const { return diagonal_; }

 private:
  std::uint64_t serial_ = 0;
  std::vector<VertexId> place_;         ///< (|V|)
  std::vector<std::uint32_t> offsets_;  ///< (|V| + 1)
  std::vector<SimplexId> simplices_;
  double diagonal_ = 0;
};

/// A simplex of a patch, relative to the patch's origin and unit.
struct PatchSimplex {
  Eigen::Vector3d x[3];
  Eigen::Vector3d normal;  ///< outward unit normal; zero without area
  VertexId place[3];
  SimplexId id;
  bool two_sided = false;  ///< the body is not closed
};

/// A candidate for a point of a manifold, relative to the patch's origin and unit.
struct ManifoldCandidate {
  Eigen::Vector3d x[2];
  double depth = 0;
  SurfaceFeatureId on[2];
  bool was_chosen = false;  ///< a point of the previous manifolds has the same features
  bool is_checked = false;  ///< reduce_candidates() found it valid
};

/// Returns the corners of the overlay of two patches, projected along `normal`, whose depth is at least
/// `least`; ascending by features, each pair of features once.
std::vector<ManifoldCandidate> overlay_corners(std::span<const PatchSimplex> of_a,
                                               std::span<const PatchSimplex> of_b, int dim,
                                               const Eigen::Vector3d& normal, double least);

/// Reduces candidates to at most 4 (2D: 2), the deepest first. Candidates for which `is_valid` returns false
/// are dropped; it is called only for those that would be chosen. `size`: of the bodies.
std::vector<ManifoldCandidate> reduce_candidates(
    std::vector<ManifoldCandidate> candidates, int dim, const Eigen::Vector3d& normal, double size,
    const std::function<bool(const ManifoldCandidate&)>& is_valid);

/// Sets the ids of the points. reach: how far a point may have moved on its body and keep its id.
void number_points(ManifoldResult& result, const ManifoldResult* previous, double reach);

struct ManifoldContext {
  NearPairsResult near;
  VertexStars stars[2];  ///< of A and of B
};

/// Finds the manifolds as contact_manifolds() does. `query`, `near`, `context`: buffers. `result`:
/// overwritten; must not be `previous`.
void contact_manifolds_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                            const ManifoldRequest& request, const ManifoldResult* previous, Workers& workers,
                            QueryContext& query, NearPairsContext& near, ManifoldContext& context,
                            ManifoldResult& result);

}  // namespace lrb

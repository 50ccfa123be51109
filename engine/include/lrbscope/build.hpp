#pragma once
/// Construction of an LRB-rep from a mesh, and convex hulls.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb {

// Observing a build: derive from ConstructProbe, override the callbacks of interest, and set
// BuildOptions::probe. The result is the same with and without a probe. The callbacks and their order do not
// depend on the number of threads.
//
// The *front* is the outer surface of everything built so far, which the next pass covers with caps.

/// The operation of a pass on the front.
enum class BuildStage : std::uint8_t {
  fit,       ///< makes caps within a maximum deviation from the body, which grows from pass to pass
  simplify,  ///< makes caps of as few faces as possible, without a limit on their deviation
  bridge,    ///< turns the pockets between the front and its convex hull into regions
  fill,      ///< turns the rest of each void into a region
  close,     ///< adds a convex wrapper of few faces around everything
  known,     ///< nothing was built: the body was loaded with its regions
  merge,     ///< makes faces in a common plane regions without volume, each hidden by a polygon
};
constexpr auto enum_names(BuildStage) {
  return std::to_array<EnumName<BuildStage>>({{BuildStage::fit, "fitting"},
                                              {BuildStage::simplify, "simplifying"},
                                              {BuildStage::bridge, "bridging"},
                                              {BuildStage::fill, "filling voids"},
                                              {BuildStage::close, "closing"},
                                              {BuildStage::known, "known regions"},
                                              {BuildStage::merge, "merging planes"}});
}

/// The result for a cap: accepted, or the reason for its rejection. For a cap of too many faces it is the
/// reason why the last edge collapse was refused (front_simplifier.cpp). The name can follow a number:
/// "9 met the hull" (the front). For a chain in 2D, lengths are tried from a segment on, and the reported
/// verdict is the first one in this order among all of them.
enum class CapVerdict : std::uint8_t {
  accepted,
  too_thick,           ///< with fewer faces its deviation would exceed the limit of the pass
  too_much_volume,     ///< with fewer faces it would enclose more volume than a collapse may add
  too_thin,            ///< with fewer faces some would be needles
  no_place,            ///< no position is in front of all faces to be removed and within the body's bounds
  no_surface,          ///< another edge collapse would leave no surface
  too_many_faces,      ///< it saves too few faces to be worth a region
  splits_polygon,      ///< it covers only part of a polygon of the mesh
  turns_inward,        ///< at its boundary it would turn to the inside of the front
  meets_itself,        ///< its faces intersect beyond shared corners and edges
  meets_patch,         ///< it intersects the patch that it covers
  meets_front,         ///< it intersects another part of the front
  encloses_component,  ///< another component may be beneath it
  overlaps,            ///< it overlaps another cap of the pass or the patch of one
  several_outlines,    ///< bridging in 2D: there is more than one outline
  too_crowded,         ///< bridging: the front has very large polygons or fans
  flat,                ///< bridging: the convex hull has no interior, or the outline intersects itself
  too_far_out,         ///< closing: coordinates are too large for a wrapper around them
  leaves_out,          ///< closing: the wrapper does not contain the entire front
};
constexpr auto enum_names(CapVerdict) {
  return std::to_array<EnumName<CapVerdict>>({{CapVerdict::accepted, "stands"},
                                              {CapVerdict::too_thick, "too thick"},
                                              {CapVerdict::too_much_volume, "too much volume"},
                                              {CapVerdict::too_thin, "too thin faces"},
                                              {CapVerdict::no_place, "no place in front"},
                                              {CapVerdict::no_surface, "no surface left"},
                                              {CapVerdict::too_many_faces, "too many faces"},
                                              {CapVerdict::splits_polygon, "split a polygon"},
                                              {CapVerdict::turns_inward, "turned inward"},
                                              {CapVerdict::meets_itself, "met itself"},
                                              {CapVerdict::meets_patch, "met what it covers"},
                                              {CapVerdict::meets_front, "met the hull"},
                                              {CapVerdict::encloses_component, "held another component"},
                                              {CapVerdict::overlaps, "overlapped another cap"},
                                              {CapVerdict::several_outlines, "several outlines"},
                                              {CapVerdict::too_crowded, "too crowded"},
                                              {CapVerdict::flat, "flat"},
                                              {CapVerdict::too_far_out, "too far out"},
                                              {CapVerdict::leaves_out, "left some of the hull out"}});
}

/// State at the start of a pass.
struct PassStart {
  BuildStage stage = BuildStage::fit;
  std::uint32_t layer = 0;        ///< layer of the regions that it makes
  std::uint32_t front_faces = 0;  ///< number of triangles (2D: segments) of the front
  double max_deviation = 0;       ///< maximum deviation of caps from the body, mesh units; 0: unlimited
};

/// State at the end of a pass.
struct PassEnd {
  std::uint32_t front_faces = 0;
  /// Number of faces that no cap may cover: they intersect others, do not face the outside, or lie where the
  /// proof of a cap has failed.
  std::uint32_t excluded = 0;
  /// Always 0 and false: only traces of older versions have other values.
  std::uint32_t no_patch = 0;
  std::uint32_t waiting = 0;
  bool given_up = false;
};

/// A part of the front to be covered by a cap: a disk of triangles, a chain of segments, or a whole
/// component.
struct GrownPatch {
  VertexId vertex{};           ///< start vertex
  std::uint32_t faces = 0;     ///< number of triangles or segments
  std::uint32_t interior = 0;  ///< number of vertices all of whose faces belong to the patch
  /// These vertices, until the callback returns; empty for a whole component, and where they are not known.
  std::span<const VertexId> vertices = {};
};

/// A cap that was tried over the patch reported last.
struct TriedCap {
  std::uint32_t faces = 0;    ///< number of new faces
  std::uint32_t covered = 0;  ///< number of faces of the front that it covers
  CapVerdict verdict = CapVerdict::accepted;
  bool careful = false;  ///< made with a proof for each collapse, after an attempt without them failed at the
                         ///< end
  /// Measured deviation from the body, an estimate, mesh units; negative: not measured.
  double deviation = -1;

  /// Returns the number of new faces for each face by which the front shrinks; best near 0.
  double cost() const {
    return faces < covered ? static_cast<double>(faces) / (covered - faces)
                           : std::numeric_limits<double>::infinity();
  }
};

/// Observer of a build. Order of the callbacks: for each pass, pass() { patch() cap() ... region() ...
/// merged() ... } end_pass(); finally closed().
class ConstructProbe {
 public:
  virtual ~ConstructProbe() = default;
  virtual void pass(const PassStart&) {}
  virtual void patch(const GrownPatch&) {}
  virtual void cap(const TriedCap&) {}
  /// A region was made by the cap reported last, if that was accepted. One cap can make several regions.
  virtual void region(RegionId) {}
  /// `pieces` pieces of the space under the cap were merged into the region `into`, which was reported just
  /// before. Each is an inner shell of it.
  virtual void merged(RegionId /*into*/, std::uint32_t /*pieces*/) {}
  virtual void end_pass(const PassEnd&) {}
  /// The build is complete. `faces`: number of triangles or segments of the outermost wrapper.
  virtual void closed(std::uint32_t /*faces*/) {}
};

struct BuildOptions {
  /// Size of regions: in 3D, at most 7 times as many faces beneath a cap. Small values make the paper's
  /// recursion cheap, large ones make the structure small.
  std::uint32_t patch_interior = 16;
  std::uint32_t max_outer_faces = 20;  ///< target number of faces of the outermost wrapper
  /// Builds a small structure (about 1.4 faces per real face) instead of tightly fitting wrappers (about 2).
  bool lean = false;
  /// Maximum number of lids of a region in 3D; 0: any. Its floor then has at most three times as many faces,
  /// and patch_interior has no effect. 12: fewest tests by recursions with boxes (Recursion::paper_boxes),
  /// 1.9 to 2.2 faces per real face. A few regions are larger: those that bridge, fill or close.
  std::uint32_t max_lids = 0;
  /// First makes faces in exactly the same plane regions without volume, hidden by few polygons: wrappers of
  /// deviation 0. Regions of large planes exceed max_lids. InputError for 2D bodies, and with `lean`.
  bool merge_planes = false;
  std::uint64_t seed = 1;  ///< seed of the random choices of the builder
  unsigned threads = 1;    ///< 0: number of hardware threads. The result does not depend on it
  /// Called after each pass with its number and the number of faces of the front. May be empty.
  std::function<void(std::uint32_t pass, std::uint32_t front_faces)> progress;
  ConstructProbe* probe = nullptr;  ///< observer of the build, may be null. Must outlive the build
  /// Folder in which make_body(), and therefore Body, keeps LRB-reps and finds them again
  /// (engine/scene/build_cache.hpp); empty: none. build_lrb() does not use it.
  std::string cache;
};

/// Builds an LRB-rep by outward edge collapses (progressive hulls: Sander et al., "Silhouette Clipping",
/// 2000; construct/build.cpp; 2D: chain_builder.cpp). The mesh must be closed, manifold and oriented with
/// the solid behind its faces (MeshReport::buildable()). Use CheckedMesh::turn_outward() first for an
/// inward-oriented body. Throws InputError naming the affected elements otherwise. The result depends on the
/// seed, not on the number of threads.
LrbRep build_lrb(const CheckedMesh& mesh, const BuildOptions& options = {});

/// Checks the mesh first, then builds.
LrbRep build_lrb(const Mesh& mesh, const BuildOptions& options = {});

// Convex hulls, to create bodies and as a baseline for wrappers.

/// Returns the triangles of the convex hull as point indices, counter-clockwise seen from outside; empty if
/// all points are coplanar. Exact. The result, with its order, is defined as that of incremental insertion in
/// the order of the points: each replaces the triangles that it is strictly in front of; points in a
/// triangle's plane count as behind it. Coordinates must be finite. Takes about O(n log n) time for any
/// number of hull vertices (Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996).
std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const Eigen::Vector3d> points);

/// Returns the convex hull as a mesh that contains only the hull's vertices.
Mesh convex_hull_mesh(std::span<const Eigen::Vector3d> points);

/// Returns the indices of the points on the boundary of the convex hull in 2D, counter-clockwise, including
/// points inside its sides; coincident points are returned once. Ignores z. Exact. Returns none if all points
/// are collinear. (Monotone chains: Andrew 1979.) Coordinates must be finite.
std::vector<std::uint32_t> convex_outline(std::span<const Eigen::Vector3d> points);

}  // namespace lrb

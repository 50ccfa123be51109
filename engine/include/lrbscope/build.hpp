#pragma once
/// Builds an LRB-rep from a mesh; convex hulls.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_words.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb {

// Watching a build from outside: derive from ConstructProbe, override what is of interest, and name it in
// BuildOptions. The body is the same as without; what is told, and in which order, does not depend on the
// number of threads.

/// What a pass does to the hull.
enum class BuildStage : std::uint8_t {
  fit,       ///< caps that stand off the body by no more than a distance, which grows from pass to pass
  simplify,  ///< caps of as few faces as can be, wherever they stand
  bridge,    ///< the pockets between the outer hull and its convex hull become regions
  fill,      ///< what is left of each void becomes a region
  close,     ///< a convex wrapper of few faces goes around everything
  known,     ///< nothing was built: the body came with its regions
};
constexpr auto words_of(BuildStage) {
  return std::to_array<EnumWord<BuildStage>>({{BuildStage::fit, "fitting"},
                                              {BuildStage::simplify, "simplifying"},
                                              {BuildStage::bridge, "bridging"},
                                              {BuildStage::fill, "filling voids"},
                                              {BuildStage::close, "closing"},
                                              {BuildStage::known, "known regions"}});
}

/// What became of a cap: it stands, or why it was given up. The words fit behind a number: "9 met the hull".
/// What is told of a chain in the plane is the first in this order, of all lengths that were tried from a
/// segment on.
enum class CapVerdict : std::uint8_t {
  stands,
  too_thick,         ///< with fewer faces it would stand off the body by more than the pass allows
  too_much_volume,   ///< with fewer faces it would hold more space than a collapse may add
  too_thin,          ///< with fewer faces some would be needles
  no_place,          ///< no point lies in front of the faces that are to go, and within the body's bounds
  no_surface,        ///< collapsing any more edges would leave no surface
  too_many_faces,    ///< it saves too few faces to be worth a region
  splits_polygon,    ///< it covers a polygon of the mesh in part
  turns_inward,      ///< at its ring it would leave the hull inward
  meets_itself,      ///< its faces meet in more than they share
  meets_patch,       ///< it meets what it covers
  meets_hull,        ///< it meets another part of the hull
  holds_component,   ///< another component may lie beneath it
  overlaps,          ///< it covers what another cap of the pass covers, or is
  several_outlines,  ///< bridging in the plane: there is more than one outline
  too_crowded,       ///< bridging: the hull has very large polygons or fans
  flat,              ///< bridging: the convex hull has no inside, or the outline crosses itself
  too_far_out,       ///< closing: coordinates are too large for a wrapper around them
  leaves_out,        ///< closing: the wrapper does not hold all of the hull
};
constexpr auto words_of(CapVerdict) {
  return std::to_array<EnumWord<CapVerdict>>({{CapVerdict::stands, "stands"},
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
                                              {CapVerdict::meets_hull, "met the hull"},
                                              {CapVerdict::holds_component, "held another component"},
                                              {CapVerdict::overlaps, "overlapped another cap"},
                                              {CapVerdict::several_outlines, "several outlines"},
                                              {CapVerdict::too_crowded, "too crowded"},
                                              {CapVerdict::flat, "flat"},
                                              {CapVerdict::too_far_out, "too far out"},
                                              {CapVerdict::leaves_out, "left some of the hull out"}});
}

/// How a pass begins.
struct PassStart {
  BuildStage stage = BuildStage::fit;
  std::uint32_t layer = 0;       ///< of the regions that it makes, if it makes any
  std::uint32_t hull_faces = 0;  ///< triangles of the hull; segments in the plane
  double most_off = 0;           ///< how far caps may stand off the body, mesh's unit; 0: as far as they like
};

/// How it ends.
struct PassEnd {
  std::uint32_t hull_faces = 0;
  /// Faces that no patch may have: they meet others, lie within another component, or belong to a very large
  /// polygon or fan.
  std::uint32_t barred = 0;
  std::uint32_t no_patch =
      0;  ///< vertices at which no patch could be grown, most of them beside other patches
  std::uint32_t waiting = 0;  ///< vertices at which none is tried before caps may stand further off
  bool given_up = false;      ///< too few caps stood: the rest of the hull was not tried
};

/// A part of the hull that a cap is to cover: a disk of triangles, a chain of segments, or a whole component.
struct GrownPatch {
  VertexId vertex{};           ///< from which it grew
  std::uint32_t faces = 0;     ///< triangles or segments
  std::uint32_t interior = 0;  ///< vertices all of whose faces are in it
};

/// A cap that was tried over the patch that was told last.
struct TriedCap {
  std::uint32_t faces = 0;    ///< new faces
  std::uint32_t covered = 0;  ///< faces of the hull that go under them
  CapVerdict verdict = CapVerdict::stands;
  bool careful = false;  ///< made with a proof for each collapse, after one without had failed at the end
  /// How far it stands off the body where it was measured, mesh's unit, an estimate; negative: nobody
  /// measured.
  double off = -1;

  /// Returns how many new faces there are for each face that the hull loses; best near 0.
  double cost() const {
    return faces < covered ? static_cast<double>(faces) / (covered - faces)
                           : std::numeric_limits<double>::infinity();
  }
};

/// What is told: pass() { patch() cap() ... region() ... merged() ... } end_pass(), and again; closed() is
/// last.
class ConstructProbe {
 public:
  virtual ~ConstructProbe() = default;
  virtual void pass(const PassStart&) {}
  virtual void patch(const GrownPatch&) {}
  virtual void cap(const TriedCap&) {}
  /// A region was made: by the cap that was told last, if that stands; a cap can make several.
  virtual void region(RegionId) {}
  /// `pieces` pieces of the space under the cap became part of the region `into`, which was told just before:
  /// each is an inner shell of it.
  virtual void merged(RegionId /*into*/, std::uint32_t /*pieces*/) {}
  virtual void end_pass(const PassEnd&) {}
  /// The body is built. `faces`: of its outermost wrapper, as triangles or segments.
  virtual void closed(std::uint32_t /*faces*/) {}
};

struct BuildOptions {
  /// Number of interior vertices that a patch aims at: small makes the paper's recursion cheap, large makes
  /// the structure small.
  std::uint32_t patch_interior = 16;
  std::uint32_t max_outer_faces = 20;  ///< number of faces to aim for in the outermost wrapper
  /// Builds a small structure (about 1.5 faces per real face) in place of wrappers that fit (about 2).
  bool lean = false;
  std::uint64_t seed = 1;  ///< seeds the order in which patches grow
  unsigned threads = 1;    ///< 0: as many as the machine runs at once. The result does not depend on it
  /// Called after each pass with the pass's number and the number of faces of the hull. May be empty.
  std::function<void(std::uint32_t pass, std::uint32_t hull_faces)> progress;
  ConstructProbe* probe = nullptr;  ///< is told everything that happens; null: nobody. Must outlive the build
};

/// Builds by patch caps on progressive hulls (patch_builder.cpp); 2D meshes go through chain_builder.cpp. The
/// mesh must be closed, manifold and oriented, with the solid behind its faces, as MeshReport::buildable()
/// says: InputError names the offenders otherwise. A body that is inside out is turned by
/// CheckedMesh::turn_outward(). Deterministic for a seed, on any number of threads.
LrbRep build_lrb(const CheckedMesh& mesh, const BuildOptions& options = {});

/// Checks the mesh first, then does the same.
LrbRep build_lrb(const Mesh& mesh, const BuildOptions& options = {});

// Convex hulls, for bodies of one's own and to compare wrappers with.

/// Returns the convex hull's triangles, counter-clockwise seen from outside, as indices of points; none if
/// all points lie in one plane. Exact, and for every input the result of adding the points in order, each in
/// place of the triangles that it lies strictly in front of: points on a triangle's plane count as behind it.
/// The triangles are listed in the order in which they arise that way. Coordinates must be finite. Takes
/// about n log n time, however many points are on the hull (Barber, Dobkin and Huhdanpaa, "The Quickhull
/// Algorithm for Convex Hulls", 1996).
std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const Eigen::Vector3d> points);

/// Returns the same hull as a mesh, with only the vertices that it needs.
Mesh convex_hull_mesh(std::span<const Eigen::Vector3d> points);

}  // namespace lrb

#pragma once
/// Makes a draw list with its legend from LRB-reps, wrapper states, poses and what is to be pointed out. Pure
/// data in and out: no graphics library, no files.
///
/// 3D: real faces are solid, in full colour where the wrapper has come down to them and paler where it has
/// not; pseudo faces of the wrapper's boundary are translucent, with outlines. 2D: the solid is dark,
/// included regions are light (the paper's figure 1), the wrapper's boundary is a strong line.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <lrbscope/contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/mesh_repair.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::render::findings {

// Makes a draw list of a mesh that is not clean: the body pale, the first offenders of each finding in
// strong colours.

/// Returns the kinds of faults that the report found and that can be shown at a place, in the order of
/// MeshFault. A face that names a vertex twice is drawn as one without area if it has no area either.
std::vector<MeshFault> kinds(const MeshReport& report);

/// Returns the legend's entry for a kind.
LegendItem key(MeshFault kind, int dim);

/// Returns the count and the first offenders, e.g. "3 open edges: 0-42, 0-44, 42-44"; of open edges that make
/// loops, how many edges these have: "12 open edges in 2 loops, of 9 and 3".
std::string caption(MeshFault kind, const MeshFinding& finding, int dim,
                    std::span<const BoundaryLoop> loops = {});

/// Returns the mesh moved and scaled to [-1, 1], whatever its coordinates. Pictures are made of this.
Mesh to_unit_size(const Mesh& mesh);
/// Returns where a point is moved with the mesh.
Eigen::Vector3d to_unit_size(const Mesh& mesh, const Eigen::Vector3d& x);

/// What to show of the first offender of a kind, and from where: it and the faces around it. Of open edges
/// that make loops, the longest loop.
struct CloseUp {
  std::vector<Eigen::Vector3d> points;
  ViewDirection view;
};
CloseUp close_up(const Mesh& mesh, const MeshReport& report, MeshFault kind,
                 std::span<const BoundaryLoop> loops = {});

/// Returns the points that a picture of the whole mesh should show: those of faces, and offenders that are
/// not far from them.
std::vector<Eigen::Vector3d> whole(const Mesh& mesh, const MeshReport& report);

struct Options {
  std::optional<MeshFault> focus;  ///< the kind whose offenders are marked with their numbers; none: each
                                   ///< kind is marked with its letter, from b
  /// Those of the mesh: all open edges are drawn, and loops get their numbers. Empty: the first open edges
  /// are.
  std::span<const BoundaryLoop> loops;
  Eigen::AlignedBox3d near;  ///< only offenders in this box are marked with their numbers; empty: all
  double width = 640,
         height = 480;  ///< of the picture, pixels: labels that would overlap at this size are left out
  float scale = 1;      ///< of line widths, points and labels
  StyleName style = StyleName::screen;
};

/// Makes the draw list. Front sides of faces are pale, backs are darker. `mesh` must be as to_unit_size()
/// made it, `report` one of the same mesh.
DrawList list(const Mesh& mesh, const MeshReport& report, const Camera& camera, const Options& options = {});

/// Returns the legend for such a list: the sides of faces, then the kinds.
std::vector<LegendItem> legend(const MeshReport& report, int dim, StyleName style = StyleName::screen);

}  // namespace lrb::render::findings

namespace lrb::render {

struct SceneBody {
  const LrbRep* rep = nullptr;
  const Wrapper* wrapper = nullptr;  ///< null: the real faces alone are drawn
  Pose pose;
  std::span<const double> face_values;  ///< (|F|) for ColourBy::value; empty: none
  std::string name;                     ///< in the legend; empty: "A", "B"
  std::optional<Rgba> colour = {};      ///< nothing: the colour of the side
  /// (|real F|) or (|F|): faces whose entry is not 0 are drawn in the contacts' colour; empty: none. Includes
  /// pseudo faces where a wrapper is shown, even if it has been refined beyond them.
  std::span<const std::uint8_t> in_contact = {};
};

enum class ColourBy : std::uint8_t {
  kind,    ///< body colours; real and pseudo faces told apart
  layer,   ///< pseudo faces by the layer of the region they hide, viridis
  region,  ///< pseudo faces by the region they hide, a category each
  value,   ///< faces by SceneBody::face_values, viridis: face tests, refinements, ...
};

/// What the current event is about.
struct SceneHighlight {
  std::array<std::vector<RegionId>, 2> refining;       ///< of A and B
  std::optional<std::array<SimplexId, 2>> under_test;  ///< a simplex of A, one of B
  std::span<const ContactRegion> contacts;
  /// Regions of A that a construction has just made, ascending: in full colour with a rim, and those that it
  /// made before pale. Nothing: no construction is shown.
  std::optional<std::vector<RegionId>> built = {};
};

struct SceneOptions {
  ColourBy colour_by = ColourBy::kind;
  std::string value_name = "face tests";             ///< shown at the scale bar of ColourBy::value
  std::optional<std::array<double, 2>> value_range;  ///< nothing: from 0 to the largest value of the scene
  std::array<std::vector<RegionId>, 2>
      isolate;  ///< regions of A and B; if there are any, only these are shown, and the rest as ghosts
  bool ghost_rest = true;  ///< false: the rest is left out
  double explode = 0;      ///< included regions move outward by this share of their distance from the body's
                           ///< centre; 0: they stay in place, as lids
  bool real_edges = true;
  bool contact_rims = false;  ///< 3D: faces in contact get a rim that is seen through what lies in front
  float scale = 1;            ///< of line widths and points: for large pictures and print
  StyleName style = StyleName::screen;
};

struct Scene {
  DrawList list;
  std::vector<LegendItem> key;
  std::optional<ScaleBar> scale;
};

/// Builds the scene. Triangles and fills carry the id face_id() (fills of regions: region_id()). Throws
/// InputError if the bodies differ in dimension, or if a highlight names what is not there. Bodies from the
/// third on carry B's ids, and then no region or pair can be pointed out.
Scene build_scene(std::span<const SceneBody> bodies, const SceneHighlight& highlight = {},
                  const SceneOptions& options = {});

/// Returns the id of a face for the id pass: the top bit tells the body, the next one regions from faces.
constexpr std::uint32_t face_id(Side side, FaceId f) {
  return (side == Side::b ? 1U << 31 : 0U) | f;
}
constexpr std::uint32_t region_id(Side side, RegionId r) {
  return (side == Side::b ? 1U << 31 : 0U) | 1U << 30 | r;
}

/// Returns all points that a body can show in any wrapper state, posed. Cameras of a whole sequence should be
/// fitted to them.
std::vector<Eigen::Vector3d> body_points(const LrbRep& rep, const Pose& pose);

/// Returns how far SceneOptions::explode moves a region of a posed body away from the body's middle.
Eigen::Vector3d exploded_way(const LrbRep& rep, const Pose& pose, RegionId r, double explode);

/// Returns all points of the contact regions.
std::vector<Eigen::Vector3d> contact_points(std::span<const ContactRegion> contacts);

}  // namespace lrb::render

#pragma once
/// Makes a draw list and its legend from LRB-reps, wrapper states, poses and highlights. Plain data in and
/// out: no OpenGL, no files.
///
/// 3D: real faces are opaque, in full colour once the wrapper has been refined down to them and paler before;
/// pseudo faces of the wrapper's boundary are translucent, with outlines. 2D: the solid is dark, included
/// regions are light (figure 1 of the paper), the wrapper's boundary is a strong line.

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

// Makes a draw list of a mesh with defects: the body pale, the first affected elements of each finding in
// strong colours.

/// Returns the kinds of faults in the report that have a location, in the order of MeshFault. A face that
/// lists a vertex twice is drawn as a zero-area face if it also has zero area.
std::vector<MeshFault> kinds(const MeshReport& report);

/// Returns the legend's entry for a kind.
LegendItem key(MeshFault kind, int dim);

/// Returns the count and the first affected elements, e.g. "3 open edges: 0-42, 0-44, 42-44"; for open edges
/// in loops, the number of edges of each loop: "12 open edges in 2 loops, of 9 and 3".
std::string caption(MeshFault kind, const MeshFinding& finding, int dim,
                    std::span<const BoundaryLoop> loops = {});

/// Returns the mesh translated and scaled to [-1, 1], whatever its coordinates. Pictures use this mesh.
Mesh to_unit_size(const Mesh& mesh);
/// Returns the image of a point under the mesh's transformation.
Eigen::Vector3d to_unit_size(const Mesh& mesh, const Eigen::Vector3d& x);

/// A view of the first affected element of a kind: the element and the faces around it. For open edges in
/// loops, the longest loop.
struct CloseUp {
  std::vector<Eigen::Vector3d> points;
  ViewDirection view;
};
CloseUp close_up(const Mesh& mesh, const MeshReport& report, MeshFault kind,
                 std::span<const BoundaryLoop> loops = {});

/// Returns the points that a picture of the whole mesh should show: those of faces, and affected elements not
/// far from them.
std::vector<Eigen::Vector3d> whole(const Mesh& mesh, const MeshReport& report);

struct Options {
  std::optional<MeshFault> focus;  ///< kind whose elements are marked with their numbers; nullopt: each kind
                                   ///< is marked with its letter, from b
  /// The mesh's boundary loops: all open edges are drawn, and loops get their numbers. Empty: only the first
  /// open edges are drawn.
  std::span<const BoundaryLoop> loops;
  /// The segments in which all faces intersect; empty: those of the first pairs are drawn.
  std::span<const std::array<Eigen::Vector3d, 2>> crossings = {};
  Eigen::AlignedBox3d near;  ///< only elements in this box are marked with their numbers; empty: all
  double width = 640,
         height = 480;  ///< of the picture, pixels: labels that would overlap at this size are omitted
  float scale = 1;      ///< factor of line widths, points and labels
  StyleName style = StyleName::screen;
};

/// Makes the draw list. Front sides of faces are pale, backs are darker. `mesh` must be the result of
/// to_unit_size(), `report` a report on the same mesh.
DrawList list(const Mesh& mesh, const MeshReport& report, const Camera& camera, const Options& options = {});

/// Returns the legend for such a list: the sides of faces, then the kinds.
std::vector<LegendItem> legend(const MeshReport& report, int dim, StyleName style = StyleName::screen);

}  // namespace lrb::render::findings

namespace lrb::render {

struct SceneBody {
  const LrbRep* rep = nullptr;
  const Wrapper* wrapper = nullptr;  ///< null: only the real faces are drawn
  Pose pose;
  std::span<const double> face_values;  ///< (|F|) for ColourBy::value; empty: none
  std::string name;                     ///< in the legend; empty: "A", "B"
  std::optional<Rgba> colour = {};      ///< nullopt: the colour of the side
  /// (|real F|) or (|F|): faces with a nonzero entry have the contact colour; empty: none. Includes pseudo
  /// faces if a wrapper is shown, even if it has been refined beyond them.
  std::span<const std::uint8_t> in_contact = {};
  std::string contact_name = "intersecting real faces";  ///< legend text of `in_contact`
};

enum class ColourBy : std::uint8_t {
  kind,    ///< body colours; real and pseudo faces differ
  layer,   ///< pseudo faces by the layer of the region behind them
  region,  ///< pseudo faces by the region behind them, one category each
  value,   ///< faces by SceneBody::face_values: face tests, refinements, ...
};

/// The elements of the current event.
struct SceneHighlight {
  std::array<std::vector<RegionId>, 2> refining;       ///< of A and B
  std::optional<std::array<SimplexId, 2>> under_test;  ///< a simplex of A, one of B
  std::span<const ContactRegion> contacts;
  /// Regions of A that a construction has just made, ascending: drawn in full colour with a border, the
  /// earlier ones pale. nullopt: no construction is shown.
  std::optional<std::vector<RegionId>> built = {};
};

struct SceneOptions {
  ColourBy colour_by = ColourBy::kind;
  std::string value_name = "face tests";             ///< label of the scale bar of ColourBy::value
  std::optional<std::array<double, 2>> value_range;  ///< nullopt: from 0; outliers are clamped
  std::array<std::vector<RegionId>, 2>
      isolate;             ///< regions of A and B; if not empty, only these are shown, the rest as ghosts
  bool ghost_rest = true;  ///< false: the rest is omitted
  double explode = 0;      ///< the lids of this share of the layers move outward, the outermost farthest
  bool real_edges = true;
  /// 3D: faces in contact get a border that is visible through faces in front of it.
  bool contact_rims = false;
  /// 3D: marks the borders of regions, and the creases of the body, as DrawTriangle::borders.
  bool borders = false;
  float scale = 1;  ///< factor of line widths and points: for large pictures and print
  StyleName style = StyleName::screen;
};

struct Scene {
  DrawList list;
  std::vector<LegendItem> key;
  std::optional<ScaleBar> scale;
};

/// Builds the scene. Triangles and fills carry the id face_id() (fills of regions: region_id()). Throws
/// InputError if the bodies differ in dimension, or if a highlight names an element that does not exist.
/// Bodies from the third on carry B's ids; no region or pair can be highlighted then.
Scene build_scene(std::span<const SceneBody> bodies, const SceneHighlight& highlight = {},
                  const SceneOptions& options = {});

/// Returns the id of a face for the id pass: the top bit is the body, the next one distinguishes regions from
/// faces.
constexpr std::uint32_t face_id(Side side, FaceId f) {
  return (side == Side::b ? 1U << 31 : 0U) | f;
}
constexpr std::uint32_t region_id(Side side, RegionId r) {
  return (side == Side::b ? 1U << 31 : 0U) | 1U << 30 | r;
}

/// Returns the posed corners of a face.
std::vector<Eigen::Vector3d> corners_of(const LrbRep& rep, FaceId face, const Pose& pose = {});

/// Returns all points that a body can show in any wrapper state, posed. Fit the camera of a sequence to them.
std::vector<Eigen::Vector3d> body_points(const LrbRep& rep, const Pose& pose);

/// Returns the displacement of a region of a posed body by SceneOptions::explode: where its lids look.
Eigen::Vector3d exploded_way(const LrbRep& rep, const Pose& pose, RegionId r, double explode);
/// Returns that of a face, which is moved with the region whose lid it is; zero for real faces.
Eigen::Vector3d exploded_way(const LrbRep& rep, const Pose& pose, FaceId f, double explode);

/// Returns all points of the contact regions.
std::vector<Eigen::Vector3d> contact_points(std::span<const ContactRegion> contacts);

}  // namespace lrb::render

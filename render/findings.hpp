#pragma once
/// Makes a draw list of a mesh that is not clean: the body pale, the first offenders of each finding in
/// strong colours.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/mesh/boundary_loops.hpp"
#include "engine/mesh/mesh_check.hpp"
#include "render/camera.hpp"
#include "render/draw_list.hpp"
#include "render/overlay.hpp"

namespace lrb::render::findings {

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

#pragma once
/// A mesh that is not clean -> a draw list: the body pale, the first offenders of each finding in strong
/// colours.

#include <optional>
#include <string>
#include <vector>

#include "engine/mesh/mesh_check.hpp"
#include "render/camera.hpp"
#include "render/draw_list.hpp"
#include "render/overlay.hpp"

namespace lrb::render::dirt {

/// The kinds that a report found and that have a place to point at, in the order of MeshFault. Faces that
/// name a vertex twice are drawn as faces without area if they are that as well.
std::vector<MeshFault> kinds(const MeshReport& report);

/// What offenders of a kind look like.
LegendItem key(MeshFault kind, int dim);

/// "3 open edges: 0-42, 0-44, 42-44": the count and the first offenders.
std::string caption(MeshFault kind, const MeshFinding& finding, int dim);

/// The mesh moved and scaled to [-1, 1], whatever its coordinates: pictures are made of this.
Mesh to_unit_size(const Mesh& mesh);

/// What to show of the first offender of a kind, and from where: it and the faces around it.
struct CloseUp {
  std::vector<Eigen::Vector3d> points;
  ViewDirection view;
};
CloseUp close_up(const Mesh& mesh, const MeshReport& report, MeshFault kind);

/// The points that a picture of the whole should show: those of faces, and offenders that are not far from
/// them.
std::vector<Eigen::Vector3d> whole(const Mesh& mesh, const MeshReport& report);

struct Options {
  std::optional<MeshFault>
      focus;  ///< the kind whose offenders get their numbers; none: each kind its letter, from b
  Eigen::AlignedBox3d near;          ///< only offenders in it get their numbers; empty: all
  double width = 640, height = 480;  ///< of the picture, pixels: labels that would overlap there are left out
  float scale = 1;                   ///< of line widths, points and labels
};

/// Front sides of faces are pale, backs darker. `mesh` as to_unit_size() made it, `report` on the same mesh.
DrawList list(const Mesh& mesh, const MeshReport& report, const Camera& camera, const Options& options = {});

/// The legend for a list: sides of faces, then the kinds.
std::vector<LegendItem> legend(const MeshReport& report, int dim);

}  // namespace lrb::render::dirt

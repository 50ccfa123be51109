#include "engine/mesh/mesh_check.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "engine/mesh/checked_mesh.hpp"
#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/nesting.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include "engine/mesh/self_intersections.hpp"
#include "engine/mesh/surface_topology.hpp"

namespace lrb {
namespace {

/// Reverses a face. A triangle keeps its first corner and a quad starts at its third, so that the triangles
/// of its fan keep their numbers; those of larger polygons are numbered from the other end.
void turn(Mesh& mesh, FaceId f) {
  const auto first = mesh.face_vertices.begin() + mesh.face_offsets[f];
  const auto last = mesh.face_vertices.begin() + mesh.face_offsets[f + 1];
  if (mesh.dim == 2) {
    std::reverse(first, last);
    return;
  }
  // Reversing all but the first corner flips the orientation and keeps the fan's apex.
  std::reverse(first + 1, last);
  if (last - first == 4) std::rotate(first, first + 2, last);
}

/// Returns true if the directed edges (2D: ends of segments) cancel: the boundary of the faces, as a sum, is
/// empty.
bool is_cycle(const Mesh& mesh, const std::vector<FaceUse>& use) {
  // Signed count of each edge: +1 from the smaller to the larger vertex.
  std::map<std::array<VertexId, 2>, std::int64_t> sum;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    if (use[f] == FaceUse::nothing) return false;
    const auto c = mesh.face(f);
    // 2D: the boundary of a segment is its start less its end.
    if (mesh.dim == 2) {
      ++sum[{c[0], c[0]}];
      --sum[{c[1], c[1]}];
    }
    for (std::size_t i = 0; mesh.dim == 3 && i < c.size(); ++i) {
      const VertexId v = c[i], w = c[(i + 1) % c.size()];
      if (v != w) sum[{std::min(v, w), std::max(v, w)}] += v < w ? 1 : -1;
    }
  }
  return !sum.empty() &&
         std::all_of(sum.begin(), sum.end(), [](const auto& edge) { return edge.second == 0; });
}

/// Returns for each component whether it is a sheet: has an open edge, and lies in one plane. Exact.
std::vector<bool> find_sheets(const Mesh& mesh, const MeshFindings& found) {
  // Only components with an open edge can be sheets.
  std::vector<bool> sheet = found.topology.component_open;
  if (mesh.dim == 2) sheet.assign(sheet.size(), false);
  if (std::find(sheet.begin(), sheet.end(), true) == sheet.end()) return sheet;
  // All corners of each candidate, to be tested against one plane.
  std::vector<std::vector<VertexId>> corners(sheet.size());
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t component = found.topology.component_of_face[f];
    if (component == kNull || !sheet[component]) continue;
    if (found.use[f] < FaceUse::points)
      sheet[component] = false;  // a corner is not finite
    else
      corners[component].insert(corners[component].end(), mesh.face(f).begin(), mesh.face(f).end());
  }
  // Exact: three corners that span a plane, and all others in it.
  for (std::size_t i = 0; i < sheet.size(); ++i) {
    const auto plane = sheet[i] ? spanning_corners(mesh, corners[i]) : std::nullopt;
    sheet[i] = plane && is_planar(mesh, corners[i], *plane);
  }
  return sheet;
}

}  // namespace

MeshFindings examine(const Mesh& mesh, std::size_t kept) {
  MeshFindings found;
  MeshReport& report = found.report;
  report.kept = kept;
  if (mesh.face_count() == 0) ++report.findings[static_cast<std::size_t>(MeshFault::no_faces)].count;
  // Faces one by one, then duplicates, then vertices.
  found.use = check_faces(mesh, report);
  check_duplicates(mesh, found.use, report);
  check_vertices(mesh, report);
  // Neighbourhood of faces: components, closedness, genus.
  found.topology = analyse_topology(mesh, found.use, report);
  report.components = found.topology.components;
  report.closed = found.topology.closed;
  report.bounds_solid = report.closed || is_cycle(mesh, found.use);
  report.genus = found.topology.genus;
  // Orientation of closed components by nesting depth; each is named by its first face.
  found.inside_out = wrongly_facing_components(mesh, found.use, found.topology);
  for (const auto& faces : found.inside_out) note(report, MeshFault::inside_out, faces.front());
  // Open components that lie in one plane bound nothing.
  found.sheet = find_sheets(mesh, found);
  const auto& open = found.topology.component_open;
  report.open_components = static_cast<std::uint32_t>(std::count(open.begin(), open.end(), true));
  report.sheets = static_cast<std::uint32_t>(std::count(found.sheet.begin(), found.sheet.end(), true));
  sort_offenders(report);
  return found;
}

MeshReport check_mesh(const Mesh& mesh, bool self_intersections) {
  MeshFindings found = examine(mesh);
  if (self_intersections) {
    find_self_intersections(
        mesh, found.use, [&](FaceId f, FaceId g) { note(found.report, MeshFault::self_intersection, f, g); });
    sort_offenders(found.report);
    found.report.self_intersections_checked = true;
  }
  return std::move(found.report);
}

void turn_faces(Mesh& mesh, const std::vector<std::vector<FaceId>>& components) {
  for (const auto& faces : components)
    for (const FaceId f : faces) turn(mesh, f);
}

std::uint32_t orient_outward(Mesh& mesh) {
  const auto wrong = examine(mesh).inside_out;
  turn_faces(mesh, wrong);
  return static_cast<std::uint32_t>(wrong.size());
}

}  // namespace lrb

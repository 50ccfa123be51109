#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "engine/core/ids.hpp"
#include "engine/mesh/mesh_check.hpp"

namespace lrb {
namespace {

struct FaultText {
  std::string_view name, text;
  bool build, query;
};

constexpr std::array<FaultText, kMeshFaultCount> kFaults = {{
#define MESH_FAULT(name, text, build, query) {#name, text, build, query},
    LRB_MESH_FAULTS(MESH_FAULT)
#undef MESH_FAULT
}};

/// The kinds of things that the two numbers of an offender name.
enum class Offender : std::uint8_t {
  none,
  vertex,
  face,
  face_and_vertex,
  two_faces,
  two_vertices,
  edge,
  component
};

struct Help {
  Offender offender;
  std::string_view advice;
};

Help help_for(MeshFault fault) {
  switch (fault) {
    case MeshFault::no_faces:
      return {Offender::none, "export the mesh with its faces"};
    case MeshFault::non_finite_vertex:
      return {Offender::vertex, "give it a finite number"};
    case MeshFault::index_out_of_range:
      return {Offender::face_and_vertex, "correct the index or add the vertex"};
    case MeshFault::repeated_corner:
      return {Offender::face_and_vertex, "remove the corner or the face"};
    case MeshFault::zero_area_face:
      return {Offender::face, "collapse or remove it"};
    case MeshFault::non_planar_face:
      return {Offender::face,
              "it is taken as the triangles from its first corner; triangulate it to choose others"};
    case MeshFault::non_convex_face:
      return {Offender::face, "triangulate it"};
    case MeshFault::duplicate_face:
      return {Offender::two_faces, "remove one of them"};
    case MeshFault::open_edge:
      return {Offender::edge, "close the hole (lrbscope close)"};
    case MeshFault::non_manifold_edge:
      return {Offender::edge, "separate the parts or remove inner faces"};
    case MeshFault::flipped_face:
      return {Offender::two_faces, "reverse one of them: list its corners in the opposite order"};
    case MeshFault::non_manifold_vertex:
      return {Offender::vertex, "give each fan a vertex of its own"};
    case MeshFault::inside_out:
      return {Offender::component, "it can be turned without loss"};
    case MeshFault::self_intersection:
      return {Offender::two_faces, "inside is then decided by parity"};
    case MeshFault::duplicate_vertex:
      return {Offender::two_vertices, "merge them if the surface should be connected there"};
    default:
      return {Offender::vertex, "it can be removed without loss"};
  }
}

std::string shown(Offender kind, const std::array<std::uint32_t, 2>& element) {
  const std::string first = std::to_string(element[0]), second = std::to_string(element[1]);
  switch (kind) {
    case Offender::face_and_vertex:
      return first + " (vertex " + second + ")";
    case Offender::two_faces:
    case Offender::two_vertices:
      return first + " and " + second;
    case Offender::edge:
      return element[1] == kNull ? first : first + "-" + second;
    default:
      return first;
  }
}

std::string_view noun(Offender kind, int dim) {
  switch (kind) {
    case Offender::vertex:
    case Offender::two_vertices:
      return "vertex";
    case Offender::edge:
      return dim == 2 ? "vertex" : "edge (by its vertices)";
    case Offender::component:
      return "component (by its first face)";
    default:
      return dim == 2 ? "segment" : "face";
  }
}

/// Returns a fault's text. In the plane, vertices are what edges are in space.
std::string_view text_of(MeshFault fault, int dim) {
  if (dim == 2) {
    switch (fault) {
      case MeshFault::no_faces:
        return "the mesh has no segments";
      case MeshFault::index_out_of_range:
        return "a segment names a vertex that does not exist";
      case MeshFault::repeated_corner:
        return "a segment names a vertex twice";
      case MeshFault::zero_area_face:
        return "a segment has no length";
      case MeshFault::duplicate_face:
        return "two segments have the same ends";
      case MeshFault::open_edge:
        return "a vertex ends one segment only";
      case MeshFault::non_manifold_edge:
        return "a vertex ends more than two segments";
      case MeshFault::flipped_face:
        return "two neighbouring segments disagree on which side is outside";
      case MeshFault::self_intersection:
        return "two segments meet outside their shared ends";
      case MeshFault::unused_vertex:
        return "no segment uses a vertex";
      default:
        break;
    }
  }
  return kFaults[static_cast<std::size_t>(fault)].text;
}

/// Returns what to do about open edges, which depends on whether there is a hole at all.
std::string advice_on_openings(const MeshReport& report) {
  const std::uint32_t sheets = report.sheets, open = report.open_components;
  // Only sheets: closing them would make a body of no volume.
  if (sheets > 0 && sheets == open)
    return sheets == 1 ? "this is a sheet: it bounds nothing"
                       : "these are " + std::to_string(sheets) + " sheets: they bound nothing";
  const std::string close(help_for(MeshFault::open_edge).advice);
  if (sheets == 0) return close;
  return close + ", but " + std::to_string(sheets) + " of the " + std::to_string(open) + " open components " +
         (sheets == 1 ? "is a sheet: it bounds" : "are sheets: they bound") + " nothing";
}

std::string line_for(const Mesh& mesh, MeshFault fault, const MeshReport& report) {
  const MeshFinding& finding = report[fault];
  const Help help = help_for(fault);
  std::string line = mesh.name.empty() ? "mesh" : mesh.name;
  line.append(": ").append(text_of(fault, mesh.dim));
  // Number of findings, then the first affected elements in the order of the file.
  if (help.offender != Offender::none) {
    line.append(" (").append(std::to_string(finding.count)).append(finding.count == 1 ? " time" : " times");
    line.append("): ").append(noun(help.offender, mesh.dim)).append(" ");
    const std::size_t some = std::min(finding.first.size(), MeshFinding::kShown);
    for (std::size_t i = 0; i < some; ++i)
      line.append(i == 0 ? "" : ", ").append(shown(help.offender, finding.first[i]));
    if (finding.count > some) line.append(", ...");
    line.append(", counted from 0 in file order");
  }
  line.append("; ");
  // In 2D an open edge is a loose end, for which the advice on sheets does not apply.
  return fault == MeshFault::open_edge && mesh.dim == 3 ? line + advice_on_openings(report)
                                                        : line.append(help.advice);
}

}  // namespace

std::string_view name_of(MeshFault fault) {
  return kFaults[static_cast<std::size_t>(fault)].name;
}

bool MeshReport::buildable() const {
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (findings[i].count > 0 && !kFaults[i].build) return false;
  return true;
}

bool MeshReport::queryable() const {
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (findings[i].count > 0 && !kFaults[i].query) return false;
  return true;
}

MeshReport MeshReport::when_turned() const {
  MeshReport turned = *this;
  turned.findings[static_cast<std::size_t>(MeshFault::inside_out)] = {};
  return turned;
}

MeshReport MeshReport::shortened() const {
  MeshReport few = *this;
  for (MeshFinding& f : few.findings) f.first.resize(std::min(f.first.size(), MeshFinding::kShown));
  return few;
}

std::string MeshReport::line(MeshFault fault, const Mesh& mesh) const {
  return line_for(mesh, fault, *this);
}

std::vector<std::string> MeshReport::lines(const Mesh& mesh) const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (findings[i].count > 0) out.push_back(line(static_cast<MeshFault>(i), mesh));
  return out;
}

std::vector<std::string> MeshReport::obstacles(const Mesh& mesh) const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (findings[i].count > 0 && !kFaults[i].build) out.push_back(line(static_cast<MeshFault>(i), mesh));
  return out;
}

}  // namespace lrb

#include <algorithm>
#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_repair.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::tools {
namespace {

using Json = nlohmann::ordered_json;

struct CloseOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string mesh, out;
  double weld = 0;
  bool json = false;
};

bool is_closed(const Hole& hole) {
  return hole.state <= HoleState::closed_as_ring;
}

/// Returns the T-junction whose slit a hole is; empty: it has none.
std::string junction_text(const Hole& hole, const MeshReport& report) {
  for (const auto& [vertex, face] : report[MeshFault::t_junction].first)
    if (std::ranges::count(hole.loop.vertices, VertexId(vertex)) > 0)
      return ": a T-junction of vertex " + std::to_string(vertex) + " with face " + std::to_string(face) +
             "; make it a corner of the face, or merge it with a vertex close to it first (--weld LENGTH)";
  return {};
}

/// Returns the state of a hole as text. `report`: of the mesh with the hole.
std::string state_text(const Hole& hole, const MeshReport& report) {
  if (hole.of_sheet && !is_closed(hole))
    return "not closed: its surface is a sheet, which does not bound a solid";
  switch (hole.state) {
    case HoleState::closed:
      return "closed with " + std::to_string(hole.faces) + (hole.faces == 1 ? " face" : " faces");
    case HoleState::closed_as_ring:
      return "closed with a ring between it and the loops inside or around it, " +
             std::to_string(hole.faces) + " faces";
    case HoleState::not_a_loop:
      return "not closed: the boundary is not a simple loop (it runs into non-manifold edges or inconsistently "
             "oriented faces); fix those first";
    case HoleState::no_area:
      return "not closed: the boundary is a slit along one line" + junction_text(hole, report);
    case HoleState::meets_surface:
      return "not closed: the fill would intersect face " + std::to_string(hole.obstacle);
    case HoleState::meets_lid:
      return "not closed: the fill would intersect that of hole " + std::to_string(hole.obstacle);
    default:
      return "not closed: every candidate fill would intersect itself or reuse an existing edge";
  }
}

Json hole_json(const Hole& hole, const MeshReport& report) {
  Json vertices = Json::array();
  for (const VertexId v : hole.loop.vertices) vertices.push_back(v.value());
  Json j = {{"closed", is_closed(hole)},  {"what", state_text(hole, report)},
            {"edges", hole.loop.edges()}, {"length", hole.loop.length},
            {"planar", hole.loop.planar}, {"vertices", std::move(vertices)}};
  if (is_closed(hole)) {
    j["first_face"] = hole.first_face;
    j["faces"] = hole.faces;
  }
  return j;
}

std::string as_text(const ClosedHoles& result, std::size_t closed, const MeshReport& before,
                    const MeshReport& after) {
  std::ostringstream out;
  out << closed << " of " << result.holes.size() << (result.holes.size() == 1 ? " hole" : " holes")
      << " closed, " << result.new_faces << " faces and " << result.new_vertices << " vertices added\n";
  constexpr int kDigits = 4;
  for (std::size_t i = 0; i < result.holes.size(); ++i) {
    const Hole& hole = result.holes[i];
    out << "  " << i << ": " << hole.loop.edges() << " edges, length "
        << for_people(hole.loop.length, kDigits) << ", " << (hole.loop.planar ? "flat" : "not flat") << ": "
        << state_text(hole, before) << "\n";
  }
  out << "buildable: "
      << (after.when_turned().buildable() ? "yes" : "no (lrbscope inspect lists the reasons)") << "\n";
  return out.str();
}

int run_close(const CloseOptions& o, const Globals& globals) {
  std::vector<std::string> notes;
  CheckedMesh mesh = check(bodies::read_body(o.mesh, o.corners, notes));
  if (mesh.mesh().dim == 2)
    throw InputError(
        mesh.mesh().name +
        ": expected a 3D body, found a 2D body; close it with segments (l) between its ends, which lrbscope inspect lists");
  if (!mesh.report().queryable())
    throw InputError(mesh.mesh().name + ": has faults that must be fixed first; lrbscope inspect lists them");
  if (o.weld > 0) {
    WeldedCorners done;
    mesh = weld_corners(mesh, o.weld, done);
    notes.push_back("welded " + render::counted(done.welded, "vertex", "vertices") + ", moved by at most " +
                    for_people(done.farthest, 2));
  }
  note(globals, notes);
  if (const MeshReport& report = mesh.report(); report.sheets > 0 && report.sheets == report.open_components)
    throw InputError(mesh.mesh().name + ": " + obstacles_to_build(mesh));
  check_mesh_name(o.out, mesh.mesh().dim);
  const ClosedHoles result = close_holes(mesh);
  const MeshReport after = check(result.mesh).report();
  write_mesh(result.mesh, o.out);
  const auto closed =
      static_cast<std::size_t>(std::count_if(result.holes.begin(), result.holes.end(), is_closed));
  if (o.json) {
    Json holes = Json::array();
    for (const Hole& hole : result.holes) holes.push_back(hole_json(hole, mesh.report()));
    print(one_line({{"file", o.out},
                    {"closed", closed},
                    {"left", result.holes.size() - closed},
                    {"new_faces", result.new_faces},
                    {"new_vertices", result.new_vertices},
                    {"buildable", after.when_turned().buildable()},
                    {"notes", notes},
                    {"holes", std::move(holes)}}));
  } else {
    print(as_text(result, closed, mesh.report(), after));
  }
  note(globals, {"wrote " + o.out});
  return closed == result.holes.size() ? kOk : kMismatch;
}

}  // namespace

Command add_close(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "close",
      "Close the holes of a mesh with faces proven not to intersect anything; exit code 1 if holes remain");
  const auto o = std::make_shared<CloseOptions>();
  app->add_option("MESH", o->mesh, "Mesh: OBJ, STL, PLY or OFF")->required();
  app->add_option("-o,--output", o->out, "FILE.obj|ply",
                  "Mesh to write; existing vertices and faces keep their numbers")
      ->required();
  app->add_option(
         "--weld", o->weld,
         "First merge vertices of open edges that are at most this far apart; rejected if a face would "
         "lose its area or intersect another one")
      ->type_name("LENGTH")
      ->positive();
  app->add_flag("--json", o->json, "Print one JSON object");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_close(*o, globals); }};
}

}  // namespace lrb::tools

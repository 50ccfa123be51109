#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb::cli {
namespace {

using Json = nlohmann::ordered_json;

struct CloseOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string mesh, out;
  bool json = false;
};

bool is_closed(const Hole& hole) {
  return hole.state <= HoleState::closed_as_ring;
}

/// Returns the state of a hole as text.
std::string state_text(const Hole& hole) {
  if (hole.of_sheet && !is_closed(hole)) return "left: its surface is a sheet: it bounds nothing";
  switch (hole.state) {
    case HoleState::closed:
      return "closed with " + std::to_string(hole.faces) + (hole.faces == 1 ? " face" : " faces");
    case HoleState::closed_as_ring:
      return "closed with the ring between it and those in it or round it, " + std::to_string(hole.faces) +
             " faces";
    case HoleState::not_a_loop:
      return "left: its rim is no loop, it ends at edges with more than two faces or at faces that contradict "
             "each other; mend these first";
    case HoleState::no_area:
      return "left: all of its rim lies on one line";
    case HoleState::meets_surface:
      return "left: a lid would meet face " + std::to_string(hole.obstacle);
    case HoleState::meets_lid:
      return "left: a lid would meet that of " + std::to_string(hole.obstacle);
    default:
      return "left: each lid that was tried would meet itself, or have an edge that faces have already";
  }
}

Json hole_json(const Hole& hole) {
  Json vertices = Json::array();
  for (const VertexId v : hole.loop.vertices) vertices.push_back(v.value());
  Json j = {{"closed", is_closed(hole)},  {"what", state_text(hole)},   {"edges", hole.loop.edges()},
            {"length", hole.loop.length}, {"planar", hole.loop.planar}, {"vertices", std::move(vertices)}};
  if (is_closed(hole)) {
    j["first_face"] = hole.first_face;
    j["faces"] = hole.faces;
  }
  return j;
}

std::string as_text(const ClosedHoles& result, std::size_t closed, const MeshReport& after) {
  std::ostringstream out;
  out << closed << " of " << result.holes.size() << (result.holes.size() == 1 ? " hole" : " holes")
      << " closed, " << result.new_faces << " faces and " << result.new_vertices << " vertices added\n";
  constexpr int kDigits = 4;
  for (std::size_t i = 0; i < result.holes.size(); ++i) {
    const Hole& hole = result.holes[i];
    out << "  " << i << ": " << hole.loop.edges() << " edges, length "
        << for_people(hole.loop.length, kDigits) << ", " << (hole.loop.planar ? "flat" : "not flat") << ": "
        << state_text(hole) << "\n";
  }
  out << "buildable: " << (after.when_turned().buildable() ? "yes" : "no: lrbscope inspect tells why")
      << "\n";
  return out.str();
}

int run_close(const CloseOptions& o, const Globals& globals) {
  if (std::error_code error; std::filesystem::equivalent(o.mesh, o.out, error))
    throw InputError(printable_name(o.out) + ": is the mesh itself; write to another file");
  std::vector<std::string> notes;
  const CheckedMesh mesh = check(bodies::read_body(o.mesh, o.corners, notes));
  note(globals, notes);
  if (mesh.mesh().dim == 2)
    throw InputError(mesh.mesh().name + ": is a 2D body, expected one in space; close it with a segment (l)");
  if (!mesh.report().queryable())
    throw InputError(mesh.mesh().name +
                     ": has faults that have to be mended first: lrbscope inspect names them");
  if (const MeshReport& report = mesh.report(); report.sheets > 0 && report.sheets == report.open_components)
    throw InputError(report.line(MeshFault::open_edge, mesh.mesh()));
  check_mesh_name(o.out, mesh.mesh().dim);
  const ClosedHoles result = close_holes(mesh);
  const MeshReport after = check(result.mesh).report();
  write_mesh(result.mesh, o.out);
  const auto closed =
      static_cast<std::size_t>(std::count_if(result.holes.begin(), result.holes.end(), is_closed));
  if (o.json) {
    Json holes = Json::array();
    for (const Hole& hole : result.holes) holes.push_back(hole_json(hole));
    print(one_line({{"file", o.out},
                    {"closed", closed},
                    {"left", result.holes.size() - closed},
                    {"new_faces", result.new_faces},
                    {"new_vertices", result.new_vertices},
                    {"buildable", after.when_turned().buildable()},
                    {"notes", notes},
                    {"holes", std::move(holes)}}));
  } else {
    print(as_text(result, closed, after));
  }
  note(globals, {"wrote " + o.out});
  return closed == result.holes.size() ? kOk : kMismatch;
}

}  // namespace

Command add_close(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand(
      "close",
      "Close the holes of a mesh with lids that are proved to meet nothing; exit code 1 if some are left");
  const auto o = std::make_shared<CloseOptions>();
  app->add_option("MESH", o->mesh, "OBJ, STL, PLY or OFF")->required();
  app->add_option("-o,--output", o->out, "Mesh to write; what was there keeps its numbers")
      ->required()
      ->type_name("FILE.obj|ply");
  app->add_flag("--json", o->json, "Print one JSON object");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_close(*o, globals); }};
}

}  // namespace lrb::cli

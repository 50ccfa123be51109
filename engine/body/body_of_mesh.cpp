// From a checked mesh to an LRB-rep.
// 1. Reject meshes that cannot be queried at all.
// 2. Orient components outwards, if requested and needed.
// 3. Build the regions and prove the cells closed (validate_cells()).
// 4. If the mesh cannot have regions or the proof fails, keep the real faces only and note the reason.

#include "engine/body/body_of_mesh.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>

#include "engine/core/error.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "engine/lrb/validate.hpp"
#include "engine/mesh/join_corners.hpp"

namespace lrb {
namespace {

/// Returns a mesh's findings on one line, after its name.
std::string joined(const Mesh& mesh, const std::vector<std::string>& lines) {
  const std::string name = mesh.name + ": ";
  std::string out;
  for (const std::string& line : lines)
    out += (out.empty() ? "" : " | ") + (line.starts_with(name) ? line.substr(name.size()) : line);
  return out;
}

void refuse_unless_queryable(const CheckedMesh& mesh) {
  if (!mesh.report().queryable())
    throw InputError(mesh.mesh().name +
                     ": cannot be queried: " + joined(mesh.mesh(), mesh.report().lines(mesh.mesh())));
}

std::string note_without_regions(const CheckedMesh& mesh, bool turn) {
  const std::string why =
      turn ? obstacles_to_build(mesh) : joined(mesh.mesh(), mesh.report().obstacles(mesh.mesh()));
  return mesh.mesh().name + ": queried without regions, because it cannot have any: " + why;
}

bool can_be_built(const CheckedMesh& mesh, bool turn) {
  return turn ? mesh.report().when_turned().buildable() : mesh.report().buildable();
}

}  // namespace

bool is_lrb_file(const std::string& path) {
  std::error_code ignored;
  // Only regular files: bytes read from a pipe are gone, and opening a named pipe would block.
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  constexpr std::size_t kEnough = 64;  // bytes: more than any magic
  std::ifstream in(path, std::ios::binary);
  std::string start(kEnough, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  return looks_like_lrb(std::string_view(start).substr(0, static_cast<std::size_t>(in.gcount())));
}

std::string join_corners_of_mesh(Mesh& mesh) {
  const JoinedCorners joined = join_corners(mesh);
  if (!joined.any()) return "";
  return mesh.name + ": joined corners in exactly the same place: " + std::to_string(joined.before) +
         " vertices became " + std::to_string(joined.after) + ", " + std::to_string(joined.open_before) +
         (mesh.dim == 2 ? " loose ends " : " open edges ") + "became " + std::to_string(joined.open_after);
}

std::string obstacles_to_build(const CheckedMesh& mesh) {
  return joined(mesh.mesh(), mesh.report().when_turned().obstacles(mesh.mesh()));
}

std::string note_unproven(const LrbRep& rep) {
  // Without regions there are no cells to prove.
  if (rep.region_count() == 0) return {};
  const ValidateReport report = validate_cells(rep);
  if (report.valid) return {};
  return rep.name() +
         ": queried without regions, because the proof of its LRB-rep failed: " + report.violations.front();
}

LrbRep proven(LrbRep rep, std::vector<std::string>& notes) {
  std::string fault = note_unproven(rep);
  if (fault.empty()) return rep;
  notes.push_back(std::move(fault));
  return LrbRep::without_regions(rep);
}

std::uint32_t turn_outward(CheckedMesh& mesh, std::vector<std::string>& notes) {
  const std::uint32_t turned = mesh.turn_outward();
  if (turned > 0)
    notes.push_back(mesh.mesh().name + ": turned " + std::to_string(turned) +
                    (turned == 1 ? " component that was inside out" : " components that were inside out"));
  return turned;
}

MadeBody make_body(CheckedMesh mesh, const BuildOptions& options, bool turn) {
  using Clock = std::chrono::steady_clock;
  refuse_unless_queryable(mesh);
  std::vector<std::string> notes;
  // Steps 2 and 3. The time includes the proof.
  if (can_be_built(mesh, turn)) {
    const std::uint32_t turned = turn ? turn_outward(mesh, notes) : 0;
    const auto begin = Clock::now();
    LrbRep rep = proven(build_lrb(mesh, options), notes);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return {std::move(rep), std::move(notes), seconds, turned};
  }
  // Step 4. Without regions, the body still records whether it intersects itself.
  notes.push_back(note_without_regions(mesh, turn));
  Workers workers(options.threads);
  const bool self_intersecting = !mesh.self_intersecting_faces(workers).empty();
  return {LrbRep::without_regions(mesh.mesh(), mesh.report().bounds_solid, self_intersecting),
          std::move(notes)};
}

MadeBody make_body_of_faces(CheckedMesh mesh, bool turn) {
  refuse_unless_queryable(mesh);
  std::vector<std::string> notes;
  std::uint32_t turned = 0;
  if (!can_be_built(mesh, turn))
    notes.push_back(note_without_regions(mesh, turn));
  else if (turn)
    turned = turn_outward(mesh, notes);
  constexpr bool kNotAsked = false;  // whether it intersects itself matters to regions only
  return {LrbRep::without_regions(mesh.mesh(), mesh.report().bounds_solid, kNotAsked), std::move(notes), 0,
          turned};
}

}  // namespace lrb

#include "scenarios/bodies/body.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>

#include "engine/core/error.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "engine/mesh/checked_mesh.hpp"
#include "engine/mesh/io/mesh_io.hpp"
#include "engine/mesh/join_corners.hpp"

namespace lrb::bodies {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Returns a mesh's findings on one line, after its name.
std::string joined(const Mesh& mesh, const std::vector<std::string>& lines) {
  const std::string name = mesh.name + ": ";
  std::string out;
  for (const std::string& line : lines)
    out += (out.empty() ? "" : " | ") + (line.starts_with(name) ? line.substr(name.size()) : line);
  return out;
}

void turn_outward(CheckedMesh& mesh, std::vector<std::string>& notes) {
  const std::uint32_t turned = mesh.turn_outward();
  if (turned > 0)
    notes.push_back(mesh.mesh().name + ": turned " + std::to_string(turned) +
                    (turned == 1 ? " component that was inside out" : " components that were inside out"));
}

/// Says why there can be no LRB-rep of it, even if it were turned.
std::string obstacles(const CheckedMesh& mesh) {
  return joined(mesh.mesh(), mesh.report().when_turned().obstacles(mesh.mesh()));
}

void refuse_unless_queryable(const CheckedMesh& mesh) {
  if (!mesh.report().queryable())
    throw InputError(mesh.mesh().name +
                     ": cannot be queried: " + joined(mesh.mesh(), mesh.report().lines(mesh.mesh())));
}

std::string note_without_regions(const CheckedMesh& mesh) {
  return mesh.mesh().name + ": queried without regions, because it cannot have any: " + obstacles(mesh);
}

}  // namespace

bool is_lrb_file(const std::string& path) {
  std::error_code ignored;  // what is read from a pipe is gone, and a named pipe would have to be waited for
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  constexpr std::size_t kEnough = 64;  // bytes: more than any magic
  std::ifstream in(path, std::ios::binary);
  std::string start(kEnough, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  return looks_like_lrb(std::string_view(start).substr(0, static_cast<std::size_t>(in.gcount())));
}

LrbRep build_from_mesh(CheckedMesh mesh, const BuildOptions& options, std::vector<std::string>& notes) {
  if (!mesh.report().when_turned().buildable())
    throw InputError(mesh.mesh().name + ": cannot be an LRB-rep: " + obstacles(mesh) +
                     " | it can still be queried, not built");
  turn_outward(mesh, notes);
  return build_lrb(mesh, options);
}

LoadedBody body_of_mesh(Mesh mesh, const BuildOptions& options) {
  return body_of_mesh(check(std::move(mesh)), options);
}

LoadedBody body_of_mesh(CheckedMesh mesh, const BuildOptions& options) {
  refuse_unless_queryable(mesh);
  std::vector<std::string> notes;
  if (mesh.report().when_turned().buildable()) {
    turn_outward(mesh, notes);
    const auto begin = std::chrono::steady_clock::now();
    LrbRep rep = build_lrb(mesh, options);
    return {std::move(rep), std::move(notes), seconds_since(begin)};
  }
  notes.push_back(note_without_regions(mesh));
  Workers workers(options.threads);
  const bool self_intersecting = !mesh.self_intersecting_faces(workers).empty();
  return {LrbRep::without_regions(mesh.mesh(), mesh.report().bounds_solid, self_intersecting),
          std::move(notes), 0};
}

Mesh read_body(const std::string& path, Corners corners, std::vector<std::string>& notes) {
  Mesh mesh = read_mesh(path);
  if (corners == Corners::apart) return mesh;
  const JoinedCorners joined = join_corners(mesh);
  if (joined.any())
    notes.push_back(mesh.name +
                    ": joined corners in exactly the same place: " + std::to_string(joined.before) +
                    " vertices became " + std::to_string(joined.after) + ", " +
                    std::to_string(joined.open_before) + (mesh.dim == 2 ? " loose ends " : " open edges ") +
                    "became " + std::to_string(joined.open_after) + " (--no-join keeps them apart)");
  return mesh;
}

LoadedBody load_body(const std::string& path, const BuildOptions& options, Corners corners) {
  if (is_lrb_file(path)) return {load_lrb(path), {}, 0};
  std::vector<std::string> notes;
  Mesh mesh = read_body(path, corners, notes);
  LoadedBody body = body_of_mesh(std::move(mesh), options);
  body.notes.insert(body.notes.begin(), notes.begin(), notes.end());
  return body;
}

LoadedBody load_faces(const std::string& path, Corners corners) {
  if (is_lrb_file(path)) return {load_lrb(path), {}, 0};
  std::vector<std::string> notes;
  CheckedMesh mesh = check(read_body(path, corners, notes));
  refuse_unless_queryable(mesh);
  if (mesh.report().when_turned().buildable())
    turn_outward(mesh, notes);
  else
    notes.push_back(note_without_regions(mesh));
  constexpr bool kNotAsked = false;  // whether it intersects itself does not matter: only regions depend on
                                     // it
  return {LrbRep::without_regions(mesh.mesh(), mesh.report().bounds_solid, kNotAsked), std::move(notes), 0};
}

}  // namespace lrb::bodies

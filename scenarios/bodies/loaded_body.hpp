#pragma once
/// Makes a body for queries from user input: a mesh file, an LRB-rep file, or a mesh in memory.

#include <cstdint>
#include <string>
#include <vector>

#include <lrbscope/body.hpp>
#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::bodies {

struct LoadedBody {
  LrbRep rep;
  std::vector<std::string> notes;  ///< repairs made and features not available; one line each
  double build_seconds = 0;        ///< 0 if it was not built
};

using lrb::is_lrb_file;

/// Whether coincident corners are merged when a mesh is read (<lrbscope/mesh_repair.hpp>).
enum class Corners : std::uint8_t { joined, apart };

/// Reads a mesh file. Adds a line to `notes` if corners were merged.
Mesh read_body(const std::string& path, Corners corners, std::vector<std::string>& notes);

/// Reads a mesh and builds its LRB-rep, or reads an LRB-rep. A mesh that cannot have one (open, non-manifold)
/// becomes a body without regions, and a note states why. Throws InputError if it cannot be queried at all.
LoadedBody load_body(const std::string& path, const BuildOptions& options = {},
                     Corners corners = Corners::joined);
LoadedBody body_of_mesh(Mesh mesh, const BuildOptions& options = {});
LoadedBody body_of_mesh(CheckedMesh mesh, const BuildOptions& options = {});

/// As above without regions, for callers that only need face pairs and the relation: builds no LRB-rep from a
/// mesh, and checks only properties that the answer depends on. Faces have the same numbers as with
/// load_body(), and answers are the same. (An .lrb file is read unchanged.)
LoadedBody load_faces(const std::string& path, Corners corners = Corners::joined);
LoadedBody faces_of_mesh(Mesh mesh);

/// Flips inward-oriented surfaces and builds. Throws InputError with a list of the affected elements if that
/// is impossible. Adds the changes made to `notes`.
LrbRep build_from_mesh(CheckedMesh mesh, const BuildOptions& options, std::vector<std::string>& notes);

}  // namespace lrb::bodies

#pragma once
/// Makes a body for a query from whatever the user has: a mesh file, an LRB-rep file, or a mesh in memory.

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
  std::vector<std::string> notes;  ///< what was done to it or could not be done; one line each, for people
  double build_seconds = 0;        ///< 0 if nothing was built
};

using lrb::is_lrb_file;

/// Whether corners in exactly the same place are joined when a mesh is read (<lrbscope/mesh_repair.hpp>).
enum class Corners : std::uint8_t { joined, apart };

/// Reads a mesh file. Adds a line to `notes` if corners were joined.
Mesh read_body(const std::string& path, Corners corners, std::vector<std::string>& notes);

/// Reads a mesh and builds its LRB-rep, or reads an LRB-rep. A mesh that cannot have one (open, non-manifold)
/// becomes a body without regions, and a note says why. Throws InputError if it cannot be queried at all.
LoadedBody load_body(const std::string& path, const BuildOptions& options = {},
                     Corners corners = Corners::joined);
LoadedBody body_of_mesh(Mesh mesh, const BuildOptions& options = {});
LoadedBody body_of_mesh(CheckedMesh mesh, const BuildOptions& options = {});

/// Does the same without regions, for callers that ask only for pairs of faces and the relation: builds no
/// LRB-rep from a mesh, and proves nothing about it that the answer does not need. Faces have the numbers
/// that load_body() gives them, and answers are the same. (An .lrb file is read as it is.)
LoadedBody load_faces(const std::string& path, Corners corners = Corners::joined);
LoadedBody faces_of_mesh(Mesh mesh);

/// Turns what is inside out, and builds; throws InputError with a list of the offenders if that cannot be
/// done. Adds what was done on the way to `notes`.
LrbRep build_from_mesh(CheckedMesh mesh, const BuildOptions& options, std::vector<std::string>& notes);

}  // namespace lrb::bodies

#pragma once
/// Makes a body for queries from user input: a mesh file, an LRB-rep file, or a mesh in memory.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <lrbscope/body.hpp>
#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::bodies {

using LoadedBody = MadeBody;
using lrb::is_lrb_file;

/// Environment variable of the folder in which body_of_mesh() and load_body() keep LRB-reps
/// (BuildOptions::cache) if the options name none. `lrbscope --cache` sets it.
inline constexpr const char* kCacheVariable = "LRBSCOPE_CACHE";

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
/// load_body(), and answers are the same. (An .lrb file is read unchanged.) `threads`: see BuildOptions.
LoadedBody load_faces(const std::string& path, Corners corners = Corners::joined, unsigned threads = 1);
LoadedBody faces_of_mesh(Mesh mesh, unsigned threads = 1);

/// Loads two bodies with `load`, on two threads if both are regular files. Throws what loading A and then B
/// throws: if both fail, the exception of A.
std::array<LoadedBody, 2> load_two(const std::string& a, const std::string& b,
                                   const std::function<LoadedBody(const std::string& path)>& load);
/// Calls load_faces() for two files.
std::array<LoadedBody, 2> load_faces_of_two(const std::string& a, const std::string& b,
                                            Corners corners = Corners::joined);
/// Calls load_body() for two files.
std::array<LoadedBody, 2> load_two_bodies(const std::string& a, const std::string& b,
                                          const BuildOptions& options = {},
                                          Corners corners = Corners::joined);

/// Flips inward-oriented surfaces and builds. Throws InputError with a list of the affected elements if that
/// is impossible. Adds the changes made to `notes`.
LrbRep build_from_mesh(CheckedMesh mesh, const BuildOptions& options, std::vector<std::string>& notes);

}  // namespace lrb::bodies

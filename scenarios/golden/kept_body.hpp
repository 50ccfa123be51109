#pragma once
/// Keeps the mesh of an approved body beside its golden, so that a later difference can be told: which
/// vertices moved, and by how much.

#include <cstdint>
#include <string>

#include "engine/lrb/lrb_rep.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::golden {

/// Returns the real faces of a body, with the numbers that its vertices have.
Mesh kept_mesh(const LrbRep& rep);
/// Returns a hash of everything but the name.
std::uint64_t mesh_hash(const Mesh& mesh);

/// Returns the file, in the golden's folder, that keeps body A (0) or B (1): a.ply, or a.obj of a 2D body.
std::string kept_file(std::size_t body, int dim);

/// Tells in one line how two meshes differ: vertices that moved, the farthest one first; or other numbers of
/// vertices and faces. Returns nothing if they are the same.
std::string mesh_difference(const Mesh& expected, const Mesh& found);

}  // namespace lrb::golden

#pragma once
/// Makes an LRB-rep of whatever mesh there is, and says what was done: what lrb::Body and the program have in
/// common.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/construct/build.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/mesh/checked_mesh.hpp"

namespace lrb {

struct MadeBody {
  LrbRep rep;
  std::vector<std::string> notes;  ///< what was done to it or could not be done; one line each, for people
  double build_seconds = 0;        ///< 0 if nothing was built
  std::uint32_t turned = 0;        ///< number of components that were inside out
};

/// Turns what is inside out, if `turn`, and builds; what cannot be an LRB-rep, or has one whose proof fails,
/// becomes a body without regions, and a note says why. Throws InputError if it cannot be queried at all.
MadeBody make_body(CheckedMesh mesh, const BuildOptions& options, bool turn = true);

/// Does the same without regions, for callers that ask only for pairs of faces, distances and the relation:
/// builds no LRB-rep, and proves nothing about the mesh that these answers do not need. Faces have the same
/// numbers.
MadeBody make_body_of_faces(CheckedMesh mesh, bool turn = true);

/// Returns a note with the first violation if the proof of an LRB-rep's cells fails (validate_cells()), or an
/// empty text if they are proven.
std::string note_unproven(const LrbRep& rep);
/// Returns the LRB-rep if its cells are proven; if not, its real faces without regions, and adds that note.
LrbRep proven(LrbRep rep, std::vector<std::string>& notes);

/// Turns what is inside out and returns the number of components. Adds a note if there were any.
std::uint32_t turn_outward(CheckedMesh& mesh, std::vector<std::string>& notes);

/// Says why there can be no LRB-rep of a mesh, even if it were turned.
std::string obstacles_to_build(const CheckedMesh& mesh);

/// Joins corners in exactly the same place where the surface is open there (join_corners.hpp). Returns a note
/// that says so; empty if there were none.
std::string join_corners_of_mesh(Mesh& mesh);

/// Returns true if a file says that it is an LRB-rep (by its first bytes, not its name).
bool is_lrb_file(const std::string& path);

}  // namespace lrb

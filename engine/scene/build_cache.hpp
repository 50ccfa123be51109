#pragma once
/// A folder of LRB-reps that were built before, so that a mesh is built once for many programs.
///
/// An entry is an .lrb file whose name consists of a hash of the mesh, the versions of lrbscope, its builder
/// and its file format, and the settings of the build. Programs can share the folder: an entry appears by
/// renaming a complete file, and any entry can be deleted at any time.

#include <optional>
#include <string>
#include <vector>

#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb {

/// Version of the builder. Raise it with every change that gives a mesh another LRB-rep
/// (tests/construct/determinism_test.cpp fails then).
inline constexpr unsigned kBuilderVersion = 3;

/// Returns the file name of the entry for a mesh and these settings, without the folder.
std::string cache_entry(const Mesh& mesh, const BuildOptions& options);

/// Returns the LRB-rep of a mesh from the folder `options.cache`, with its cells proven. Returns nullopt if
/// the folder has none, if no folder is set, or if a probe observes the build. Adds a note if an entry exists
/// but is damaged or belongs to another mesh.
std::optional<LrbRep> find_built(const Mesh& mesh, const BuildOptions& options,
                                 std::vector<std::string>& notes);

/// Keeps an LRB-rep built from the mesh in the folder, with its levels of detail, and makes the folder if it
/// is missing. Adds a note if that is impossible. Has no effect without a folder or with a probe that
/// observes the build.
void keep_built(const LrbRep& rep, const Mesh& mesh, const BuildOptions& options,
                std::vector<std::string>& notes);

}  // namespace lrb

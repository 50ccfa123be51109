#include "engine/scene/build_cache.hpp"

#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <lrbscope/body.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {
namespace {

/// A probe observes passes, which an entry does not have.
bool uses_cache(const BuildOptions& options) {
  return !options.cache.empty() && options.probe == nullptr;
}

std::string path_of(const Mesh& mesh, const BuildOptions& options) {
  return (std::filesystem::path(options.cache) / cache_entry(mesh, options)).string();
}

/// Returns true if the real faces are those of the mesh, with the same coordinates bit by bit. Hashes of
/// different meshes can be equal.
bool is_of_mesh(const LrbRep& rep, const Mesh& mesh) {
  const LrbData& d = rep.data();
  const auto begins_with = [](const auto& all, const auto& start) {
    return all.size() >= start.size() &&
           std::memcmp(all.data(), start.data(), start.size() * sizeof(start[0])) == 0;
  };
  return d.dim == mesh.dim && d.real_face_count == mesh.face_count() &&
         begins_with(d.face_offsets, mesh.face_offsets) && begins_with(d.face_vertices, mesh.face_vertices) &&
         begins_with(d.vertices, mesh.vertices);
}

}  // namespace

std::string cache_entry(const Mesh& mesh, const BuildOptions& options) {
  // One hash per array at memory bandwidth, then a hash of them.
  const auto hash_of_array = [](const auto& v) { return fnv64_of_words(v.data(), v.size() * sizeof(v[0])); };
  Fnv64 h;
  h.add_value(static_cast<std::uint32_t>(mesh.dim));
  h.add_value(hash_of_array(mesh.vertices));
  h.add_value(hash_of_array(mesh.face_offsets));
  h.add_value(hash_of_array(mesh.face_vertices));
  char name[160];
  std::snprintf(name, sizeof name,
                "%016" PRIx64 "-v" LRB_VERSION ".%u.%u-patch%u-outer%u-lids%u-seed%" PRIu64 "%s%s.lrb",
                h.value(), kBuilderVersion, kLrbFileVersion, options.patch_interior, options.max_outer_faces,
                options.max_lids, options.seed, options.lean ? "-lean" : "",
                options.merge_planes ? "-planes" : "");
  return name;
}

std::optional<LrbRep> find_built(const Mesh& mesh, const BuildOptions& options,
                                 std::vector<std::string>& notes) {
  if (!uses_cache(options)) return std::nullopt;
  const std::string path = path_of(mesh, options);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  std::string fault;
  try {
    LrbRep rep = load_lrb(path);
    rep.rename(mesh.name);
    fault = is_of_mesh(rep, mesh) ? note_unproven(rep) : "it belongs to another mesh";
    if (fault.empty()) return rep;
  } catch (const InputError& e) {
    // Another program may have deleted the entry since.
    if (!std::filesystem::exists(path, ignored)) return std::nullopt;
    fault = e.what();
  }
  notes.push_back(mesh.name + ": built again, because its cached LRB-rep cannot be used: " + fault);
  return std::nullopt;
}

void keep_built(const LrbRep& rep, const Mesh& mesh, const BuildOptions& options,
                std::vector<std::string>& notes) {
  if (!uses_cache(options)) return;
  const std::string path = path_of(mesh, options);
  // Names the folder alone, so that the notes of several bodies are equal.
  const auto note = [&](const std::string& fault) {
    notes.push_back((fault.starts_with(path) ? options.cache + fault.substr(path.size()) : fault) +
                    "; continuing without the cache of LRB-reps");
  };
  try {
    make_folder(options.cache);
    rep.levels(options.threads);  // coarse queries would compute them in every program
    save_lrb(rep, path);
  } catch (const EnvironmentError& e) {
    note(e.what());
  } catch (const InputError& e) {
    note(e.what());
  }
}

}  // namespace lrb

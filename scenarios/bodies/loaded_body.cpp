#include "scenarios/bodies/loaded_body.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <new>
#include <system_error>

#include <lrbscope/error.hpp>
namespace lrb::bodies {
namespace {

LoadedBody loaded(MadeBody made) {
  return {std::move(made.rep), std::move(made.notes), made.build_seconds};
}

LoadedBody saved_body(const std::string& path) {
  std::vector<std::string> notes;
  LrbRep rep = proven(load_lrb(path), notes);
  return {std::move(rep), std::move(notes), 0};
}

}  // namespace

LrbRep build_from_mesh(CheckedMesh mesh, const BuildOptions& options, std::vector<std::string>& notes) {
  if (!mesh.report().when_turned().buildable())
    throw InputError(mesh.mesh().name + ": cannot build an LRB-rep: " + obstacles_to_build(mesh) +
                     " | queries are still possible without it");
  turn_outward(mesh, notes);
  return build_lrb(mesh, options);
}

LoadedBody body_of_mesh(Mesh mesh, const BuildOptions& options) {
  return body_of_mesh(check(std::move(mesh)), options);
}

LoadedBody body_of_mesh(CheckedMesh mesh, const BuildOptions& options) {
  BuildOptions with_cache = options;
  const char* folder = std::getenv(kCacheVariable);
  if (options.cache.empty() && folder != nullptr) with_cache.cache = folder;
  return loaded(make_body(std::move(mesh), with_cache));
}

Mesh read_body(const std::string& path, Corners corners, std::vector<std::string>& notes) {
  Mesh mesh = read_mesh(path);
  if (corners == Corners::apart) return mesh;
  const std::string note = join_corners_of_mesh(mesh);
  if (!note.empty()) notes.push_back(note + " (--no-join keeps them separate)");
  return mesh;
}

LoadedBody load_body(const std::string& path, const BuildOptions& options, Corners corners) {
  if (is_lrb_file(path)) return saved_body(path);
  std::vector<std::string> notes;
  Mesh mesh = read_body(path, corners, notes);
  LoadedBody body = body_of_mesh(std::move(mesh), options);
  body.notes.insert(body.notes.begin(), notes.begin(), notes.end());
  return body;
}

LoadedBody load_faces(const std::string& path, Corners corners, unsigned threads) {
  if (is_lrb_file(path)) return saved_body(path);
  std::vector<std::string> notes;
  Mesh mesh = read_body(path, corners, notes);
  LoadedBody body = faces_of_mesh(std::move(mesh), threads);
  body.notes.insert(body.notes.begin(), notes.begin(), notes.end());
  return body;
}

LoadedBody faces_of_mesh(Mesh mesh, unsigned threads) {
  return loaded(make_body_of_faces(check(std::move(mesh)), true, threads));
}

namespace {

using Load = std::function<LoadedBody(const std::string&)>;

/// Loads B on a second thread. If no thread can be started, loads it afterwards.
std::array<LoadedBody, 2> load_at_once(const std::string& a, const std::string& b, const Load& load) {
  std::future<LoadedBody> second;
  try {
    second = std::async(std::launch::async, [&] { return load(b); });
  } catch (const std::system_error&) {
  }
  // If this throws, the destructor of `second` waits for the other thread.
  LoadedBody first = load(a);
  return {std::move(first), second.valid() ? second.get() : load(b)};
}

}  // namespace

std::array<LoadedBody, 2> load_two(const std::string& a, const std::string& b, const Load& load) {
  // Both paths may be the same pipe, whose reader must not be split.
  std::error_code ignored;
  const auto is_file = [&](const std::string& path) {
    return std::filesystem::is_regular_file(path, ignored);
  };
  const auto load_both = [&]() -> std::array<LoadedBody, 2> {
    if (is_file(a) && is_file(b)) try {
        return load_at_once(a, b, load);
      } catch (const std::bad_alloc&) {
        // One at a time needs less memory.
      }
    LoadedBody first = load(a);
    return {std::move(first), load(b)};
  };
  std::array<LoadedBody, 2> both = load_both();
  // A cache that cannot be used gives the same note for both, as do two bodies of one file.
  std::erase_if(both[1].notes, [&](const std::string& note) {
    return std::find(both[0].notes.begin(), both[0].notes.end(), note) != both[0].notes.end();
  });
  return both;
}

std::array<LoadedBody, 2> load_faces_of_two(const std::string& a, const std::string& b, Corners corners) {
  // The smaller file is ready first: the trees share all threads.
  return load_two(a, b, [=](const std::string& path) { return load_faces(path, corners, 0); });
}

std::array<LoadedBody, 2> load_two_bodies(const std::string& a, const std::string& b,
                                          const BuildOptions& options, Corners corners) {
  return load_two(a, b, [&](const std::string& path) { return load_body(path, options, corners); });
}

}  // namespace lrb::bodies

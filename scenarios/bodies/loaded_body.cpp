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

constexpr const char* kIfJoined = " (--no-join keeps them separate)";

/// Returns the options, with the environment's folder for the cache if they name none.
BuildOptions with_cache(BuildOptions options) {
  const char* folder = std::getenv(kCacheVariable);
  if (options.cache.empty() && folder != nullptr) options.cache = folder;
  return options;
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
  return make_body(std::move(mesh), with_cache(options));
}

Mesh read_body(const std::string& path, Corners corners, std::vector<std::string>& notes) {
  Mesh mesh = read_mesh(path);
  if (corners == Corners::apart) return mesh;
  const std::string note = join_corners_of_mesh(mesh);
  if (!note.empty()) notes.push_back(note + kIfJoined);
  return mesh;
}

LoadedBody load_body(const std::string& path, const BuildOptions& options, Corners corners) {
  return make_body_of_file(path, {.build = with_cache(options), .join = corners == Corners::joined},
                           kIfJoined);
}

LoadedBody load_faces(const std::string& path, Corners corners, unsigned threads) {
  BodyOptions options;
  options.regions = false;
  options.join = corners == Corners::joined;
  options.build.threads = threads;
  return make_body_of_file(path, options, kIfJoined);
}

LoadedBody faces_of_mesh(Mesh mesh, unsigned threads) {
  return make_body_of_faces(check(std::move(mesh)), true, threads);
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

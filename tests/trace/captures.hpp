#pragma once
/// Captures that the header lrbscope_capture.h records into memory.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <lrbscope/trace/capture.hpp>

#define LRBCAP_ENABLE
#include <lrbscope_capture.h>

namespace lrb::capture {

using Bytes = std::vector<std::byte>;
using Settings = std::map<std::string, std::string>;

inline int append(void* user, const void* bytes, std::uint64_t size) {
  auto& out = *static_cast<Bytes*>(user);
  const auto* from = static_cast<const std::byte*>(bytes);
  out.insert(out.end(), from, from + size);
  return 1;
}

/// Records the reports of `body`, with environment variables set.
inline Bytes record(const std::function<void()>& body, const Settings& settings = {}) {
  for (const char* name :
       {"LRBCAP_OUT", "LRBCAP_QUERIES", "LRBCAP_SLOWER_US", "LRBCAP_EVENTS", "LRBCAP_MAX_MB", "LRBCAP_EVERY"})
    unsetenv(name);
  for (const auto& [name, value] : settings) setenv(name.c_str(), value.c_str(), 1);
  Bytes out;
  LRBCAP_OPEN_SINK("engine 1", append, &out);
  body();
  LRBCAP_CLOSE();
  for (const auto& [name, value] : settings) unsetenv(name.c_str());
  return out;
}

inline Capture read(const Bytes& bytes, std::uint32_t first = 1, std::uint32_t last = kNull) {
  return parse_capture(bytes, "run.lrbcap", first, last);
}

// A mesh of four triangles and two trees of it: 0 has the children 1 and 2, each with two triangles.

inline constexpr double kXyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
inline constexpr std::uint32_t kCorners[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
inline constexpr std::uint32_t kFirstChild[] = {0, 2, 2, 2}, kChild[] = {1, 2};
inline constexpr std::uint32_t kFirstPrim[] = {0, 0, 2, 4}, kPrim[] = {0, 1, 2, 3};
inline constexpr double kBoxes[] = {0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 0.5, 0, 0, 0.25, 1, 1, 1};
inline constexpr float kSpheres[] = {0.5F, 0.5F, 0.5F, 1, 0, 0, 0, 2, 1, 1, 1, 3};
inline constexpr std::uint32_t kIds[] = {30, 10, 20};
inline constexpr double kPose[] = {0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6};

inline lrbcap_tree shape_of_tree(std::uint32_t mesh) {
  lrbcap_tree tree{};
  tree.mesh = mesh;
  tree.nodes = 3;
  tree.volume = LRBCAP_AABB;
  tree.first_child = kFirstChild;
  tree.child = kChild;
  tree.first_prim = kFirstPrim;
  tree.prim = kPrim;
  tree.volumes = kBoxes;
  return tree;
}
inline std::uint32_t a_mesh() {
  return LRBCAP_MESH("wedge", 4, kXyz, 4, kCorners);
}
inline std::uint32_t a_tree() {
  const lrbcap_tree tree = shape_of_tree(a_mesh());
  return LRBCAP_TREE(&tree);
}

/// Four instances of a body of the mesh above, two in each leaf, along x. The last one is turned and twice as
/// large.
inline std::uint32_t a_row(std::uint32_t body, std::uint32_t volume = LRBCAP_AABB) {
  static constexpr double kBoxesOfRow[] = {0, 0, 0, 8, 2, 2, 0, 0, 0, 3, 1, 1, 4, 0, 0, 8, 2, 2};
  static constexpr double kPoses[] = {1, 0, 0, 0, 0, 1,  0, 0, 0, 0, 1, 0, 1, 0, 0, 2,
                                      0, 1, 0, 0, 0, 0,  1, 0, 1, 0, 0, 4, 0, 1, 0, 0,
                                      0, 0, 1, 0, 0, -2, 0, 8, 2, 0, 0, 0, 0, 0, 2, 0};
  const std::uint32_t bodies[] = {body, body, body, body};
  lrbcap_tree tree = shape_of_tree(0);
  tree.volume = volume;
  tree.volumes = kBoxesOfRow;
  return LRBCAP_INSTANCES("row", &tree, 4, bodies, kPoses);
}

}  // namespace lrb::capture

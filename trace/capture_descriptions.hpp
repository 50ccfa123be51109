#pragma once
/// Reads the descriptions in a capture: names, meshes and trees.

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "trace/capture_chunks.hpp"
#include <lrbscope/trace/capture.hpp>

namespace lrb::capture {

inline constexpr double kRigid = 1e-6;  ///< of a rotation's determinant and of the products of its columns

class Descriptions : public Chunk {
 protected:
  using Chunk::Chunk;

  void read_name();
  void read_mesh();
  void read_tree();
  std::uint32_t index_of(const std::unordered_map<std::uint32_t, std::uint32_t>& ids, std::uint32_t id,
                         const char* what) const;

  Capture out_;
  std::unordered_map<std::uint32_t, std::uint32_t> names_, meshes_, trees_;  ///< index by id of the engine
  /// By tree: (id, node), sorted; empty if ids are our numbers. Of a tree of instances, its own nodes.
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> node_of_;

 private:
  /// Assigns an index to an id of the engine, which must be new.
  void define(std::unordered_map<std::uint32_t, std::uint32_t>& ids, std::uint32_t id, std::size_t index,
              const char* what);
  /// Reads n + 1 offsets and the indices to which they refer, which must be below `end`.
  void read_ranges(std::uint32_t n, std::uint32_t end, const char* what, std::vector<std::uint32_t>& offsets,
                   std::vector<std::uint32_t>& indices);
  /// Makes the table from the engine's numbers of nodes to ours.
  void index_nodes(const Tree& tree);
  /// Joins a tree of `count` instances, whose description continues with these and a name, with the trees of
  /// its bodies.
  void join_instances(Tree& tree, std::uint32_t count, std::uint32_t name_length);

  std::uint64_t joined_ = 0;  ///< nodes, vertices and triangles of all instances
};

}  // namespace lrb::capture

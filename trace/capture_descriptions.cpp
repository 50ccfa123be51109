#include "trace/capture_descriptions.hpp"

#include <algorithm>
#include <cmath>

#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>

namespace lrb::capture {
namespace {

/// Bits of the word of options of a TREE.
constexpr std::uint32_t kHasIds = 1, kFloatVolumes = 2, kSplits = 4;

/// Returns the number of doubles per volume; 0 for an unknown kind.
std::uint64_t numbers_of(std::uint32_t kind, std::uint64_t directions) {
  switch (static_cast<VolumeKind>(kind)) {
    case VolumeKind::aabb:
      return 6;
    case VolumeKind::sphere:
      return 4;
    case VolumeKind::obb:
      return 12;
    case VolumeKind::rss:
      return 10;
    case VolumeKind::kdop:
      return 2 * directions;
  }
  return 0;
}

}  // namespace

std::size_t Tree::numbers() const {
  return numbers_of(static_cast<std::uint32_t>(volume), directions.size());
}

void Descriptions::define(std::unordered_map<std::uint32_t, std::uint32_t>& ids, std::uint32_t id,
                          const char* what) {
  if (id == 0 || !ids.emplace(id, static_cast<std::uint32_t>(ids.size())).second)
    fail(std::string("expected a new id of a ") + what + " above 0, found " + text(id) +
         "; the file is damaged, or two programs wrote to it");
}

void Descriptions::read_name() {
  define(names_, u32(), "name");
  out_.names.push_back(printable_name(characters(left())));
}

void Descriptions::read_mesh() {
  define(meshes_, u32(), "mesh");
  const std::uint32_t vertices = u32(), triangles = u32(), length = u32();
  Mesh mesh;
  mesh.name = printable_name(characters(length));
  const std::vector<double> xyz = numbers<double>(std::uint64_t{3} * vertices);
  const std::vector<std::uint32_t> corners = numbers<std::uint32_t>(std::uint64_t{3} * triangles);
  mesh.vertices.reserve(vertices);
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    mesh.vertices.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
    if (!mesh.vertices.back().allFinite())
      fail("vertex " + text(i / 3) + ": expected finite numbers; describe the mesh as the engine has it");
  }
  mesh.triangles.reserve(triangles);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    for (const std::uint32_t v : mesh.triangles.back())
      if (v >= vertices)
        fail("triangle " + text(i / 3) + ": expected a vertex below " + text(vertices) + ", found " +
             text(v) + "; count vertices from 0");
  }
  out_.meshes.push_back(std::move(mesh));
}

void Descriptions::read_tree() {
  Tree tree;
  define(trees_, tree.id = u32(), "tree");
  const std::uint32_t mesh = u32(), replaces = u32(), nodes = u32(), kind = u32(), directions = u32();
  const std::uint32_t options = u32();
  u32();  // reserved
  tree.mesh = index_of(meshes_, mesh, "mesh");
  if (replaces != 0) {
    tree.replaces = index_of(trees_, replaces, "tree");
    if (replaces == tree.id) fail("tree " + text(tree.id) + " replaces itself; name the tree before it");
  }
  require(nodes != 0 && nodes != kNull, "expected at least one node; also describe the root");
  require((options & ~(kHasIds | kFloatVolumes | kSplits)) == 0,
          "unknown options of a tree; use a newer lrbscope");
  require(kind != static_cast<std::uint32_t>(VolumeKind::kdop) || directions <= left() / 24,
          "more directions than its content has room for; the file is damaged");
  const std::uint64_t per_node = numbers_of(kind, directions);
  if (per_node == 0)
    fail("expected a bounding volume of kind 1 (AABB) to 5 (k-DOP with directions), found kind " +
         text(kind) + "; see docs/capture.md");
  tree.volume = static_cast<VolumeKind>(kind);
  tree.splits = (options & kSplits) != 0;
  require(
      !tree.splits || (tree.volume != VolumeKind::sphere && tree.volume != VolumeKind::rss),
      "expected AABBs, OBBs or k-DOPs of a tree with spatial splits, found spheres or RSS; leave LRBCAP_SPLITS out");
  if ((options & kHasIds) != 0) tree.ids = numbers<std::uint32_t>(nodes);
  read_ranges(nodes, nodes, "child", tree.first_child, tree.child);
  read_ranges(nodes, kNull, "triangle", tree.first_triangle, tree.triangle);
  if ((options & kFloatVolumes) != 0) {
    const std::vector<float> floats = numbers<float>(nodes * per_node);
    tree.volumes.assign(floats.begin(), floats.end());
  } else {
    tree.volumes = numbers<double>(nodes * per_node);
  }
  for (std::size_t i = 0; i < tree.volumes.size(); ++i)
    if (!std::isfinite(tree.volumes[i]))
      fail("node " + text(i / per_node) + ": expected finite numbers of its volume, found " +
           io::number_text(tree.volumes[i]) + "; describe the volumes after the tree was built");
  if (tree.volume == VolumeKind::kdop) {
    const std::vector<double> xyz = numbers<double>(std::uint64_t{3} * directions);
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      tree.directions.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
      if (!tree.directions.back().allFinite() || tree.directions.back().isZero(0))
        fail("direction " + text(i / 3) + ": expected a finite vector that is not zero; see docs/capture.md");
    }
  }
  index_nodes(tree);
  out_.trees.push_back(std::move(tree));
}

void Descriptions::read_ranges(std::uint32_t n, std::uint32_t end, const char* what,
                               std::vector<std::uint32_t>& offsets, std::vector<std::uint32_t>& indices) {
  offsets = numbers<std::uint32_t>(std::uint64_t{n} + 1);
  const std::string of_kind = std::string("offsets of ") + what + " indices: ";
  if (offsets[0] != 0)
    fail(of_kind + "expected 0 first, found " + text(offsets[0]) + "; see docs/capture.md");
  for (std::uint32_t i = 0; i < n; ++i)
    if (offsets[i + 1] < offsets[i])
      fail(of_kind + "expected ascending numbers, found " + text(offsets[i + 1]) + " after " +
           text(offsets[i]) + " (node " + text(i) + "); give each node the range of its own");
  indices = numbers<std::uint32_t>(offsets[n]);
  if (end == kNull) return;
  const auto wrong = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= end; });
  if (wrong == indices.end()) return;
  const auto position = static_cast<std::uint32_t>(wrong - indices.begin());
  const auto node = std::upper_bound(offsets.begin(), offsets.end(), position) - offsets.begin() - 1;
  fail("node " + text(static_cast<std::uint64_t>(node)) + ": expected a " + what + " below " + text(end) +
       ", found " + text(*wrong) + "; children are indices of nodes, not ids");
}

void Descriptions::index_nodes(const Tree& tree) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>>& table = node_of_.emplace_back();
  for (std::uint32_t i = 0; i < tree.ids.size(); ++i) table.emplace_back(tree.ids[i], i);
  std::sort(table.begin(), table.end());
  for (std::size_t i = 1; i < table.size(); ++i)
    if (table[i].first == table[i - 1].first)
      fail("nodes " + text(table[i - 1].second) + " and " + text(table[i].second) + " have the same id, " +
           text(table[i].first) + "; give each node an id of its own");
}

std::uint32_t Descriptions::index_of(const std::unordered_map<std::uint32_t, std::uint32_t>& ids,
                                     std::uint32_t id, const char* what) const {
  const auto found = ids.find(id);
  if (found == ids.end())
    fail(std::string("refers to ") + what + " " + text(id) + ", which was not described; describe it before");
  return found->second;
}

}  // namespace lrb::capture

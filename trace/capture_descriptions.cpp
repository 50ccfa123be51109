#include "trace/capture_descriptions.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>

namespace lrb::capture {
namespace {

/// Bits of the word of options of a TREE.
constexpr std::uint32_t kHasIds = 1, kFloatVolumes = 2, kSplits = 4, kInstances = 8;

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

bool is_box(VolumeKind kind) {
  return kind == VolumeKind::aabb || kind == VolumeKind::obb;
}

/// Appends a moved volume: an AABB or OBB as an OBB, a sphere or RSS as an RSS. An empty AABB becomes a
/// point.
void append_moved(std::span<const double> n, VolumeKind kind, const Pose& map, std::vector<double>& out) {
  const auto vector = [&](std::size_t i) { return Eigen::Vector3d(n[i], n[i + 1], n[i + 2]); };
  const auto append = [&](const Eigen::Vector3d& x) { out.insert(out.end(), x.data(), x.data() + 3); };
  const Eigen::Vector3d half =
      kind == VolumeKind::aabb ? Eigen::Vector3d((vector(3) / 2 - vector(0) / 2).cwiseMax(0)) : vector(0);
  append(map.apply(kind == VolumeKind::aabb ? vector(0) / 2 + vector(3) / 2 : half));
  for (int k = 0; k < 3 && kind == VolumeKind::aabb; ++k) append(half[k] * map.r.col(k));
  for (std::size_t i = 3; i + 2 < n.size() && kind != VolumeKind::aabb; i += 3) append(map.r * vector(i));
  if (is_box(kind)) return;
  if (kind == VolumeKind::sphere) out.insert(out.end(), 6, 0);
  out.push_back(n.back() * map.r.colwise().norm().maxCoeff());
}

}  // namespace

std::string Tree::name_of_node(std::uint32_t node) const {
  const auto i = std::ranges::upper_bound(instances, node, {}, &Instance::first_node) - instances.begin();
  return text(id_of(node)) + (i == 0 ? "" : " of instance " + text(i - 1));
}
std::string Tree::name_of_triangle(std::uint32_t t) const {
  const auto i = std::ranges::upper_bound(instances, t, {}, &Instance::first_triangle) - instances.begin();
  return i == 0 ? text(t) : text(t - instances[i - 1].first_triangle) + " of instance " + text(i - 1);
}

std::size_t Tree::numbers() const {
  return numbers_of(static_cast<std::uint32_t>(volume), directions.size());
}

void Descriptions::define(std::unordered_map<std::uint32_t, std::uint32_t>& ids, std::uint32_t id,
                          std::size_t index, const char* what) {
  if (id == 0 || !ids.emplace(id, static_cast<std::uint32_t>(index)).second)
    fail(std::string("expected a new id of a ") + what + " above 0, found " + text(id) +
         "; the file is damaged, or two programs wrote to it");
}

void Descriptions::read_name() {
  define(names_, u32(), out_.names.size(), "name");
  out_.names.push_back(printable_name(characters(left())));
}

void Descriptions::read_mesh() {
  define(meshes_, u32(), out_.meshes.size(), "mesh");
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
  define(trees_, tree.id = u32(), out_.trees.size(), "tree");
  const std::uint32_t mesh = u32(), replaces = u32(), nodes = u32(), kind = u32(), directions = u32();
  const std::uint32_t options = u32(), name_length = u32();
  const bool of_instances = (options & kInstances) != 0;  // then `mesh` is their number
  if (!of_instances) tree.mesh = index_of(meshes_, mesh, "mesh");
  if (replaces != 0) {
    tree.replaces = index_of(trees_, replaces, "tree");
    if (replaces == tree.id) fail("tree " + text(tree.id) + " replaces itself; name the tree before it");
  }
  require(nodes != 0 && nodes != kNull, "expected at least one node; also describe the root");
  require((options & ~(kHasIds | kFloatVolumes | kSplits | kInstances)) == 0,
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
  read_ranges(nodes, of_instances ? mesh : kNull, of_instances ? "instance" : "triangle", tree.first_triangle,
              tree.triangle);
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
  if (of_instances) join_instances(tree, mesh, name_length);
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
  const bool of_nodes = std::string_view(what) == "child";
  fail("node " + text(static_cast<std::uint64_t>(node)) + ": expected " + (of_nodes ? "a " : "an ") + what +
       " below " + text(end) + ", found " + text(*wrong) + "; " +
       (of_nodes ? "children are indices of nodes, not ids" : "instances are numbered from 0"));
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

void Descriptions::join_instances(Tree& tree, std::uint32_t count, std::uint32_t name_length) {
  constexpr std::uint64_t kMax =
      8'000'000;  // more than can be checked: a small file must not fill the memory
  const std::vector<std::uint32_t> bodies = numbers<std::uint32_t>(count);
  const std::vector<double> poses = numbers<double>(std::uint64_t{12} * count);
  Mesh mesh;
  mesh.name = printable_name(characters(name_length));
  // Step 1: where the nodes and triangles of each body begin.
  bool same_kind = tree.volume != VolumeKind::kdop;
  std::uint32_t nodes = static_cast<std::uint32_t>(tree.size()), triangles = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t index = index_of(trees_, bodies[i], "tree");
    if (index == out_.trees.size() || !out_.trees[index].instances.empty())
      fail("instance " + text(i) + ": expected the tree of a mesh, found tree " + text(bodies[i]) +
           " of instances; join the two upper levels");
    const Tree& body = out_.trees[index];
    const Mesh& its = out_.meshes[body.mesh];
    joined_ += body.size() + its.triangles.size() + its.vertices.size();
    if (joined_ > kMax)
      fail(
          "instance " + text(i) +
          ": more than 8 million nodes, vertices and triangles of instances so far; record fewer bodies or frames");
    const auto lost =
        std::ranges::find_if(body.triangle, [&](std::uint32_t t) { return t >= its.triangles.size(); });
    if (lost != body.triangle.end())
      fail("instance " + text(i) + ": a leaf has triangle " + text(*lost) + ", its mesh has " +
           text(its.triangles.size()) + "; describe its tree alone for `lrbscope tree`");
    same_kind = same_kind && body.volume != VolumeKind::kdop && is_box(body.volume) == is_box(tree.volume);
    tree.splits = tree.splits || body.splits;
    tree.instances.push_back({index, nodes, triangles});
    nodes += static_cast<std::uint32_t>(body.size()),
        triangles += static_cast<std::uint32_t>(its.triangles.size());
  }
  require(
      same_kind,
      "expected AABBs and OBBs, or spheres and RSS, in the tree of instances and those of its bodies; describe "
      "others by their boxes");
  // Step 2: the tree's own nodes, whose leaves get the roots of the bodies as children.
  Tree out = tree;
  out.volume = is_box(tree.volume) ? VolumeKind::obb : VolumeKind::rss;
  out.child.clear(), out.triangle.clear(), out.volumes.clear();
  out.first_child = out.first_triangle = {0};
  const auto end_node = [&](const Tree& of, std::uint32_t n, const Pose& map) {
    append_moved(of.volume_of(n), of.volume, map, out.volumes);
    if (!std::all_of(out.volumes.end() - static_cast<std::ptrdiff_t>(out.numbers()), out.volumes.end(),
                     [](double x) { return std::isfinite(x); }))
      fail("node " + text(of.id_of(n)) + " of tree " + text(of.id) +
           ": expected a volume whose moved numbers are finite; see docs/capture.md");
    out.first_child.push_back(static_cast<std::uint32_t>(out.child.size()));
    out.first_triangle.push_back(static_cast<std::uint32_t>(out.triangle.size()));
  };
  for (std::uint32_t n = 0; n < tree.size(); ++n) {
    for (const std::uint32_t child : tree.children(n)) out.child.push_back(child);
    for (const std::uint32_t i : tree.triangles(n)) out.child.push_back(tree.instances[i].first_node);
    if (tree.ids.empty()) out.ids.push_back(n);
    end_node(tree, n, {});
  }
  // Step 3: the nodes, vertices and triangles of each body, moved.
  for (std::uint32_t i = 0; i < count; ++i) {
    const Instance& at = tree.instances[i];
    const Tree& body = out_.trees[at.tree];
    const Mesh& its = out_.meshes[body.mesh];
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> pose(&poses[12 * std::size_t{i}]);
    const Pose map{pose.leftCols<3>(), pose.col(3)};
    // The axes must stay orthogonal, and equally long unless the volumes are along them.
    const Eigen::Matrix3d products = map.r.transpose() * map.r;
    const Eigen::Vector3d lengths = products.diagonal();
    const double skew = (products - Eigen::Matrix3d(lengths.asDiagonal())).cwiseAbs().maxCoeff(),
                 scales = body.volume == VolumeKind::aabb ? 0 : lengths.maxCoeff() - lengths.minCoeff();
    bool valid =
        pose.allFinite() && lengths.minCoeff() > 0 && std::max(skew, scales) <= kRigid * lengths.minCoeff();
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3d& x : its.vertices) {
      mesh.vertices.emplace_back(map.apply(x));
      valid = valid && mesh.vertices.back().allFinite();
    }
    if (!valid)
      fail(
          "instance " + text(i) +
          ": expected a rotation, a translation and a scale, for AABBs one along each of their axes, without shear; "
          "poses are 12 doubles, 3x4 row by row");
    for (const auto& [a, b, c] : its.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
    for (std::uint32_t n = 0; n < body.size(); ++n) {
      for (const std::uint32_t child : body.children(n)) out.child.push_back(at.first_node + child);
      for (const std::uint32_t t : body.triangles(n)) out.triangle.push_back(at.first_triangle + t);
      out.ids.push_back(body.id_of(n));
      end_node(body, n, map);
    }
  }
  out.mesh = static_cast<std::uint32_t>(out_.meshes.size());
  out_.meshes.push_back(std::move(mesh));
  tree = std::move(out);
}

std::uint32_t Descriptions::index_of(const std::unordered_map<std::uint32_t, std::uint32_t>& ids,
                                     std::uint32_t id, const char* what) const {
  const auto found = ids.find(id);
  if (found == ids.end())
    fail(std::string("refers to ") + what + " " + text(id) + ", which was not described; describe it before");
  return found->second;
}

}  // namespace lrb::capture

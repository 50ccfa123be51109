// Broad phase among the faces of one mesh: self-traversal of a bounding volume hierarchy.
// 1. Usual meshes: an AABB tree (face_pairs.hpp).
// 2. Meshes whose AABBs overlap too much, because of large faces, high-valence vertices, or according to a
//    sample: a tree whose nodes have an OBB as well. The faces of a high-valence vertex form one subtree.
//    Pairs within it are found by their directions from that vertex (hubs.hpp), all other pairs by the
//    traversal.
#include "engine/mesh/face_pairs.hpp"

#include <algorithm>

namespace lrb {
namespace {

constexpr std::size_t kLeafFaces = 4;

std::vector<Box> boxes_of(const Mesh& mesh, const std::vector<FaceUse>& use) {
  std::vector<Box> boxes(mesh.face_count());
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    if (use[f] >= FaceUse::area)
      for (const VertexId v : mesh.face(f)) boxes[f].extend(mesh.vertices[v]);
  return boxes;
}

Box box_of_all(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes) all.extend(box);
  return all;
}

}  // namespace

FacePairs::FacePairs(const Mesh& mesh, const std::vector<FaceUse>& use)
    : mesh_(mesh),
      boxes_(boxes_of(mesh, use)),
      is_large_(mesh.face_count(), false),
      cube_(box_of_all(boxes_)),
      hubs_(mesh, use) {
  // Faces with very many corners are triangulated into a tree of their own (is_large()); 3D only.
  bool any_large = false;
  for (FaceId f = 0; mesh.dim == 3 && f < mesh.face_count(); ++f) {
    is_large_[f] = use[f] >= FaceUse::area && mesh.face(f).size() > kFewNeighbours;
    any_large = any_large || is_large_[f];
  }
  const bool known_to_be_crowded = any_large || !hubs_.hubs.empty();
  // Try AABBs first unless they are known to fail. The sample below needs that tree.
  if (!known_to_be_crowded) tree_.emplace(boxes_);
  if (known_to_be_crowded || (mesh.dim == 3 && boxes_are_crowded())) {
    tree_.reset();
    build();
  }
}

/// Returns true if AABBs overlap many boxes of faces other than their neighbours, estimated from a sample
/// across the mesh. This happens for long narrow faces close to each other, and for large faces close in
/// front of each other.
bool FacePairs::boxes_are_crowded() const {
  constexpr std::uint32_t kSamples = 256, kMax = 64;
  const auto faces = static_cast<std::uint32_t>(boxes_.size());
  if (faces <= kSamples) return false;
  // Evenly spaced sample. Each count is limited, which bounds the time of the sample.
  std::uint64_t meeting = 0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const auto face = static_cast<std::uint32_t>(std::uint64_t{i} * faces / kSamples);
    std::uint32_t others = 0;
    tree_->for_each_near(
        boxes_[face], [&](const Box&) { return others < 4 * kMax; },
        [&](std::uint32_t other) { others += other != face; });
    meeting += others;
  }
  return meeting > std::uint64_t{kSamples} * kMax;
}

std::vector<FacePairs::Unit> FacePairs::units() const {
  std::vector<Unit> units;
  std::vector<bool> at_hub(boxes_.size(), false);
  for (std::uint32_t h = 0; h < hubs_.hubs.size(); ++h) {
    // One unit per high-valence vertex, at the centre of all its faces.
    Box box;
    for (const FaceId f : hubs_.hubs[h].faces) {
      at_hub[f] = true;
      box.extend(boxes_[f]);
    }
    const auto faces = static_cast<std::uint32_t>(boxes_.size());
    if (!box.isEmpty()) units.push_back({faces + h, box_centre(box)});
  }
  // One unit for each other usable face.
  for (FaceId f = 0; f < boxes_.size(); ++f)
    if (!at_hub[f] && !boxes_[f].isEmpty()) units.push_back({f, box_centre(boxes_[f])});
  return units;
}

void FacePairs::build() {
  std::vector<Unit> all = units();
  if (all.empty()) return;
  order_.reserve(boxes_.size());
  build(all);
}

/// Computes the boxes of a node after all faces beneath it have been placed.
void FacePairs::close_node(std::uint32_t index) {
  Node& node = nodes_[index];
  node.last = static_cast<std::uint32_t>(order_.size());
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = node.first; i < node.last; ++i) {
    // All corners beneath the node, collected for each node: O(n log n) in total.
    node.box.extend(boxes_[order_[i]]);
    for (const VertexId v : mesh_.face(order_[i])) points.push_back(cube_(mesh_.vertices[v]));
  }
  node.slim = OrientedBox::about(points);
}

/// Builds a subtree in preorder. Returns its index.
std::uint32_t FacePairs::build(std::span<Unit> units) {
  // The faces of one high-valence vertex: a subtree whose inner pairs the traversal skips.
  if (units.size() == 1 && units[0].id >= boxes_.size()) {
    std::vector<Unit> faces;
    for (const FaceId f : hubs_.hubs[units[0].id - boxes_.size()].faces)
      faces.push_back({f, box_centre(boxes_[f])});
    const std::uint32_t index = build(faces);
    nodes_[index].of_one_hub = true;
    return index;
  }
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back().first = static_cast<std::uint32_t>(order_.size());
  const auto is_small = [&](const Unit& u) { return u.id < boxes_.size() && !is_large_[u.id]; };
  // A leaf has one unit, or a few small faces. A large face is alone in its leaf, so that its own OBB is
  // tested.
  if (units.size() == 1 ||
      (units.size() <= kLeafFaces && std::all_of(units.begin(), units.end(), is_small))) {
    for (const Unit& u : units) order_.push_back(FaceId(u.id));
  } else {
    const auto median = halve(units.begin(), units.end(), [](const Unit& u) { return u.centre; });
    const auto half = static_cast<std::size_t>(median - units.begin());
    // The left child is built first and thus follows its parent; only the right one needs an index.
    build(units.first(half));
    const std::uint32_t right = build(units.subspan(half));
    nodes_[index].right = right;
  }
  close_node(index);
  return index;
}

void FacePairs::for_each(const Visit& visit, Workers& workers) const {
  if (tree_) {
    return tree_->for_each_pair([&](std::uint32_t f, std::uint32_t g) { visit(FaceId(f), FaceId(g)); },
                                workers);
  }
  if (nodes_.empty()) return;
  // Pairs at one high-valence vertex by direction; all others by traversing the tree against itself.
  for (const Hubs::Hub& hub : hubs_.hubs)
    for_each_pair_at(
        mesh_, hub, [&](FaceId f, FaceId g) { try_pair(f, g, visit); }, workers);
  // The cheap test first; the separating axes of the OBBs (Gottschalk et al. 1996) only if it fails.
  const auto apart = [&](std::uint32_t m, std::uint32_t n) {
    const Node &a = nodes_[m], &b = nodes_[n];
    return !a.box.intersects(b.box) || proven_disjoint(a.slim, b.slim);
  };
  const auto at_leaves = [&](std::uint32_t m, std::uint32_t n) {
    const Node &a = nodes_[m], &b = nodes_[n];
    for (std::uint32_t i = a.first; i < a.last; ++i)
      for (std::uint32_t j = m == n ? i + 1 : b.first; j < b.last; ++j) try_pair(order_[i], order_[j], visit);
    return false;
  };
  descend_within(
      nodes_, 0, [&](std::uint32_t n) { return nodes_[n].of_one_hub; }, apart, at_leaves, workers);
}

void FacePairs::try_pair(FaceId f, FaceId g, const Visit& visit) const {
  if (boxes_[f].intersects(boxes_[g])) visit(std::min(f, g), std::max(f, g));
}

}  // namespace lrb

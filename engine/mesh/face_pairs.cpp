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
constexpr std::uint32_t kWorthSharing = 2048;  ///< faces

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

/// Splits a range at the median along the longest extent of the centres. Returns the index of the median.
template <class Item, class Centre>
std::size_t halve(std::vector<Item>& items, std::size_t first, std::size_t last, Centre centre) {
  Box spread;
  for (std::size_t i = first; i < last; ++i) spread.extend(centre(items[i]));
  int axis = 0;
  // Divide before subtracting, to avoid overflow.
  (spread.max() / 2 - spread.min() / 2).maxCoeff(&axis);
  // Median split: the depth is logarithmic for any distribution.
  const std::size_t median = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(median), at(last),
                   [&](const Item& a, const Item& b) { return centre(a)[axis] < centre(b)[axis]; });
  return median;
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
  for (std::uint32_t i = 0; i < kSamples; ++i)
    meeting +=
        tree_->count_meeting(static_cast<std::uint32_t>(std::uint64_t{i} * faces / kSamples), 4 * kMax);
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
    if (!box.isEmpty()) units.push_back({box.min() / 2 + box.max() / 2, h, kNull});
  }
  // One unit for each other usable face.
  for (FaceId f = 0; f < boxes_.size(); ++f)
    if (!at_hub[f] && !boxes_[f].isEmpty()) units.push_back({centre_of(f), kNull, f});
  return units;
}

void FacePairs::build() {
  std::vector<Unit> all = units();
  if (all.empty()) return;
  order_.reserve(boxes_.size());
  build_units(all, 0, all.size());
}

std::uint32_t FacePairs::add_node() {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back().first = static_cast<std::uint32_t>(order_.size());
  return index;
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
std::uint32_t FacePairs::build_units(std::vector<Unit>& units, std::size_t first, std::size_t last) {
  // The faces of one high-valence vertex: a subtree whose inner pairs the traversal skips.
  if (last - first == 1 && units[first].hub != kNull) {
    std::vector<FaceId> faces = hubs_.hubs[units[first].hub].faces;
    const std::uint32_t index = build_hub(faces, 0, faces.size());
    nodes_[index].of_one_hub = true;
    return index;
  }
  const std::uint32_t index = add_node();
  const auto is_small = [&](const Unit& u) { return u.hub == kNull && !is_large_[u.face]; };
  const auto begin = units.begin() + static_cast<std::ptrdiff_t>(first),
             end = units.begin() + static_cast<std::ptrdiff_t>(last);
  // A leaf has one unit, or a few small faces. A large face is alone in its leaf, so that its own OBB is
  // tested.
  if (last - first == 1 || (last - first <= kLeafFaces && std::all_of(begin, end, is_small))) {
    for (std::size_t i = first; i < last; ++i) order_.push_back(units[i].face);
  } else {
    // The left child is built first and thus follows its parent; only the right one needs an index.
    const std::size_t median = halve(units, first, last, [](const Unit& u) { return u.centre; });
    build_units(units, first, median);
    const std::uint32_t right = build_units(units, median, last);
    nodes_[index].right = right;
  }
  close_node(index);
  return index;
}

std::uint32_t FacePairs::build_hub(std::vector<FaceId>& faces, std::size_t first, std::size_t last) {
  const std::uint32_t index = add_node();
  // Same rule for leaves as in build_units().
  const bool is_leaf = last - first == 1 || (last - first <= kLeafFaces &&
                                             std::none_of(faces.begin() + static_cast<std::ptrdiff_t>(first),
                                                          faces.begin() + static_cast<std::ptrdiff_t>(last),
                                                          [&](FaceId f) { return is_large_[f]; }));
  if (is_leaf) {
    for (std::size_t i = first; i < last; ++i) order_.push_back(faces[i]);
  } else {
    const std::size_t median = halve(faces, first, last, [&](FaceId f) { return centre_of(f); });
    build_hub(faces, first, median);
    const std::uint32_t right = build_hub(faces, median, last);
    nodes_[index].right = right;
  }
  close_node(index);
  return index;
}

void FacePairs::for_each(const Visit& visit, Workers& workers) const {
  if (tree_) {
    const auto boxes_meet = [&](std::uint32_t f, std::uint32_t g) { visit(FaceId(f), FaceId(g)); };
    if (workers.count() == 1)
      tree_->for_each_pair(boxes_meet);
    else
      tree_->for_each_pair(boxes_meet, workers);
    return;
  }
  if (nodes_.empty()) return;
  // Pairs at one high-valence vertex by direction; all others by traversing the tree against itself.
  for (const Hubs::Hub& hub : hubs_.hubs)
    for_each_pair_at(
        mesh_, hub, [&](FaceId f, FaceId g) { try_pair(f, g, visit); }, workers);
  within(0, visit, workers);
}

void FacePairs::try_pair(FaceId f, FaceId g, const Visit& visit) const {
  if (boxes_[f].intersects(boxes_[g])) visit(std::min(f, g), std::max(f, g));
}

void FacePairs::within(std::uint32_t n, const Visit& visit, Workers& workers) const {
  const Node& node = nodes_[n];
  // Handled by for_each_pair_at().
  if (node.of_one_hub) return;
  if (node.right == 0) {
    for (std::uint32_t i = node.first; i < node.last; ++i)
      for (std::uint32_t j = i + 1; j < node.last; ++j) try_pair(order_[i], order_[j], visit);
    return;
  }
  // A pair is in the left child, in the right child, or across: three disjoint tasks.
  const auto left_side = [&] { within(n + 1, visit, workers); };
  const auto right_side = [&] { within(node.right, visit, workers); };
  const auto across = [&] { between(n + 1, node.right, visit); };
  if (node.last - node.first < kWorthSharing) {
    left_side();
    right_side();
    across();
  } else {
    workers.both([&] { workers.both(left_side, right_side); }, across);
  }
}

void FacePairs::between(std::uint32_t m, std::uint32_t n, const Visit& visit) const {
  descend(
      nodes_, m, n,
      // The cheap test first; the separating axes of the OBBs (Gottschalk et al. 1996) only if it fails.
      [](const Node& a, const Node& b) {
        return !a.box.intersects(b.box) || proven_disjoint(a.slim, b.slim);
      },
      [&](const Node& a, const Node& b) {
        for (std::uint32_t i = a.first; i < a.last; ++i)
          for (std::uint32_t j = b.first; j < b.last; ++j) try_pair(order_[i], order_[j], visit);
      });
}

}  // namespace lrb

// After it is built the tree is only refitted: boxes grow along the path to the root.

#include "engine/construct/aabb_tree.hpp"

namespace lrb::construct {

AabbTree::AabbTree(const FrontMesh& front)
    : AabbTree(front.alive_slots(), front.slot_count(), [&](Slot s) { return construct::box_of(front, s); }) {
}

AabbTree::AabbTree(std::vector<Slot> slots, std::size_t slot_count, const BoxOf& box_of)
    : BoxTree(std::move(slots), box_of), place_(slot_count, kNull), leaf_(leaves(slot_count)) {
  for (std::uint32_t i = 0; i < items().size(); ++i) place_[items()[i]] = i;
}

void AabbTree::rebuild(const FrontMesh& front) {
  *this = AabbTree();
  *this = AabbTree(front);
}

void AabbTree::update(Slot s, const Box& box) {
  // Refit upwards until an ancestor already contains the box. Boxes never shrink; fits() requests a rebuild
  // when too many slots are empty.
  boxes_[place_[s]] = box;
  for (std::uint32_t n = leaf_[s]; n != kNull && !nodes_[n].box.contains(box); n = nodes_[n].parent)
    nodes_[n].box.extend(box);
}

}  // namespace lrb::construct

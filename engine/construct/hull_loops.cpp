#include "engine/construct/hull_loops.hpp"

namespace lrb::construct {

HullLoops::HullLoops(const Mesh& mesh) : points_(mesh.vertices), off_(mesh.vertices.size(), 0) {
  // Every vertex has exactly one outgoing segment, which follows the one that ends there.
  std::vector<Slot> leaving(points_.size(), kNull);
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto c = mesh.face(f);
    segments_.push_back({c[0], c[1], kNull, kNull, f, kNull});
    leaving[c[0]] = f;
  }
  alive_ = slot_count();
  for (Slot s = 0; s < slot_count(); ++s) join(s, leaving[segments_[s].b]);
  // Each closed loop is one component.
  for (Slot first = 0; first < slot_count(); ++first) {
    if (segments_[first].component != kNull) continue;
    for (Slot s = first; segments_[s].component == kNull; s = segments_[s].next)
      segments_[s].component = components_;
    ++components_;
  }
}

std::vector<HullLoops::Slot> HullLoops::alive_slots() const {
  std::vector<Slot> slots;
  for (Slot s = 0; s < slot_count(); ++s)
    if (alive(s)) slots.push_back(s);
  return slots;
}

VertexId HullLoops::add_point(const Eigen::Vector3d& x, double off) {
  points_.push_back(x);
  off_.push_back(off);
  return static_cast<VertexId>(points_.size() - 1);
}

void HullLoops::remove(std::span<const Slot> slots) {
  for (const Slot s : slots) segments_[s].face = kNull;
  alive_ -= static_cast<std::uint32_t>(slots.size());
}

void HullLoops::place(Slot s, VertexId a, VertexId b, FaceId face, std::uint32_t component) {
  if (s == slot_count()) segments_.emplace_back();
  segments_[s] = {a, b, kNull, kNull, face, component};
  ++alive_;
}

}  // namespace lrb::construct

#include "engine/construct/bridging.hpp"

#include <algorithm>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/convex_hull.hpp"
#include "engine/construct/embed_check.hpp"
#include "engine/construct/hull_update.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb::construct {
namespace {

using Slot = HullMesh::Slot;
using Corner = HullMesh::Corner;

/// Returns the triangles of the convex hull of the slots' vertices; corners are the hull mesh's.
std::vector<PointTriangle> convex_hull_of(const HullMesh& hull, const std::vector<Slot>& slots) {
  std::vector<Corner> corners;
  for (const Slot s : slots) corners.insert(corners.end(), hull[s].v.begin(), hull[s].v.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector3d> points;
  for (const Corner c : corners) points.push_back(hull.x(c));
  std::vector<PointTriangle> triangles = convex_hull(points);
  for (PointTriangle& t : triangles)
    for (std::uint32_t& v : t) v = corners[v];
  return triangles;
}

PointTriangle smallest_first(const PointTriangle& t) {
  const int i = static_cast<int>(std::min_element(t.begin(), t.end()) - t.begin());
  return {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
}

bool are_clear(const HullMesh& hull, const std::vector<PointTriangle>& added) {
  const AabbTree tree(hull);
  std::vector<CheckedTriangle> checked;
  for (const PointTriangle& t : added)
    checked.emplace_back(hull.point(t[0]), hull.point(t[1]), hull.point(t[2]));
  for (std::size_t i = 0; i < checked.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (!checked[i].clear_of(checked[j])) return false;
    bool clear = true;
    tree.for_each_in(checked[i].box, [&](Slot s) {
      const auto& v = hull[s].v;
      clear = clear && checked[i].clear_of({hull.point(v[0]), hull.point(v[1]), hull.point(v[2])});
    });
    if (!clear) return false;
  }
  return true;
}

}  // namespace

bool bridge_concavities(HullMesh& hull, ComplexBuilder& complex, const std::vector<bool>& joined,
                        std::uint16_t layer) {
  std::vector<Slot> slots = hull.alive_slots();
  std::erase_if(slots, [&](Slot s) { return !joined[hull[s].component]; });
  std::vector<PointTriangle> added = convex_hull_of(hull, slots);
  if (added.empty()) return false;
  for (PointTriangle& t : added) t = smallest_first(t);
  std::sort(added.begin(), added.end());
  // Triangles that are in both stay.
  std::vector<PointTriangle> kept;
  std::vector<Slot> removed;
  for (const Slot s : slots) {
    const PointTriangle t = smallest_first(hull[s].v);
    if (std::binary_search(added.begin(), added.end(), t))
      kept.push_back(t);
    else
      removed.push_back(s);
  }
  if (static_cast<double>(added.size()) > kLastCapWorth * static_cast<double>(slots.size())) return false;
  std::sort(kept.begin(), kept.end());
  std::erase_if(added,
                [&](const PointTriangle& t) { return std::binary_search(kept.begin(), kept.end(), t); });
  if (removed.empty() || !are_clear(hull, added)) return false;
  const std::uint32_t component = hull[slots[0]].component;
  for (const Slot s : slots) hull.set_component(s, component);
  cover(hull, complex, make_sheet(hull, removed, added), layer, component);
  return true;
}

}  // namespace lrb::construct

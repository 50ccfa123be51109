// Bridging: replaces the front of a set of components by their convex hull.
// 1. Compute the exact convex hull of the front's vertices.
// 2. Compare triangles: those in both stay, other hull triangles are added, other front triangles are
// covered.
// 3. Verify that this makes the front simpler and keeps it embedded.
// 4. The space between, split into pockets, becomes regions; the components become one.

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
  // Each vertex once, in ascending order: the result depends on the set of slots only.
  std::vector<Corner> corners;
  for (const Slot s : slots) corners.insert(corners.end(), hull[s].v.begin(), hull[s].v.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector3d> points;
  for (const Corner c : corners) points.push_back(hull.x(c));
  std::vector<PointTriangle> triangles = convex_hull(points);
  // Map point indices back to vertices of the front.
  for (PointTriangle& t : triangles)
    for (std::uint32_t& v : t) v = corners[v];
  return triangles;
}

PointTriangle smallest_first(const PointTriangle& t) {
  // Canonical rotation: equal triangles compare equal, and the orientation is preserved.
  const int i = static_cast<int>(std::min_element(t.begin(), t.end()) - t.begin());
  return {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
}

CapVerdict judge(const HullMesh& hull, const std::vector<PointTriangle>& added) {
  // A fresh tree: all of its slots are alive.
  const AabbTree tree(hull);
  std::vector<CheckedTriangle> checked;
  for (const PointTriangle& t : added)
    checked.emplace_back(hull.point(t[0]), hull.point(t[1]), hull.point(t[2]));
  for (std::size_t i = 0; i < checked.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      // Triangles of a convex hull can overlap only through vertices in one plane, or vertices with equal
      // coordinates.
      if (!checked[i].clear_of(checked[j])) return CapVerdict::meets_itself;
    // Against the whole front, covered triangles included: the lid may meet its floor in shared vertices and
    // edges only.
    bool clear = true;
    tree.for_each_in(checked[i].box, [&](Slot s) {
      const auto& v = hull[s].v;
      clear = clear && checked[i].clear_of({hull.point(v[0]), hull.point(v[1]), hull.point(v[2])});
    });
    if (!clear) return CapVerdict::meets_hull;
  }
  return CapVerdict::stands;
}

/// The faces of the convex hull that are not the hull's own already, and what they cover.
struct Bridge {
  std::vector<PointTriangle> added;
  std::vector<Slot> removed;
};

/// Finds them, among all faces of the convex hull, which are ascending. Triangles that are in both stay.
Bridge find_bridge(const HullMesh& hull, const std::vector<Slot>& slots, std::vector<PointTriangle> convex) {
  Bridge bridge;
  std::vector<PointTriangle> kept;
  for (const Slot s : slots) {
    const PointTriangle t = smallest_first(hull[s].v);
    // A triangle of the front that is on the convex hull already: no pocket beneath it.
    if (std::binary_search(convex.begin(), convex.end(), t))
      kept.push_back(t);
    else
      // It lies beneath the convex hull, as the floor of a pocket.
      bridge.removed.push_back(s);
  }
  std::sort(kept.begin(), kept.end());
  std::erase_if(convex,
                [&](const PointTriangle& t) { return std::binary_search(kept.begin(), kept.end(), t); });
  bridge.added = std::move(convex);
  return bridge;
}

/// Returns true if the bridge covers some triangles of a polygon, but not all of them. In the complex a
/// polygon is one face, which has one cell in front of it.
bool splits_polygon(const HullMesh& hull, const Bridge& bridge) {
  // Each polygon with a covered triangle must have all of its triangles covered.
  std::vector<bool> removed(hull.slot_count(), false);
  for (const Slot s : bridge.removed) removed[s] = true;
  return std::any_of(bridge.removed.begin(), bridge.removed.end(), [&](Slot s) {
    const auto [first, last] = hull.unit(s);
    return !std::all_of(removed.begin() + first, removed.begin() + last, [](bool r) { return r; });
  });
}

CapVerdict judge(const HullMesh& hull, const std::vector<Slot>& slots, std::size_t convex_faces,
                 const Bridge& bridge) {
  // The vertices are coplanar.
  if (convex_faces == 0) return CapVerdict::flat;
  // The same threshold as for caps: the result must have clearly fewer triangles.
  const bool worth = static_cast<double>(convex_faces) <= kLastCapWorth * static_cast<double>(slots.size());
  if (!worth || bridge.removed.empty()) return CapVerdict::too_many_faces;
  // A polygon that is not planar can have one triangle on the convex hull and another below it.
  if (splits_polygon(hull, bridge)) return CapVerdict::splits_polygon;
  // The expensive exact tests come last.
  return judge(hull, bridge.added);
}

}  // namespace

CapVerdict bridge_concavities(HullMesh& hull, ComplexBuilder& complex, const std::vector<bool>& joined,
                              std::uint16_t layer, ConstructProbe* probe) {
  // Step 1: the convex hull over the chosen components.
  std::vector<Slot> slots = hull.alive_slots();
  std::erase_if(slots, [&](Slot s) { return !joined[hull[s].component]; });
  std::vector<PointTriangle> convex = convex_hull_of(hull, slots);
  // Step 2: sort the canonical triangles, so that membership is a binary search.
  for (PointTriangle& t : convex) t = smallest_first(t);
  std::sort(convex.begin(), convex.end());
  const std::size_t convex_faces = convex.size();
  const Bridge bridge = find_bridge(hull, slots, std::move(convex));
  // Step 3.
  const CapVerdict verdict = judge(hull, slots, convex_faces, bridge);
  if (probe) {
    probe->patch({hull.point(hull[slots[0]].v[0]).id, static_cast<std::uint32_t>(slots.size()), 0});
    probe->cap({static_cast<std::uint32_t>(bridge.added.size()),
                static_cast<std::uint32_t>(bridge.removed.size()), verdict, false, -1});
  }
  if (verdict != CapVerdict::stands) return verdict;
  // Step 4: relabel first, so that lids and remaining triangles share a component.
  const std::uint32_t component = hull[slots[0]].component;
  for (const Slot s : slots) hull.set_component(s, component);
  cover(hull, complex, make_sheet(hull, bridge.removed, bridge.added), layer, component, probe);
  return verdict;
}

}  // namespace lrb::construct

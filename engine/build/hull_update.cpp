#include "engine/build/hull_update.hpp"

#include <algorithm>

namespace lrb {
namespace {

using Slot = HullMesh::Slot;
using Corner = HullMesh::Corner;

/// What both sheets are made of, with vertices numbered from 0.
struct Sheets {
  std::vector<Corner> corners;  ///< ascending
  std::vector<Eigen::Vector3d> points;
  std::vector<PointTriangle> old, added;
  std::vector<FaceId> old_face;
};

Sheets gather(const HullMesh& hull, std::span<const Slot> removed, std::span<const PointTriangle> added) {
  Sheets s;
  for (const Slot slot : removed) s.corners.insert(s.corners.end(), hull[slot].v.begin(), hull[slot].v.end());
  for (const PointTriangle& t : added) s.corners.insert(s.corners.end(), t.begin(), t.end());
  std::sort(s.corners.begin(), s.corners.end());
  s.corners.erase(std::unique(s.corners.begin(), s.corners.end()), s.corners.end());
  for (const Corner c : s.corners) s.points.push_back(hull.x(c));
  const auto local = [&](const PointTriangle& t) {
    PointTriangle out;
    for (int i = 0; i < 3; ++i)
      out[i] = static_cast<std::uint32_t>(std::lower_bound(s.corners.begin(), s.corners.end(), t[i]) -
                                          s.corners.begin());
    return out;
  };
  for (const Slot slot : removed) {
    s.old.push_back(local(hull[slot].v));
    s.old_face.push_back(hull[slot].face);
  }
  for (const PointTriangle& t : added) s.added.push_back(local(t));
  return s;
}

}  // namespace

std::vector<Slot> cover(HullMesh& hull, ComplexBuilder& complex, std::span<const Slot> removed_slots,
                        std::span<const PointTriangle> added, std::uint16_t layer, std::uint32_t component) {
  std::vector<Slot> removed(removed_slots.begin(), removed_slots.end());
  std::sort(removed.begin(), removed.end());  // triangles of one polygon become neighbours
  const Sheets sheets = gather(hull, removed, added);
  const RegionPieces pieces = split_region(sheets.old, sheets.old_face, sheets.added, sheets.points);
  const RegionId first_region = complex.region_count();
  for (std::uint32_t p = 0; p < pieces.count; ++p) complex.add_region(layer);
  for (std::size_t i = 0; i < removed.size(); ++i)
    complex.set_outer_cell(hull[removed[i]].face, first_region + pieces.of_old[i]);

  std::vector<Slot> slots;
  for (std::size_t i = 0; i < added.size(); ++i)
    slots.push_back(i < removed.size() ? removed[i]
                                       : hull.slot_count() + static_cast<Slot>(i - removed.size()));
  // Beyond an edge lies another new triangle or, at the boundary, what lay beyond the old one.
  const EdgeIndex old_edges(sheets.old), added_edges(sheets.added);
  std::vector<HullMesh::Triangle> triangles(added.size());
  for (std::size_t i = 0; i < added.size(); ++i) {
    HullMesh::Triangle& t = triangles[i];
    VertexId ids[3];
    for (int k = 0; k < 3; ++k) {
      t.v[k] = added[i][k];
      ids[k] = hull.point(t.v[k]).id;
      const std::uint32_t a = sheets.added[i][k], b = sheets.added[i][(k + 1) % 3];
      const std::uint32_t beside = added_edges.find(b, a);
      if (beside != kNull) {
        t.across[k] = slots[beside];
      } else {
        const Slot old = removed[old_edges.find(a, b)];
        t.across[k] = hull[old].across[hull.index_of(old, t.v[k])];
        hull.link(t.across[k], added[i][(k + 1) % 3], slots[i]);
      }
    }
    t.face = complex.add_pseudo_face(ids, first_region + pieces.of_added[i], kOutside);
    t.component = component;
  }
  hull.remove(removed);
  for (std::size_t i = 0; i < added.size(); ++i) hull.add(slots[i], triangles[i]);
  return slots;
}

std::vector<Slot> cover(HullMesh& hull, ComplexBuilder& complex, const Patch& patch, const CapSurface& cap,
                        std::uint16_t layer, std::size_t& new_count) {
  std::vector<Corner> corners(cap.vertex_count(), kNull);
  for (int v = 0; v < cap.vertex_count(); ++v) {
    if (!cap.is_used(v)) continue;
    corners[v] = v < cap.first_new() ? cap.corner(v) : hull.add_point(cap.x(v), complex.add_vertex(cap.x(v)));
  }
  std::vector<bool> stays(patch.slots.size(), false);
  std::vector<PointTriangle> added;
  std::vector<Slot> removed, kept;
  for (const auto& f : cap.faces()) {
    if (!f.alive) continue;
    if (f.kept >= 0)
      stays[f.kept] = true;
    else
      added.push_back({corners[f.v[0]], corners[f.v[1]], corners[f.v[2]]});
  }
  for (std::size_t i = 0; i < patch.slots.size(); ++i) (stays[i] ? kept : removed).push_back(patch.slots[i]);
  std::vector<Slot> slots = cover(hull, complex, removed, added, layer, hull[patch.slots[0]].component);
  new_count = slots.size();
  slots.insert(slots.end(), kept.begin(), kept.end());
  return slots;
}

}  // namespace lrb

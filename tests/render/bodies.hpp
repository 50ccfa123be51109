#pragma once
/// LRB-reps made by hand, with the regions known: dents under lids.

#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::test {

using namespace shapes;

/// A convex body whose every face is a lid over a dent (a pyramid pressed inward, 2D: a notch), whose faces
/// are again lids over smaller dents, and so on: `levels` layers of regions, the outermost has the highest
/// number.
inline LrbRep dented(const Mesh& convex, int levels, double depth = 0.35) {
  LrbData d;
  d.dim = convex.dim;
  d.closed = true;
  d.name = "dented";
  d.vertices = convex.vertices;
  struct Face {
    std::vector<VertexId> corners;
    CellId inner, outer;
  };
  std::vector<Face> current, pseudo;
  for (FaceId f = 0; f < convex.face_count(); ++f) {
    current.push_back({{convex.face(f).begin(), convex.face(f).end()}, kSolid, kOutside});
  }
  for (int level = 0; level < levels; ++level) {
    std::vector<Face> floor;
    for (Face& lid : current) {
      const auto region = static_cast<RegionId>(d.region_layer.size());
      d.region_layer.push_back(static_cast<std::uint16_t>(levels - 1 - level));
      const auto x = [&](std::size_t i) -> const Eigen::Vector3d& { return d.vertices[lid.corners[i]]; };
      Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
      for (const VertexId v : lid.corners)
        centroid += d.vertices[v] / static_cast<double>(lid.corners.size());
      const Eigen::Vector3d along = x(1) - x(0);
      const Eigen::Vector3d outward = convex.dim == 2 ? Eigen::Vector3d(along.y(), -along.x(), 0).normalized()
                                                      : along.cross(x(2) - x(0)).normalized();
      const auto apex = static_cast<VertexId>(d.vertices.size());
      d.vertices.push_back(centroid - depth * along.norm() * outward);
      const std::size_t sides = convex.dim == 2 ? 1 : lid.corners.size();
      for (std::size_t i = 0; i < sides; ++i) {
        const VertexId a = lid.corners[i], b = lid.corners[(i + 1) % lid.corners.size()];
        if (convex.dim == 2) {
          floor.push_back({{a, apex}, kSolid, region});
          floor.push_back({{apex, b}, kSolid, region});
        } else {
          floor.push_back({{a, b, apex}, kSolid, region});
        }
      }
      lid.inner = region;
      pseudo.push_back(lid);
    }
    current = std::move(floor);
    depth *= 0.6;
  }
  const auto add = [&](const Face& f) {
    d.face_vertices.insert(d.face_vertices.end(), f.corners.begin(), f.corners.end());
    d.face_offsets.push_back(static_cast<std::uint32_t>(d.face_vertices.size()));
    d.inner_cell.push_back(f.inner);
    d.outer_cell.push_back(f.outer);
  };
  for (const Face& f : current) add(f);
  d.real_face_count = static_cast<std::uint32_t>(current.size());
  for (const Face& f : pseudo) add(f);
  return LrbRep(std::move(d));
}

}  // namespace lrb::test

#include "scenarios/bodies/resolutions.hpp"

#include <algorithm>
#include <array>

#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::resolutions {
namespace {

/// An edge, relative to one of its two faces.
struct HalfEdge {
  VertexId low, high;   ///< its ends
  VertexId tip;         ///< the face's third corner
  std::uint32_t place;  ///< half-edge index: 3 * face + side
};

std::vector<HalfEdge> half_edges(const Mesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.face_count());
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto v = mesh.face(f);
    for (std::uint32_t i = 0; i < 3; ++i) {
      const VertexId a = v[i], b = v[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), v[(i + 2) % 3], 3 * f + i});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
    if (x.low != y.low) return x.low < y.low;
    return x.high != y.high ? x.high < y.high : x.place < y.place;
  });
  return edges;
}

}  // namespace

Mesh subdivide(const Mesh& mesh) {
  const std::vector<HalfEdge> edges = half_edges(mesh);
  Mesh out;
  out.name = mesh.name;
  const auto old_count = static_cast<std::uint32_t>(mesh.vertices.size());
  std::vector<Eigen::Vector3d> sum(old_count, Eigen::Vector3d::Zero());  // of the neighbours
  std::vector<std::uint32_t> degree(old_count, 0);
  std::vector<VertexId> midpoint(edges.size());  // by half-edge index
  std::vector<Eigen::Vector3d> added;
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const HalfEdge &e = edges[i], &other = edges[i + 1];
    const Eigen::Vector3d &a = mesh.vertices[e.low], &b = mesh.vertices[e.high];
    sum[e.low] += b;
    sum[e.high] += a;
    ++degree[e.low];
    ++degree[e.high];
    midpoint[e.place] = midpoint[other.place] = VertexId(old_count + added.size());
    added.push_back((3 * (a + b) + mesh.vertices[e.tip] + mesh.vertices[other.tip]) / 8);
  }
  out.vertices.reserve(old_count + added.size());
  for (VertexId v = 0; v < old_count; ++v) {
    const double n = degree[v], beta = n == 3 ? 3.0 / 16 : 3.0 / (8 * n);  // Warren's weight
    out.vertices.push_back(n == 0 ? mesh.vertices[v]
                                  : Eigen::Vector3d((1 - n * beta) * mesh.vertices[v] + beta * sum[v]));
  }
  out.vertices.insert(out.vertices.end(), added.begin(), added.end());
  out.face_offsets.reserve(4 * mesh.face_count() + 1);
  out.face_vertices.reserve(12 * mesh.face_count());
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto v = mesh.face(f);
    const VertexId* m = &midpoint[3 * f];  // on the edges v0 v1, v1 v2, v2 v0
    for (const auto& t : std::array<std::array<VertexId, 3>, 4>{
             {{v[0], m[0], m[2]}, {v[1], m[1], m[0]}, {v[2], m[2], m[1]}, {m[0], m[1], m[2]}}})
      out.add_face(t);
  }
  return out;
}

std::vector<std::uint32_t> resolution_sizes(const Mesh& mesh, const ResolutionOptions& options) {
  std::uint32_t n = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
    n += static_cast<std::uint32_t>(mesh.face(FaceId(f)).size()) - 2;
  n <<= 2 * options.subdivisions;
  std::vector<std::uint32_t> sizes = {n};
  for (n /= 2; n >= options.min_faces && sizes.size() < options.most; n /= 2) sizes.push_back(n);
  return sizes;
}

std::vector<Mesh> resolutions(const Mesh& mesh, const ResolutionOptions& options) {
  const MeshReport report = check_mesh(mesh, false).when_turned();
  if (mesh.dim != 3) throw InputError(mesh.name + ": expected a 3D body, found a 2D body");
  if (!report.buildable()) {
    const std::vector<std::string> obstacles = report.obstacles(mesh);
    throw InputError(obstacles.empty() ? mesh.name + ": cannot build an LRB-rep" : obstacles.front());
  }
  const std::uint32_t all[] = {~0u};
  Mesh finest = decimate(mesh, all).front();  // without any collapse: only triangulates polygons
  for (std::uint32_t i = 0; i < options.subdivisions; ++i) finest = subdivide(finest);
  orient_outward(finest);
  const std::vector<std::uint32_t> sizes = resolution_sizes(mesh, options);
  std::vector<Mesh> out = decimate(finest, std::span(sizes).subspan(1));
  out.insert(out.begin(), std::move(finest));
  return out;
}

}  // namespace lrb::resolutions

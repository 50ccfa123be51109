#include "scenarios/bodies/resolutions.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include <Eigen/Core>

#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::resolutions {
namespace {

/// Returns faces of an LRB-rep, in triangles, as a mesh of their own.
Mesh surface_of(const LrbRep& rep, std::span<const FaceId> faces) {
  Mesh out;
  out.name = rep.name();
  std::vector<VertexId> number(rep.vertices().size(), kNull);
  for (const FaceId f : faces)
    for (SimplexId s = rep.first_simplex(f); s < rep.simplex_count() && rep.face_of_simplex(s) == f; ++s) {
      VertexId corners[3];
      rep.simplex(s, corners);
      for (VertexId& v : corners) {
        if (number[v] == kNull) {
          number[v] = static_cast<VertexId>(out.vertices.size());
          out.vertices.push_back(rep.vertices()[v]);
        }
        v = number[v];
      }
      out.add_face(corners);
    }
  return out;
}

}  // namespace

Wrapper wrapper_of_faces(const LrbRep& rep, std::uint32_t most) {
  std::vector<double> deviation(rep.region_count());
  if (rep.region_count() > 0) {
    const std::span<const double> needed = rep.levels(0).needed();
    for (RegionId r = 0; r < rep.region_count(); ++r)
      deviation[r] = needed.empty() ? rep.layer(r) : needed[r];
  }
  std::vector<RegionId> order(rep.region_count());
  std::iota(order.begin(), order.end(), RegionId{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](RegionId x, RegionId y) { return deviation[x] > deviation[y]; });
  std::vector<std::uint8_t> on_boundary(rep.face_count());
  for (const FaceId f : rep.outermost_faces()) on_boundary[f] = 1;
  std::size_t size = rep.outermost_faces().size(), best = size <= most ? 0 : order.size() + 1;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (const FaceId f : rep.collector(order[i])) {
      on_boundary[f] ^= 1;
      size = on_boundary[f] != 0 ? size + 1 : size - 1;
    }
    const bool whole = i + 1 == order.size() || deviation[order[i + 1]] < deviation[order[i]];
    if (whole && size <= most) best = i + 1;
  }
  if (best > order.size())
    throw InputError("--faces " + std::to_string(most) + ": the outermost wrapper has " +
                     std::to_string(rep.outermost_faces().size()) + " faces");
  Wrapper wrapper(rep);
  for (std::size_t i = 0; i < best; ++i) wrapper.refine(order[i]);
  return wrapper;
}

Mesh subdivide(const Mesh& mesh) {
  const auto old_count = static_cast<std::uint32_t>(mesh.vertices.size());
  std::vector<Eigen::Vector3d> sum(old_count, Eigen::Vector3d::Zero());  // of the neighbours
  std::vector<std::uint32_t> degree(old_count, 0);
  std::map<std::pair<VertexId, VertexId>, VertexId> midpoints;  // by the ends of their edges
  std::vector<Eigen::Vector3d> added;                           // eight times the new vertices
  Mesh out;
  out.name = mesh.name;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto v = mesh.face(f);
    VertexId m[3];  // on the edges v0 v1, v1 v2, v2 v0
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId a = v[i], b = v[(i + 1) % 3], tip = v[(i + 2) % 3];
      const auto [it, fresh] = midpoints.try_emplace(std::minmax(a, b), VertexId(old_count + added.size()));
      m[i] = it->second;
      if (fresh) {
        added.emplace_back(3 * (mesh.vertices[a] + mesh.vertices[b]));
        for (const auto& [end, other] : {std::pair(a, b), std::pair(b, a)}) {
          sum[end] += mesh.vertices[other];
          ++degree[end];
        }
      }
      added[m[i] - old_count] += mesh.vertices[tip];
    }
    for (const auto& t : std::array<std::array<VertexId, 3>, 4>{
             {{v[0], m[0], m[2]}, {v[1], m[1], m[0]}, {v[2], m[2], m[1]}, {m[0], m[1], m[2]}}})
      out.add_face(t);
  }
  for (VertexId v = 0; v < old_count; ++v) {
    const double n = degree[v], beta = n == 3 ? 3.0 / 16 : 3.0 / (8 * n);  // Warren's weight
    out.vertices.push_back(n == 0 ? mesh.vertices[v]
                                  : Eigen::Vector3d((1 - n * beta) * mesh.vertices[v] + beta * sum[v]));
  }
  for (const Eigen::Vector3d& x : added) out.vertices.emplace_back(x / 8);
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
  Mesh outward = mesh;
  orient_outward(outward);
  const LrbRep bare = LrbRep::without_regions(outward, true, false);
  Mesh finest = surface_of(bare, bare.outermost_faces());
  for (std::uint32_t i = 0; i < options.subdivisions; ++i) finest = subdivide(finest);
  std::vector<Mesh> out = {finest};
  const std::vector<std::uint32_t> sizes = resolution_sizes(mesh, options);
  if (sizes.size() == 1) return out;
  const LrbRep rep = build_lrb(finest, {});
  for (const std::uint32_t faces : std::span(sizes).subspan(1)) {
    if (rep.outermost_faces().size() > faces) break;
    Mesh coarser = surface_of(rep, wrapper_of_faces(rep, faces).boundary());
    if (4 * coarser.face_count() < std::size_t{3} * faces) break;  // no wrapper has about so many
    out.push_back(std::move(coarser));
  }
  return out;
}

}  // namespace lrb::resolutions

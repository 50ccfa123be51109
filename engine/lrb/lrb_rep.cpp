#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/lrb/complex.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include "engine/mesh/self_intersections.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {
namespace {

[[noreturn]] void reject(const LrbData& d, const std::string& what) {
  throw InputError((d.name.empty() ? std::string("LRB-rep") : printable_name(d.name)) + ": " + what +
                   "; rebuild the LRB-rep from its mesh");
}

void check_face(const LrbData& d, FaceId f) {
  const auto corners = d.face(f);
  const auto reject_face = [&](const std::string& what) { reject(d, "face " + std::to_string(f) + what); };
  // Corners: the right number for the dimension, and every index within the vertex array.
  if (d.dim == 2 ? corners.size() != 2 : corners.size() < 3)
    reject_face(" has " + std::to_string(corners.size()) + " corners");
  for (const VertexId v : corners)
    if (v >= d.vertices.size())
      reject_face(" refers to vertex " + std::to_string(v) + ", which does not exist");
  // Cells: only a real face has the solid behind it, and a face separates two different cells.
  const CellId inner = d.inner_cell[f], outer = d.outer_cell[f];
  const auto is_known = [&](CellId c) { return !is_region(c) || c < d.region_layer.size(); };
  if (!is_known(inner) || !is_known(outer)) reject_face(" refers to a region that does not exist");
  if ((inner == kSolid) != (f < d.real_face_count))
    reject_face(" must have the solid behind it exactly if it is real");
  if (inner == kOutside || outer == kSolid || inner == outer || outer == kNull || inner == kNull)
    reject_face(" has its inner and outer cell swapped");
}

void check(const LrbData& d) {
  if (d.dim != 2 && d.dim != 3) reject(d, "dimension " + std::to_string(d.dim) + " is neither 2 nor 3");
  // Array lengths first: the loops over elements below rely on them.
  const std::size_t faces = d.face_count();
  if (d.vertices.size() > kMaxId || d.face_vertices.size() > kMaxId)
    reject(d, "more than 2^32 - 4 vertices or corners");
  if (d.inner_cell.size() != faces || d.outer_cell.size() != faces || d.real_face_count > faces)
    reject(d, "the arrays of faces and of their cells differ in length");
  // Ascending offsets that end at the number of corners keep every face() span within its array.
  if (d.face_offsets.front() != 0 || d.face_offsets.back() != d.face_vertices.size() ||
      !std::is_sorted(d.face_offsets.begin(), d.face_offsets.end()))
    reject(d, "the offsets of the faces' corners are not ascending");
  for (std::size_t v = 0; v < d.vertices.size(); ++v) {
    if (!d.vertices[v].allFinite()) reject(d, "vertex " + std::to_string(v) + " is not finite");
    // The 2D predicates do not read z, but the tree's boxes do.
    if (d.dim == 2 && d.vertices[v].z() != 0)
      reject(d, "vertex " + std::to_string(v) + " of a 2D body is not in the plane z = 0");
  }
  for (FaceId f = 0; f < faces; ++f) check_face(d, f);
}

/// Returns the area of a face (2D: its length), to compare lids; mesh units squared (2D: mesh units).
double face_size(const LrbData& d, FaceId f) {
  const auto c = d.face(f);
  if (d.dim == 2) return norm3(d.vertices[c[1]] - d.vertices[c[0]]);
  // Twice the vector area, which does not depend on the triangles. It underestimates polygons that are not
  // planar, which affects only the choice of parents.
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < c.size(); ++i)
    twice += (d.vertices[c[i]] - d.vertices[c[0]]).cross(d.vertices[c[i + 1]] - d.vertices[c[0]]);
  return 0.5 * norm3(twice);
}

}  // namespace

/// The levels of detail, once they exist.
struct LrbRep::MadeLevels {
  std::mutex making;
  std::unique_ptr<const WrapperLevels> owner;
  std::atomic<const WrapperLevels*> made{nullptr};  ///< points to *owner

  const WrapperLevels& keep(WrapperLevels levels) {
    owner = std::make_unique<const WrapperLevels>(std::move(levels));
    made.store(owner.get(), std::memory_order_release);
    return *owner;
  }
};

/// The result of overlaps_itself() for a body without regions, once computed.
struct LrbRep::FoundOverlap {
  std::once_flag once;
  bool value = false;
};

/// The result of surface_graph(), once built.
struct LrbRep::FoundGraph {
  std::once_flag once;
  std::optional<SurfaceGraph> value;
};

/// The result of hash(), once computed.
struct LrbRep::FoundHash {
  std::once_flag once;
  std::uint64_t value = 0;
};

LrbRep::LrbRep(LrbData data, unsigned threads) : d_(std::move(data)) {
  const FloatMode float_mode;
  derive();
  tree_ = ObbTree(simplices(), threads);
}

LrbRep::LrbRep(LrbData data, std::vector<TreeNode> nodes, std::vector<LeafBlock> blocks, std::uint64_t hash)
    : d_(std::move(data)) {
  const FloatMode float_mode;
  derive();
  std::call_once(hash_->once, [&] { hash_->value = hash; });
  tree_ = ObbTree(simplices(), std::move(nodes), std::move(blocks));
}

SimplexView LrbRep::simplices() const {
  return {dim(), vertices(), real_simplex_count(), this, [](const void* rep, SimplexId s, VertexId out[3]) {
            static_cast<const LrbRep*>(rep)->simplex(s, out);
          }};
}

/// Derives everything except the tree and the hash.
void LrbRep::derive() {
  // The code below indexes without checks, so validation comes first.
  check(d_);
  link_faces_to_regions();
  find_parents();
  find_components();
  // The leading faces that are simplices themselves share their numbers with the simplices, so they need no
  // table. In 2D these are all faces.
  const auto simplex_size = static_cast<std::size_t>(d_.dim);
  while (whole_faces_ < face_count() && d_.face(FaceId(whole_faces_)).size() == simplex_size) ++whole_faces_;
  // Otherwise a table from simplex to face covers all simplices, including the leading ones.
  if (whole_faces_ < face_count())
    for (FaceId f = 0; f < face_count(); ++f)
      face_of_simplex_.insert(face_of_simplex_.end(), Mesh::simplices_of(d_.face(f).size(), 3), f);
  if (d_.dim == 3) cut_polygons();
  // Unique in the process. Copies keep the serial, so caches for one copy serve the others.
  static std::atomic<std::uint64_t> next_serial{1};
  serial_ = next_serial++;
  levels_ = std::make_shared<MadeLevels>();
  overlap_ = std::make_shared<FoundOverlap>();
  graph_ = std::make_shared<FoundGraph>();
  hash_ = std::make_shared<FoundHash>();
}

namespace {

/// Divides a pseudo face as builders do. Returns false if the result is its fan.
bool cut_lid(std::span<const Eigen::Vector3d> corners, std::vector<std::array<std::uint32_t, 3>>& parts) {
  Mesh polygon;
  polygon.vertices.assign(corners.begin(), corners.end());
  std::vector<VertexId> numbers(corners.size());
  std::iota(numbers.begin(), numbers.end(), VertexId{0});
  polygon.add_face(numbers);
  std::vector<std::array<VertexId, 3>> triangles;
  triangulate(polygon, 0, triangles);
  parts.clear();
  bool is_fan = true;
  for (const auto& [a, b, c] : triangles) {
    is_fan &= a == 0u && b == parts.size() + 1 && c == b + 1;
    parts.push_back({a, b, c});
  }
  return !is_fan;
}

}  // namespace

void LrbRep::cut_polygons() {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::array<std::uint32_t, 3>> parts;
  for (FaceId f(whole_faces_); f < face_count(); ++f) {
    const auto face = d_.face(f);
    if (face.size() == 3) continue;
    corners.clear();
    for (const VertexId v : face) corners.push_back(d_.vertices[v]);
    if (is_real(f)) {
      const PolygonCut cut = cut_polygon(corners, parts);
      if (cut == PolygonCut::folded) folded_faces_.push_back(f);
      if (cut != PolygonCut::ears) continue;
    } else {
      if (!cut_lid(corners, parts)) continue;
      has_cut_lids_ = true;
    }
    // The first one: the table holds the fans of all other faces.
    if (triangles_.empty()) {
      std::vector<std::array<VertexId, 3>> all(simplex_count() - whole_faces_);
      for (SimplexId s(whole_faces_); s < simplex_count(); ++s) simplex(s, all[s - whole_faces_].data());
      triangles_ = std::move(all);
    }
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        triangles_[first_simplex(f) - whole_faces_ + i][k] = face[parts[i][k]];
  }
}

std::uint64_t LrbRep::hash() const {
  std::call_once(hash_->once, [this] { hash_->value = hash_of(d_); });
  return hash_->value;
}

Mesh LrbRep::real_mesh() const {
  Mesh out;
  out.dim = d_.dim;
  out.name = d_.name;
  const auto faces = d_.face_offsets.begin();
  out.face_offsets.assign(faces, faces + d_.real_face_count + 1);
  out.face_vertices.assign(d_.face_vertices.begin(), d_.face_vertices.begin() + out.face_offsets.back());
  std::uint32_t used = 0;
  for (const VertexId v : out.face_vertices) used = std::max(used, v + 1u);
  out.vertices.assign(d_.vertices.begin(), d_.vertices.begin() + used);
  return out;
}

SelfIntersections self_intersections(const LrbRep& rep, unsigned threads, std::uint64_t max_pairs) {
  const Mesh mesh = rep.real_mesh();
  MeshReport report;
  Workers workers(threads);
  return self_intersections(mesh, check_faces(mesh, report), workers, max_pairs);
}

bool LrbRep::overlaps_itself() const {
  const FloatMode float_mode;
  // For bodies with regions the builder has determined the flag.
  if (region_count() > 0) return d_.self_intersecting;
  std::call_once(overlap_->once, [this] {
    const Mesh mesh = real_mesh();
    MeshReport unused;
    overlap_->value = lrb::overlaps_itself(mesh, check_faces(mesh, unused));
  });
  return overlap_->value;
}

const SurfaceGraph& LrbRep::surface_graph() const {
  std::call_once(graph_->once, [this] { graph_->value.emplace(*this); });
  return *graph_->value;
}

const WrapperLevels& LrbRep::levels(unsigned threads) const {
  // Double-checked locking: this acquire pairs with the release in keep().
  if (const WrapperLevels* const made = levels_->made.load(std::memory_order_acquire)) return *made;
  const std::lock_guard<std::mutex> lock(levels_->making);
  // Another thread may have created the levels while this one waited for the lock.
  if (const WrapperLevels* const made = levels_->made.load(std::memory_order_relaxed)) return *made;
  return levels_->keep(WrapperLevels(*this, threads));
}

bool LrbRep::has_levels() const {
  return levels_->made.load(std::memory_order_acquire) != nullptr;
}

void LrbRep::keep_levels(WrapperLevels levels) {
  levels_->keep(std::move(levels));
}

LrbRep LrbRep::without_regions(const Mesh& mesh, bool closed, bool self_intersecting, unsigned threads) {
  LrbData d;
  d.dim = mesh.dim;
  d.vertices = mesh.vertices;
  d.face_offsets = mesh.face_offsets;
  d.face_vertices = mesh.face_vertices;
  d.real_face_count = static_cast<std::uint32_t>(mesh.face_count());
  d.inner_cell.assign(mesh.face_count(), kSolid);
  d.outer_cell.assign(mesh.face_count(), kOutside);
  d.closed = closed;
  d.self_intersecting = self_intersecting;
  d.name = mesh.name;
  return LrbRep(std::move(d), threads);
}

LrbRep LrbRep::without_regions(const LrbRep& rep, bool dropped_fans) {
  // Real faces come first, so truncating the arrays removes exactly the pseudo faces.
  LrbData d = rep.d_;
  d.face_offsets.resize(d.real_face_count + 1);
  d.face_vertices.resize(d.face_offsets.back());
  // Every remaining face now separates the solid from the outside.
  d.inner_cell.assign(d.real_face_count, kSolid);
  d.outer_cell.assign(d.real_face_count, kOutside);
  d.region_layer.clear();
  LrbRep out(std::move(d));
  out.dropped_fans_ = dropped_fans || rep.dropped_fans_;
  return out;
}

void LrbRep::link_faces_to_regions() {
  const std::uint32_t regions = region_count();
  std::vector<std::uint32_t> floor_count(regions, 0);
  lid_count_.assign(regions, 0);
  // Pass 1: count the lids and floor faces of each region, and collect the outermost faces.
  for (FaceId f = 0; f < face_count(); ++f) {
    if (is_region(inner_cell(f))) ++lid_count_[inner_cell(f)];
    if (is_region(outer_cell(f))) ++floor_count[outer_cell(f)];
    if (outer_cell(f) == kOutside) outermost_.push_back(f);
  }
  // Prefix sums assign each region one contiguous slice (compressed rows): its lids, then its floor.
  collector_offsets_.assign(regions + 1, 0);
  for (RegionId r = 0; r < regions; ++r)
    collector_offsets_[r + 1] = collector_offsets_[r] + lid_count_[r] + floor_count[r];
  collector_faces_.resize(collector_offsets_.back());
  std::vector<std::uint32_t> next_lid(collector_offsets_.begin(), collector_offsets_.end() - 1),
      next_floor(regions);
  for (RegionId r = 0; r < regions; ++r) next_floor[r] = next_lid[r] + lid_count_[r];
  // Pass 2: fill the slices. Faces are visited in ascending order, so both parts of a slice are ascending.
  for (FaceId f = 0; f < face_count(); ++f) {
    if (is_region(inner_cell(f))) collector_faces_[next_lid[inner_cell(f)]++] = f;
    if (is_region(outer_cell(f))) collector_faces_[next_floor[outer_cell(f)]++] = f;
  }
}

void LrbRep::find_parents() {
  const std::uint32_t regions = region_count();
  parent_.assign(regions, kOutside);
  std::vector<std::pair<CellId, FaceId>> lids_by_cell;
  for (RegionId r = 0; r < regions; ++r) {
    layer_count_ = std::max(layer_count_, d_.region_layer[r] + 1u);
    // Sort the lids by outer neighbour, sum up the area shared with each, and take the largest; ties go to
    // the smaller id.
    lids_by_cell.clear();
    for (const FaceId lid : lids(r)) lids_by_cell.emplace_back(outer_cell(lid), lid);
    std::sort(lids_by_cell.begin(), lids_by_cell.end());
    double most = -1;
    for (auto lid = lids_by_cell.begin(); lid != lids_by_cell.end();) {
      const CellId cell = lid->first;
      double shared = 0;
      for (; lid != lids_by_cell.end() && lid->first == cell; ++lid) shared += face_size(d_, lid->second);
      if (shared > most) most = shared, parent_[r] = cell;
    }
  }
  // Depth: follow parents to the outside or to a region of known depth, then number the path on the way back.
  // Each region is numbered once, so this takes O(|R|) steps.
  depth_.assign(regions, 0);
  std::vector<RegionId> path;
  for (RegionId r = 0; r < regions; ++r) {
    CellId c = r;
    for (; is_region(c) && depth_[c] == 0; c = parent_[c]) {
      path.push_back(c.as_region());
      // A path longer than the number of regions contains a cycle, in which no depth is ever known.
      if (path.size() > regions) reject(d_, "region " + std::to_string(r) + " hides itself");
    }
    std::uint32_t depth = is_region(c) ? depth_[c] : 0;
    for (; !path.empty(); path.pop_back()) depth_[path.back()] = ++depth;
  }
}

void LrbRep::find_components() {
  // Only real faces count: components connected only by lids are still separate.
  std::vector<FaceId> real(d_.real_face_count);
  std::iota(real.begin(), real.end(), FaceId{0});
  component_vertices_ = piece_vertices(*this, real);
}

std::uint32_t LrbRep::simplex_count() const {
  // A polygon of n corners has n - 2 triangles, so the sum over all faces is the number of corners minus 2
  // |F|.
  return d_.dim == 2 ? face_count() : static_cast<std::uint32_t>(d_.face_vertices.size()) - 2 * face_count();
}

std::uint32_t LrbRep::real_simplex_count() const {
  return d_.dim == 2 ? d_.real_face_count : d_.face_offsets[d_.real_face_count] - 2 * d_.real_face_count;
}

std::size_t LrbRep::memory_bytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return sizeof(*this) + bytes(d_.vertices) + bytes(d_.face_offsets) + bytes(d_.face_vertices) +
         bytes(d_.inner_cell) + bytes(d_.outer_cell) + bytes(d_.region_layer) + bytes(outermost_) +
         bytes(component_vertices_) + bytes(collector_offsets_) + bytes(collector_faces_) +
         bytes(lid_count_) + bytes(parent_) + bytes(depth_) + bytes(face_of_simplex_) + bytes(triangles_) +
         bytes(folded_faces_) + tree_.memory_bytes() + (has_levels() ? levels().memory_bytes() : 0);
}

std::uint64_t hash_of(const LrbData& d) {
  // A fixed order of fields. The name is excluded, so that renaming a body keeps its hash.
  Fnv64 h;
  h.add_value(static_cast<std::uint32_t>(d.dim));
  h.add_array(d.vertices);
  h.add_array(d.face_offsets);
  h.add_array(d.face_vertices);
  h.add_value(d.real_face_count);
  h.add_array(d.inner_cell);
  h.add_array(d.outer_cell);
  h.add_array(d.region_layer);
  h.add_value(static_cast<std::uint32_t>(d.closed) + 2u * static_cast<std::uint32_t>(d.self_intersecting));
  return h.value();
}

// Volumes by the divergence theorem: a closed surface encloses the sum of the signed cones from any point
// over its faces' triangles. In floating point; kVolumeRounding is the tolerance.

namespace {

/// Returns the volume of the cone from `origin` over a face (2D: the area of the triangle), positive if the
/// face is oriented away from it. The origin is close to the faces, so that bodies far from zero keep their
/// precision.
double cone(const LrbRep& rep, FaceId f, const Eigen::Vector3d& origin) {
  const auto at = [&](VertexId v) -> Eigen::Vector3d { return rep.vertices()[v] - origin; };
  const std::size_t count = Mesh::simplices_of(rep.face(f).size(), rep.dim());
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    VertexId v[3] = {};
    rep.simplex(SimplexId(rep.first_simplex(f) + i), v);
    if (rep.dim() == 2) return 0.5 * (at(v[0]).x() * at(v[1]).y() - at(v[0]).y() * at(v[1]).x());
    // Six times the volume of a tetrahedron is the determinant of its three edges from the apex.
    sum += dot3(at(v[0]), at(v[1]).cross(at(v[2])));
  }
  return sum / 6;
}

/// Returns a face's area (2D: its length).
double size_of(const LrbRep& rep, FaceId f) {
  const auto corners = rep.face(f);
  const auto side = [&](std::size_t i) -> Eigen::Vector3d {
    return rep.vertices()[corners[i]] - rep.vertices()[corners[0]];
  };
  if (rep.dim() == 2) return norm3(side(1));
  // Twice the vector area, which does not depend on the triangles.
  Eigen::Vector3d sum(0, 0, 0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) sum += side(i).cross(side(i + 1));
  return norm3(sum) / 2;
}

}  // namespace

double enclosed_volume(const LrbRep& rep, std::span<const FaceId> outward, std::span<const FaceId> inward) {
  const FloatMode float_mode;
  if (outward.empty() && inward.empty()) return 0;
  // Any origin gives the same result for a closed surface. One on the surface keeps the terms small.
  const Eigen::Vector3d origin = rep.vertices()[rep.face(outward.empty() ? inward[0] : outward[0])[0]];
  double sum = 0;
  for (const FaceId f : outward) sum += cone(rep, f, origin);
  for (const FaceId f : inward) sum -= cone(rep, f, origin);
  return sum;
}

double region_volume(const LrbRep& rep, RegionId r) {
  return enclosed_volume(rep, rep.lids(r), rep.floor(r));
}

double lid_height(const LrbRep& rep) {
  const FloatMode float_mode;
  double volume = 0, area = 0;
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    volume += region_volume(rep, r);
    for (const FaceId lid : rep.lids(r)) area += size_of(rep, lid);
  }
  return area > 0 ? volume / area : 0;
}

}  // namespace lrb

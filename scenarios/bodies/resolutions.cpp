#include "scenarios/bodies/resolutions.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/embed_check.hpp"
#include "engine/construct/front_mesh.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::resolutions {

// Sums of squared distances from planes.

/// The sum over a set of triangles of area times squared distance from the triangle's plane, as a function of
/// the point: x^T a x - 2 b^T x + c, with a symmetric. Its unit is length^4.
class Quadric {
 public:
  Quadric() = default;
  /// Starts with the plane through p with normal n; the length of n is the plane's weight.
  Quadric(const Eigen::Vector3d& n, const Eigen::Vector3d& p) {
    weight_ = n.norm();
    if (!(weight_ > 0)) return;
    const Eigen::Vector3d unit = n / weight_;
    const double d = unit.dot(p);
    xx_ = weight_ * unit.x() * unit.x();
    xy_ = weight_ * unit.x() * unit.y();
    xz_ = weight_ * unit.x() * unit.z();
    yy_ = weight_ * unit.y() * unit.y();
    yz_ = weight_ * unit.y() * unit.z();
    zz_ = weight_ * unit.z() * unit.z();
    b_ = weight_ * d * unit;
    c_ = weight_ * d * d;
  }

  Quadric& operator+=(const Quadric& q) {
    xx_ += q.xx_, xy_ += q.xy_, xz_ += q.xz_, yy_ += q.yy_, yz_ += q.yz_, zz_ += q.zz_;
    b_ += q.b_;
    c_ += q.c_;
    weight_ += q.weight_;
    return *this;
  }
  friend Quadric operator+(Quadric p, const Quadric& q) { return p += q; }

  double weight() const { return weight_; }  ///< sum over all planes
  double at(const Eigen::Vector3d& p) const { return p.dot(times(p)) - 2 * b_.dot(p) + c_; }

  /// Returns the point that minimises at(x) + pull |x - m|^2; pull > 0.
  Eigen::Vector3d lowest(const Eigen::Vector3d& m, double pull) const {
    // By Cramer's rule: the matrix is positive definite because of the pull, and the result is the same on
    // every machine.
    const double xx = xx_ + pull, yy = yy_ + pull, zz = zz_ + pull;
    const Eigen::Vector3d r = b_ + pull * m;
    const double cxx = yy * zz - yz_ * yz_, cxy = yz_ * xz_ - xy_ * zz, cxz = xy_ * yz_ - yy * xz_;
    const double cyy = xx * zz - xz_ * xz_, cyz = xy_ * xz_ - xx * yz_, czz = xx * yy - xy_ * xy_;
    const double det = xx * cxx + xy_ * cxy + xz_ * cxz;
    return {(cxx * r.x() + cxy * r.y() + cxz * r.z()) / det, (cxy * r.x() + cyy * r.y() + cyz * r.z()) / det,
            (cxz * r.x() + cyz * r.y() + czz * r.z()) / det};
  }

 private:
  Eigen::Vector3d times(const Eigen::Vector3d& p) const {
    return {xx_ * p.x() + xy_ * p.y() + xz_ * p.z(), xy_ * p.x() + yy_ * p.y() + yz_ * p.z(),
            xz_ * p.x() + yz_ * p.y() + zz_ * p.z()};
  }

  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0, c_ = 0, weight_ = 0;
  Eigen::Vector3d b_ = Eigen::Vector3d::Zero();
};

namespace {

using Vector3 = Eigen::Vector3d;
using construct::AabbTree;
using construct::CheckedTriangle;
using construct::FrontMesh;
using Slot = FrontMesh::Slot;
using Corner = FrontMesh::Corner;

/// Weight of the pull of a new vertex towards its edge's midpoint, which also makes long edges expensive,
/// relative to the distance from the surrounding planes. Larger values give more even triangles and rounder
/// creases, smaller ones give needles on flat parts.
constexpr double kEvenness = 1e-3;
/// Cosine of the maximum rotation of a triangle's normal. Smaller values allow folds; larger ones stop
/// collapses early.
constexpr double kMinCosine = 0.3;
/// Minimum shape quality of a new triangle (1: equilateral, 0: degenerate), unless it is better than the
/// worst it replaces.
constexpr double kMinShape = 0.1;

double shape(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double twice_area = (b - a).cross(c - a).norm();
  return 2 * std::sqrt(3.0) * twice_area /
         ((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm());
}

class Decimator {
 public:
  explicit Decimator(const Mesh& mesh)
      : surface_(mesh), name_(mesh.name), next_id_(static_cast<VertexId>(mesh.vertices.size())) {
    Eigen::AlignedBox3d box;
    for (const Vector3& x : mesh.vertices) box.extend(x);
    origin_ = box.center();  // near the surface, where quadrics are precise
    quadrics_.resize(surface_.point_count());
    for (Slot s = 0; s < surface_.slot_count(); ++s) {
      const auto& v = surface_[s].v;
      const Vector3 n = (surface_.x(v[1]) - surface_.x(v[0])).cross(surface_.x(v[2]) - surface_.x(v[0])) / 2;
      const Quadric q(n, surface_.x(v[0]) - origin_);
      for (const Corner c : v) quadrics_[c] += q;
    }
    plant();
  }

  void run(std::uint32_t target) {
    while (surface_.triangle_count() > target) {
      if (queue_.empty()) propose_all();
      const std::uint32_t before = surface_.triangle_count();
      while (!queue_.empty() && surface_.triangle_count() > target) {
        std::pop_heap(queue_.begin(), queue_.end());
        const Collapse c = queue_.back();
        queue_.pop_back();
        if (surface_.degree(c.u) > 0 && surface_.degree(c.v) > 0) try_collapse(c);
        if (2 * surface_.triangle_count() < planted_) plant();
      }
      if (surface_.triangle_count() == before) return;  // all remaining collapses are rejected
    }
  }

  Mesh mesh() const {
    Mesh out;
    out.name = name_;
    std::vector<VertexId> number(next_id_, kNull);
    for (const Slot s : surface_.alive_slots()) {
      VertexId corners[3];
      for (int i = 0; i < 3; ++i) {
        const FrontMesh::Point& p = surface_.point(surface_[s].v[i]);
        if (number[p.id] == kNull) {
          number[p.id] = static_cast<VertexId>(out.vertices.size());
          out.vertices.push_back(p.x);
        }
        corners[i] = number[p.id];
      }
      out.add_face(corners);
    }
    return out;
  }

 private:
  /// An edge, and the cost of its collapse. Both ends are deleted by the collapse, so that an entry is either
  /// up to date or names a vertex that no longer exists.
  struct Collapse {
    double cost;
    Corner u, v;
    bool operator<(const Collapse& other) const {  // the cheapest comes last: for heaps
      if (cost != other.cost) return cost > other.cost;
      return u != other.u ? u > other.u : v > other.v;
    }
  };
  /// A boundary edge of the hole that a collapse leaves.
  struct RimEdge {
    Corner from, to;
    Slot inside, across;
  };

  void plant() {
    tree_.emplace(surface_);
    planted_ = surface_.triangle_count();
  }

  Vector3 place(Corner u, Corner v, double& cost) const {
    const Quadric q = quadrics_[u] + quadrics_[v];
    const Vector3 a = surface_.x(u) - origin_, b = surface_.x(v) - origin_, midpoint = (a + b) / 2;
    const double pull = kEvenness * q.weight();
    const Vector3 w = q.lowest(midpoint, pull);
    cost = q.at(w) + pull * ((w - midpoint).squaredNorm() + (b - a).squaredNorm());
    return w + origin_;
  }

  void propose(Corner u, Corner v) {
    Collapse c{0, std::min(u, v), std::max(u, v)};
    place(c.u, c.v, c.cost);
    if (!(c.cost < std::numeric_limits<double>::infinity())) return;
    queue_.push_back(c);
    std::push_heap(queue_.begin(), queue_.end());
  }

  void propose_all() {
    for (const Slot s : surface_.alive_slots())
      for (int i = 0; i < 3; ++i)
        if (surface_[s].v[i] < surface_[s].v[(i + 1) % 3])
          propose(surface_[s].v[i], surface_[s].v[(i + 1) % 3]);
  }

  bool in_star(Slot s) const { return std::find(star_.begin(), star_.end(), s) != star_.end(); }

  /// Fills star_ and rim_. Returns false if the result of the collapse would not be a surface: the boundary
  /// must be one simple loop (the link condition) with more than two edges.
  bool find_star(Corner u, Corner v) {
    star_.clear();
    surface_.for_each_around(u, [&](Slot s, int) { star_.push_back(s); });
    surface_.for_each_around(v, [&](Slot s, int) {
      const auto& t = surface_[s].v;
      if (t[0] != u && t[1] != u && t[2] != u) star_.push_back(s);
    });
    rim_.clear();
    for (const Slot s : star_)
      for (int i = 0; i < 3; ++i)
        if (!in_star(surface_[s].across[i]))
          rim_.push_back({surface_[s].v[i], surface_[s].v[(i + 1) % 3], s, surface_[s].across[i]});
    if (rim_.size() != star_.size() - 2 || rim_.size() < 3) return false;
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      if (rim_[i].from == u || rim_[i].from == v) return false;
      for (std::size_t j = 0; j < i; ++j)
        if (rim_[i].from == rim_[j].from) return false;
    }
    return true;
  }

  bool looks_good(const Vector3& w) const {
    double worst_old = 1, worst_new = 1;
    for (const Slot s : star_)
      worst_old = std::min(worst_old, shape(surface_.x(surface_[s].v[0]), surface_.x(surface_[s].v[1]),
                                            surface_.x(surface_[s].v[2])));
    for (const RimEdge& r : rim_) {
      const Vector3 &a = surface_.x(r.from), &b = surface_.x(r.to);
      const auto& t = surface_[r.inside].v;
      const Vector3 now = (b - a).cross(w - a);
      const Vector3 before = (surface_.x(t[1]) - surface_.x(t[0])).cross(surface_.x(t[2]) - surface_.x(t[0]));
      if (!(now.dot(before) > kMinCosine * now.norm() * before.norm())) return false;
      worst_new = std::min(worst_new, shape(a, b, w));
    }
    return worst_new >= std::min(kMinShape, worst_old);
  }

  /// Proves exactly that the new fan intersects the surface only in shared vertices and edges.
  bool is_clear(const FrontMesh::Point& w) {
    fan_.clear();
    for (const RimEdge& r : rim_) fan_.emplace_back(surface_.point(r.from), surface_.point(r.to), w);
    for (std::size_t i = 0; i < fan_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        if (!fan_[i].clear_of(fan_[j])) return false;
      bool clear = true;
      tree_->for_each_in(fan_[i].box, [&](Slot s) {
        if (!clear || !surface_.alive(s) || in_star(s)) return;
        const auto& t = surface_[s].v;
        clear = fan_[i].clear_of({surface_.point(t[0]), surface_.point(t[1]), surface_.point(t[2])});
      });
      if (!clear) return false;
    }
    return true;
  }

  void try_collapse(const Collapse& c) {
    if (!find_star(c.u, c.v)) return;
    double cost = 0;
    const FrontMesh::Point w{place(c.u, c.v, cost), next_id_};
    if (!looks_good(w.x) || !is_clear(w)) return;
    ++next_id_;
    const Corner added = surface_.add_point(w.x, w.id);
    quadrics_.push_back(quadrics_[c.u] + quadrics_[c.v]);
    fill_hole(added);
    for (const RimEdge& r : rim_) propose(r.from, added);
  }

  /// Replaces the star by the fan, which takes over its first slots.
  void fill_hole(Corner w) {
    const std::uint32_t component = surface_[star_[0]].component;
    const auto slot_from = [&](Corner v) {
      for (std::size_t i = 0; i < rim_.size(); ++i)
        if (rim_[i].from == v) return star_[i];
      return NoId::kValue;
    };
    std::vector<FrontMesh::Triangle> fan(rim_.size());
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      const RimEdge& r = rim_[i];
      fan[i] = {{r.from, r.to, w}, {r.across, slot_from(r.to), kNull}, 0, component};
      surface_.link(r.across, r.to, star_[i]);
    }
    for (std::size_t i = 0; i < rim_.size(); ++i)
      for (std::size_t j = 0; j < rim_.size(); ++j)
        if (fan[i].across[1] == star_[j]) fan[j].across[2] = star_[i];
    surface_.remove(star_);
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      surface_.add(star_[i], fan[i]);
      tree_->update(star_[i], box_of(surface_, star_[i]));
    }
  }

  FrontMesh surface_;
  std::string name_;
  VertexId next_id_;
  Vector3 origin_;
  std::vector<Quadric> quadrics_;  ///< (|points|), relative to origin_
  std::optional<AabbTree> tree_;
  std::uint32_t planted_ = 0;  ///< number of triangles when the tree was built
  std::vector<Collapse> queue_;
  std::vector<Slot> star_;
  std::vector<RimEdge> rim_;
  std::vector<CheckedTriangle> fan_;
};

}  // namespace

std::vector<Mesh> decimate(const Mesh& mesh, std::span<const std::uint32_t> targets) {
  Decimator decimator(mesh);
  std::vector<Mesh> out;
  for (const std::uint32_t target : targets) {
    decimator.run(target);
    out.push_back(decimator.mesh());
  }
  return out;
}

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

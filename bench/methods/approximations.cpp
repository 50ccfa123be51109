// Descends two sphere trees together to a given level: an approximate, interruptible answer (P. M. Hubbard,
// "Collision Detection for Interactive Graphics Applications", PhD thesis, Brown University, 1994: the
// paper's Hub94). Spheres contain the triangles below them, so no contact is missed. Overlapping spheres at
// the last level count as contact.

#include <algorithm>

#include <Eigen/Geometry>

#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include <lrbscope/error.hpp>

namespace lrb::methods {
namespace {

struct PlainBody : MethodBody {
  int dim = 3;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<VertexId> corners;  ///< (|simplices| x dim)
};

/// Returns the corners in world coordinates, simplex by simplex.
std::vector<Eigen::Vector3d> in_world(const PlainBody& body, const Pose& pose) {
  std::vector<Eigen::Vector3d> moved, out;
  for (const Eigen::Vector3d& v : body.vertices) moved.push_back(pose.apply(v));
  for (const VertexId v : body.corners) out.push_back(moved[v]);
  return out;
}

class PlainDouble : public Method {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    auto body = std::make_unique<PlainBody>();
    body->dim = rep.dim();
    body->vertices.assign(rep.vertices().begin(), rep.vertices().end());
    VertexId v[3];
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      rep.simplex(s, v);
      body->corners.insert(body->corners.end(), v, v + rep.simplex_size());
    }
    return body;
  }

  MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                     Mode mode) override {
    const auto& body_a = static_cast<const PlainBody&>(a);
    const auto& body_b = static_cast<const PlainBody&>(b);
    const std::size_t n = static_cast<std::size_t>(body_a.dim);
    MethodAnswer answer;
    const Stopwatch watch;
    const std::vector<Eigen::Vector3d> p = in_world(body_a, pose_a), q = in_world(body_b, pose_b);
    for (std::size_t i = 0; i < p.size() && !(mode == Mode::first_pair && answer.contact); i += n)
      for (std::size_t j = 0; j < q.size(); j += n) {
        const bool meet = n == 3 ? plain_triangles_meet(&p[i], &q[j]) : plain_segments_meet(&p[i], &q[j]);
        if (!meet) continue;
        answer.contact = true;
        answer.pairs.push_back({static_cast<SimplexId>(i / n), static_cast<SimplexId>(j / n)});
        if (mode == Mode::first_pair) break;
      }
    answer.microseconds = watch.microseconds();
    return answer;
  }
};

}  // namespace

std::vector<MethodEntry> plain_double_methods() {
  MethodInfo info;
  info.rank = 20;
  info.style = {"brute force", "#6b6b6b", "crossRot"};
  info.name = "plain";
  info.role = Role::no_peer;  // takes minutes
  info.title = "brute force, double, epsilon 1e-6";
  info.remark =
      "Every pair of triangles by Moeller's interval test (1997) with its usual epsilon; 2D: by sides. No "
      "boxes, no relation.";
  info.traits.set(Trait::takes_2d);
  info.traits.set(Trait::moves_exactly);
  return {{info, []() -> std::unique_ptr<Method> { return std::make_unique<PlainDouble>(); }}};
}

namespace {

struct Sphere {
  Eigen::Vector3d centre;
  double radius = 0;
  std::uint32_t left = 0, right = 0;  ///< children; 0: none
};

struct SphereBody : MethodBody {
  explicit SphereBody(Triangles t) : shape(std::move(t)) {
    std::vector<std::uint32_t> all(shape.triangles.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    if (!all.empty()) build(all.begin(), all.end());
  }
  using Iterator = std::vector<std::uint32_t>::iterator;

  /// Splits at the median of the centres, along the longest side of their box.
  std::uint32_t build(Iterator begin, Iterator end) {
    const auto index = static_cast<std::uint32_t>(spheres.size());
    spheres.push_back(round(begin, end));
    if (end - begin == 1) return index;
    Eigen::AlignedBox3d centroids;
    for (Iterator i = begin; i != end; ++i) centroids.extend(centroid(*i));
    Eigen::Index axis = 0;
    centroids.sizes().maxCoeff(&axis);
    const Iterator half = begin + (end - begin) / 2;
    std::nth_element(begin, half, end, [&](std::uint32_t i, std::uint32_t j) {
      const double a = centroid(i)[axis], b = centroid(j)[axis];
      return a != b ? a < b : i < j;
    });
    const std::uint32_t left = build(begin, half), right = build(half, end);
    spheres[index].left = left;
    spheres[index].right = right;
    return index;
  }

  Sphere round(Iterator begin, Iterator end) const {
    Eigen::AlignedBox3d box;
    for (Iterator i = begin; i != end; ++i)
      for (const VertexId v : shape.triangles[*i]) box.extend(shape.vertices[v]);
    Sphere s;
    s.centre = box.center();
    for (Iterator i = begin; i != end; ++i)
      for (const VertexId v : shape.triangles[*i])
        s.radius = std::max(s.radius, (shape.vertices[v] - s.centre).norm());
    return s;
  }
  Eigen::Vector3d centroid(std::uint32_t i) const {
    const auto& c = shape.triangles[i];
    return (shape.vertices[c[0]] + shape.vertices[c[1]] + shape.vertices[c[2]]) / 3;
  }

  Triangles shape;
  std::vector<Sphere> spheres;
};

class Spheres : public Method {
 public:
  void set(double level) override { level_ = static_cast<int>(level); }

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    return std::make_unique<SphereBody>(triangles_of(rep));
  }

  MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                     Mode mode) override {
    const auto &body_a = static_cast<const SphereBody&>(a), &body_b = static_cast<const SphereBody&>(b);
    MethodAnswer answer;
    const Stopwatch watch;
    // B in A's frame.
    const Eigen::Matrix3d r = pose_a.r.transpose() * pose_b.r;
    const Eigen::Vector3d t = pose_a.r.transpose() * (pose_b.t - pose_a.t);
    struct Item {
      std::uint32_t a, b;
      int level;
    };
    std::vector<Item> stack = {{0, 0, 0}};
    while (!stack.empty()) {
      const Item item = stack.back();
      stack.pop_back();
      const Sphere &p = body_a.spheres[item.a], &q = body_b.spheres[item.b];
      const Eigen::Vector3d way = r * q.centre + t - p.centre;
      ++answer.face_tests;
      const double reach = p.radius + q.radius;
      if (way.squaredNorm() > reach * reach) continue;
      const bool leaf_a = p.left == 0, leaf_b = q.left == 0;
      if (item.level >= level_ || (leaf_a && leaf_b)) {
        // On average, the midpoint between the points where the line of centres leaves one sphere and enters
        // the other.
        const double length = way.norm();
        const double at = length > 0 ? (p.radius + length - q.radius) / (2 * length) : 0;
        answer.points.push_back(pose_a.apply(p.centre + at * way));
        if (mode == Mode::first_pair) break;
        continue;
      }
      if (!leaf_a && !leaf_b) {
        for (const std::uint32_t i : {p.left, p.right})
          for (const std::uint32_t j : {q.left, q.right}) stack.push_back({i, j, item.level + 1});
      } else if (leaf_b) {
        for (const std::uint32_t i : {p.left, p.right}) stack.push_back({i, item.b, item.level + 1});
      } else {
        for (const std::uint32_t j : {q.left, q.right}) stack.push_back({item.a, j, item.level + 1});
      }
    }
    answer.microseconds = watch.microseconds();
    answer.contact = !answer.points.empty();
    return answer;
  }

 private:
  int level_ = 0;
};

}  // namespace

std::vector<MethodEntry> spheres_methods() {
  MethodInfo info;
  info.rank = 80;
  info.style = {"sphere tree, by level", "#1c1e22", "star"};
  info.name = "spheres";
  info.title = "sphere tree, stopped at a level";
  info.remark =
      "Contact, and points of it: two binary trees of spheres around triangles, descended to a level; spheres "
      "that still overlap there count as contact. Never misses a contact; many false positives.";
  info.pairs = false;
  info.traits.set(Trait::hard_cases, false);
  info.traits.set(Trait::approximate);
  info.parameter = "level";
  info.settings = {2, 4, 6, 8, 10, 12};
  return {{info, []() -> std::unique_ptr<Method> { return std::make_unique<Spheres>(); }}};
}

}  // namespace lrb::methods

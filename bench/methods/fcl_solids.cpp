// FCL with other geometries than meshes: an octree against a mesh, with the cell size as parameter, and the
// convex hulls of both by GJK (libccd).
#include <algorithm>
#include <cmath>

#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>

#ifdef LRB_HAS_FCL
#include <fcl/config.h>
#define LRB_FCL "FCL " FCL_VERSION
#else
#define LRB_FCL "FCL"
#endif

#if defined(LRB_HAS_FCL) && FCL_HAVE_OCTOMAP
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision.h>

#include "bench/methods/fcl_models.hpp"
#endif

namespace lrb::methods {
namespace {

class Octree;
class Gjk;

#if defined(LRB_HAS_FCL) && FCL_HAVE_OCTOMAP

/// Queries FCL for contacts of two geometries, with their positions.
Answer contacts_of(const fcl::CollisionGeometryd& a, const Pose& pose_a, const fcl::CollisionGeometryd& b,
                   const Pose& pose_b, Mode mode) {
  static constexpr std::size_t kMax = std::size_t{1} << 40;
  const fcl::CollisionRequestd request(mode == Mode::all_pairs ? kMax : 1, mode == Mode::all_pairs);
  Answer answer;
  const Stopwatch watch;
  fcl::CollisionResultd result;
  fcl::collide(&a, transform<double>(pose_a), &b, transform<double>(pose_b), request, result);
  answer.microseconds = watch.microseconds();
  answer.contact = result.isCollision();
  if (mode == Mode::all_pairs)
    for (std::size_t i = 0; i < result.numContacts(); ++i) answer.points.push_back(result.getContact(i).pos);
  return answer;
}

struct OctreeBody : MethodBody {
  std::unique_ptr<fcl::OcTreed> cells;
  fcl::BVHModel<fcl::OBBRSSd> mesh;
};

/// Makes an octree; each triangle is sampled at half the cell size.
std::shared_ptr<octomap::OcTree> cells_of(const Triangles& t, double cell) {
  auto tree = std::make_shared<octomap::OcTree>(cell);
  for (const auto& c : t.triangles) {
    const Eigen::Vector3d &p = t.vertices[c[0]], &q = t.vertices[c[1]], &r = t.vertices[c[2]];
    const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(2 * longest / cell)));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const Eigen::Vector3d x = p + (q - p) * i / n + (r - p) * j / n;
        tree->updateNode(
            octomap::point3d(static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z())),
            true, true);
      }
  }
  tree->updateInnerOccupancy();
  return tree;
}

class Octree : public MethodOf<OctreeBody> {
 public:
  void set(double cells) override { cells_ = cells; }

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    const Triangles t = triangles_of(rep);
    check_fits_float(t);
    auto body = std::make_unique<OctreeBody>();
    Eigen::AlignedBox3d box;
    for (const auto& c : t.triangles)
      for (const VertexId v : c) box.extend(t.vertices[v]);
    body->cells = std::make_unique<fcl::OcTreed>(cells_of(t, box.diagonal().norm() / cells_));
    body->cells->computeLocalAABB();
    body->mesh = model_of<fcl::OBBRSSd>(t);
    return body;
  }

  /// Queries A's cells against B's mesh.
  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    return contacts_of(*a.body.cells, a.pose, b.body.mesh, b.pose, mode);
  }

 private:
  double cells_ = 32;
};

struct HullBody : MethodBody {
  std::unique_ptr<fcl::Convexd> hull;
};

class Gjk : public MethodOf<HullBody> {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    const Triangles t = triangles_of(rep);
    std::vector<bool> used(t.vertices.size());
    for (const auto& c : t.triangles)
      for (const VertexId v : c) used[v] = true;
    std::vector<Eigen::Vector3d> points;
    for (std::size_t v = 0; v < used.size(); ++v)
      if (used[v]) points.push_back(t.vertices[v]);
    const Mesh mesh = convex_hull_mesh(points);
    if (mesh.face_count() == 0) throw InputError("a flat body: it has no convex hull");
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>(mesh.vertices.begin(), mesh.vertices.end());
    auto faces = std::make_shared<std::vector<int>>();
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      faces->push_back(3);
      for (const VertexId v : mesh.face(f)) faces->push_back(static_cast<int>(v));
    }
    auto body = std::make_unique<HullBody>();
    body->hull = std::make_unique<fcl::Convexd>(vertices, static_cast<int>(mesh.face_count()), faces);
    body->hull->computeLocalAABB();
    return body;
  }

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    return contacts_of(*a.body.hull, a.pose, *b.body.hull, b.pose, mode);
  }
};

#endif

}  // namespace

std::vector<MethodEntry> fcl_solids_methods() {
  return {
      entry_of<Octree>(
          {.name = "fcl-octree",
           .title = LRB_FCL ", octree against mesh",
           .remark =
               "Contact, and points of it: A as an octree (OctoMap) of the cells that its surface intersects, B as a "
               "mesh. Setting: number of cells along A's diagonal.",
           .pairs = false,
           .traits = {Trait::approximate},
           .parameter = "cells",
           .settings = {16, 32, 64, 128},
           .style = {"octree (FCL), by cells", "#8a5a2b", "rect"},
           .rank = 90},
          "libfcl-dev"),
      entry_of<Gjk>(
          {.name = "fcl-gjk",
           .title = LRB_FCL ", GJK of convex hulls",
           .remark =
               "Contact, and a point of it: the convex hulls of both bodies by GJK and EPA (libccd). Correct if the "
               "bodies are convex and neither is inside the other.",
           .pairs = false,
           .traits = {Trait::convex},
           .style = {"convex hulls, GJK (FCL)", "#a3132f", "triangle"},
           .rank = 91},
          "libfcl-dev")};
}

}  // namespace lrb::methods

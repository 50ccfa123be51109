#pragma once
/// FCL's interface to this engine, for programs written for FCL 0.7 that need exact answers without changes.
/// Requires FCL's headers and library (Debian: libfcl-dev). FCL still answers for geometry other than meshes.
///
/// Include this header and replace fcl:: by lrb::fcl::, in using directives too. Then collide() and
/// distance() of two meshes (BVHModel of any bounding volume) are this engine's, and every other name is
/// FCL's own:
///
/// - Contacts list the intersecting pairs of triangles, each once, ascending; only the first one found if
///   num_max_contacts is 1. With enable_contact, each has the centroid of the corners of the two triangles'
///   intersection as its point, and the normal and depth of its contact manifold (ContactManifold), also if
///   the triangles of a closed mesh are inward-oriented.
/// - Distances are measured between the surfaces, to 1e-12 of the meshes' size regardless of rel_err and
///   abs_err; 0 if they intersect. Nearest points are in the world frame.
/// - As in FCL, a mesh inside another one does not collide with it unless the surfaces intersect.
/// - Costs, and geometry that is not occupied, are forwarded to FCL. Coordinates that are not finite throw
///   lrb::InputError.
///
/// A mesh is converted to a body without regions when it is first queried, and the body is cached. Because
/// programs change their meshes, each call compares the mesh with the cached body number by number: about 1
/// ns per vertex. To avoid this, call lrb::collide() with the body_of() the mesh.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/distance.h>

#include <lrbscope/body.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::fcl {

using namespace ::fcl;
// FCL's other overloads. Those below are more constrained than FCL's of the same arguments, so that they are
// chosen in unqualified calls as well, which find both.
using ::fcl::collide;
using ::fcl::distance;

/// The arrays of an FCL mesh.
template <class S>
struct MeshArrays {
  std::span<const ::fcl::Vector3<S>> vertices;
  std::span<const ::fcl::Triangle> triangles;

  bool empty() const { return triangles.empty(); }
};

template <class BV>
MeshArrays<typename BV::S> arrays_of(const ::fcl::BVHModel<BV>& model) {
  if (model.getModelType() != ::fcl::BVH_MODEL_TRIANGLES) return {};
  return {{model.vertices, static_cast<std::size_t>(model.num_vertices)},
          {model.tri_indices, static_cast<std::size_t>(model.num_tris)}};
}

/// Returns the arrays of a geometry that is a mesh; empty arrays for any other.
template <class S>
MeshArrays<S> arrays_of(const ::fcl::CollisionGeometry<S>& geometry) {
  const auto as = [&]<class BV>(const BV*) {
    return arrays_of(static_cast<const ::fcl::BVHModel<BV>&>(geometry));
  };
  switch (geometry.getNodeType()) {
    case ::fcl::BV_AABB:
      return as(static_cast<::fcl::AABB<S>*>(nullptr));
    case ::fcl::BV_OBB:
      return as(static_cast<::fcl::OBB<S>*>(nullptr));
    case ::fcl::BV_RSS:
      return as(static_cast<::fcl::RSS<S>*>(nullptr));
    case ::fcl::BV_kIOS:
      return as(static_cast<::fcl::kIOS<S>*>(nullptr));
    case ::fcl::BV_OBBRSS:
      return as(static_cast<::fcl::OBBRSS<S>*>(nullptr));
    case ::fcl::BV_KDOP16:
      return as(static_cast<::fcl::KDOP<S, 16>*>(nullptr));
    case ::fcl::BV_KDOP18:
      return as(static_cast<::fcl::KDOP<S, 18>*>(nullptr));
    case ::fcl::BV_KDOP24:
      return as(static_cast<::fcl::KDOP<S, 24>*>(nullptr));
    default:
      return {};
  }
}

template <class S>
Pose pose_of(const ::fcl::Transform3<S>& transform) {
  return {transform.linear().template cast<double>(), transform.translation().template cast<double>()};
}

/// Creates a body from a mesh's arrays, with its faces unchanged. `options`: what to build in addition.
template <class S>
Expected<Body> body_of(const MeshArrays<S>& arrays, const BodyOptions& options) {
  Mesh mesh;
  mesh.vertices.reserve(arrays.vertices.size());
  for (const ::fcl::Vector3<S>& v : arrays.vertices) mesh.vertices.push_back(v.template cast<double>());
  mesh.face_vertices.reserve(3 * arrays.triangles.size());
  for (const ::fcl::Triangle& t : arrays.triangles)
    mesh.add_face(std::initializer_list<VertexId>{VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
  return Body::from(std::move(mesh), options);
}

/// Returns the options of a body for FCL's answers: faces only, unchanged.
inline BodyOptions faces_alone() {
  return {.build = {}, .regions = false, .turn = false, .name = "BVHModel"};
}

/// Creates a body from an FCL mesh. Faces have the numbers of its triangles. The default is without regions
/// and without reorientation.
template <class BV>
Expected<Body> body_of(const ::fcl::BVHModel<BV>& model, const BodyOptions& options = faces_alone()) {
  return body_of(arrays_of(model), options);
}

/// A thread-safe cache of bodies by the addresses of their meshes. Keeps the 256 used last.
class KnownBodies {
 public:
  /// Returns the body of a mesh in its current state. Throws InputError if it cannot be converted.
  template <class S>
  Body of(const void* address, const MeshArrays<S>& arrays) {
    if (std::shared_ptr<const Body> known = find(address); known && is_same(*known, arrays)) return *known;
    BodyOptions options = faces_alone();
    options.turn = true;  // for normals and depths of contacts; a component inside another one is a void
    const auto made = std::make_shared<const Body>(body_of(arrays, options).value());
    keep(address, made);
    return *made;
  }

  /// Empties the cache, to free its memory.
  void clear() {
    const std::lock_guard lock(mutex_);
    entries_.clear();
  }
  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
  }

 private:
  static constexpr std::size_t kMax = 256;

  struct Entry {
    std::shared_ptr<const Body> body;
    std::uint64_t last_use = 0;  ///< time of last use
  };

  template <class S>
  static bool is_same(const Body& body, const MeshArrays<S>& arrays) {
    const LrbData& data = body.rep().data();
    if (data.vertices.size() != arrays.vertices.size() || data.face_count() != arrays.triangles.size())
      return false;
    for (std::size_t i = 0; i < arrays.vertices.size(); ++i)
      if (data.vertices[i] != arrays.vertices[i].template cast<double>()) return false;
    for (std::size_t i = 0; i < arrays.triangles.size(); ++i) {
      const ::fcl::Triangle& t = arrays.triangles[i];
      const VertexId* c = &data.face_vertices[3 * i];
      const auto follow = [&](int k, int m) { return c[1].value() == t[k] && c[2].value() == t[m]; };
      if (c[0].value() != t[0] || !(follow(1, 2) || (body.turned() > 0 && follow(2, 1)))) return false;
    }
    return true;
  }

  std::shared_ptr<const Body> find(const void* address) {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(address);
    if (found == entries_.end()) return nullptr;
    found->second.last_use = ++clock_;
    return found->second.body;
  }

  void keep(const void* address, std::shared_ptr<const Body> body) {
    const std::lock_guard lock(mutex_);
    entries_[address] = {std::move(body), ++clock_};
    if (entries_.size() <= kMax) return;
    entries_.erase(std::min_element(entries_.begin(), entries_.end(), [](const auto& x, const auto& y) {
      return x.second.last_use < y.second.last_use;
    }));
  }

  mutable std::mutex mutex_;
  std::uint64_t clock_ = 0;
  std::unordered_map<const void*, Entry> entries_;
};

inline KnownBodies& known_bodies() {
  static KnownBodies bodies;
  return bodies;
}

/// Returns the workspace of the calling thread.
inline Workspace& workspace() {
  thread_local Workspace memory;
  return memory;
}

/// Returns the centroid of the corners of two triangles' intersection.
inline Eigen::Vector3d centroid_of(const PairContactRecord& contact) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < contact.corner_count; ++i) sum += contact.corners[i].x / contact.corner_count;
  return sum;
}

/// Adds the pairs of an answer to FCL's result, up to the maximum of the request. `manifolds`: of the same
/// pairs, if contacts are requested.
template <class S>
void add_contacts(const CollideResult& found, const std::vector<ContactManifold>& manifolds,
                  const ::fcl::CollisionGeometry<S>* o1, const ::fcl::CollisionGeometry<S>* o2,
                  const ::fcl::CollisionRequest<S>& request, ::fcl::CollisionResult<S>& result) {
  std::vector<const ContactManifold*> manifold_of(found.pairs.size());
  for (const ContactManifold& manifold : manifolds)
    for (const std::uint32_t pair : manifold.pairs) manifold_of[pair] = &manifold;
  for (std::size_t i = 0; i < found.pairs.size() && result.numContacts() < request.num_max_contacts; ++i) {
    ::fcl::Contact<S> contact(o1, o2, static_cast<int>(found.pairs[i].a.value()),
                              static_cast<int>(found.pairs[i].b.value()));
    if (request.enable_contact) {
      contact.pos = centroid_of(found.contacts[i]).template cast<S>();
      contact.normal = manifold_of[i]->normal.template cast<S>();
      contact.penetration_depth = static_cast<S>(std::max(manifold_of[i]->points[0].depth, 0.0));
    }
    result.addContact(contact);
  }
}

/// Adds the contacts of two geometries to the result and returns their total number, including earlier ones.
/// Geometries that are not meshes, costs, and geometry that is not occupied are forwarded to FCL.
template <std::floating_point S>
std::size_t collide(const ::fcl::CollisionGeometry<S>* o1, const ::fcl::Transform3<S>& tf1,
                    const ::fcl::CollisionGeometry<S>* o2, const ::fcl::Transform3<S>& tf2,
                    const ::fcl::CollisionRequest<S>& request, ::fcl::CollisionResult<S>& result) {
  const MeshArrays<S> a = arrays_of(*o1), b = arrays_of(*o2);
  if (a.empty() || b.empty() || request.enable_cost || !o1->isOccupied() || !o2->isOccupied())
    return ::fcl::collide(o1, tf1, o2, tf2, request, result);
  if (result.numContacts() >= request.num_max_contacts) return result.numContacts();
  const FloatMode float_mode;
  CollideRequest query;
  query.contacts = request.enable_contact;
  if (!request.enable_contact && request.num_max_contacts - result.numContacts() == 1)
    query.mode = Mode::any_pair;
  const Body body_a = known_bodies().of(o1, a), body_b = known_bodies().of(o2, b);
  const Pose pose_a = fcl::pose_of<S>(tf1), pose_b = fcl::pose_of<S>(tf2);
  const CollideResult& found = lrb::collide(body_a, pose_a, body_b, pose_b, query, workspace()).value();
  const ManifoldResult none;
  const ManifoldResult& found_manifolds =
      query.contacts ? contact_manifolds(body_a.rep(), pose_a, body_b.rep(), pose_b, {}, workspace()).value()
                     : none;
  add_contacts(found, found_manifolds.manifolds, o1, o2, request, result);
  return result.numContacts();
}

template <std::floating_point S>
std::size_t collide(const ::fcl::CollisionObject<S>* o1, const ::fcl::CollisionObject<S>* o2,
                    const ::fcl::CollisionRequest<S>& request, ::fcl::CollisionResult<S>& result) {
  return fcl::collide(o1->collisionGeometry().get(), o1->getTransform(), o2->collisionGeometry().get(),
                      o2->getTransform(), request, result);
}

/// Updates the result with the distance of two geometries and returns its minimum distance, including earlier
/// ones. Geometries that are not meshes are forwarded to FCL.
template <std::floating_point S>
S distance(const ::fcl::CollisionGeometry<S>* o1, const ::fcl::Transform3<S>& tf1,
           const ::fcl::CollisionGeometry<S>* o2, const ::fcl::Transform3<S>& tf2,
           const ::fcl::DistanceRequest<S>& request, ::fcl::DistanceResult<S>& result) {
  const MeshArrays<S> a = arrays_of(*o1), b = arrays_of(*o2);
  if (a.empty() || b.empty()) return ::fcl::distance(o1, tf1, o2, tf2, request, result);
  const FloatMode float_mode;
  lrb::DistanceRequest query;
  query.relation = false;
  const Body body_a = known_bodies().of(o1, a), body_b = known_bodies().of(o2, b);
  const lrb::DistanceResult& found =
      lrb::distance(body_a, fcl::pose_of<S>(tf1), body_b, fcl::pose_of<S>(tf2), query, workspace()).value();
  const Witness &a_at = found.witness[0], &b_at = found.witness[1];
  result.update(static_cast<S>(found.upper), o1, o2, static_cast<int>(a_at.simplex.value()),
                static_cast<int>(b_at.simplex.value()), a_at.point.template cast<S>(),
                b_at.point.template cast<S>());
  return result.min_distance;
}

template <std::floating_point S>
S distance(const ::fcl::CollisionObject<S>* o1, const ::fcl::CollisionObject<S>* o2,
           const ::fcl::DistanceRequest<S>& request, ::fcl::DistanceResult<S>& result) {
  return fcl::distance(o1->collisionGeometry().get(), o1->getTransform(), o2->collisionGeometry().get(),
                       o2->getTransform(), request, result);
}

}  // namespace lrb::fcl

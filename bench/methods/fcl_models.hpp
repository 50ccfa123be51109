#pragma once
/// Bodies and poses in FCL's form.

#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>

#include "bench/methods/triangles.hpp"
#include <lrbscope/error.hpp>

namespace lrb::methods {

/// Returns the triangles, moved by a vector, with FCL's tree of a bounding volume.
template <class Volume>
fcl::BVHModel<Volume> model_of(const Triangles& t, const Eigen::Vector3d& by = {0, 0, 0}) {
  using S = typename Volume::S;
  std::vector<fcl::Vector3<S>> vertices;
  std::vector<fcl::Triangle> triangles;
  for (const Eigen::Vector3d& v : t.vertices) vertices.push_back((v + by).cast<S>());
  for (const auto& c : t.triangles) triangles.emplace_back(c[0], c[1], c[2]);
  fcl::BVHModel<Volume> model;
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model.addSubModel(vertices, triangles);
  if (model.endModel() != fcl::BVH_OK) throw InputError("FCL cannot build its tree");
  return model;
}

template <class S>
fcl::Transform3<S> transform(const Pose& pose) {
  fcl::Transform3<S> t = fcl::Transform3<S>::Identity();
  t.linear() = pose.r.template cast<S>();
  t.translation() = pose.t.template cast<S>();
  return t;
}

}  // namespace lrb::methods

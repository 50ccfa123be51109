#pragma once
/// What benchmarks ask FCL with: the packaged code, or, where fcl_instantiated.hpp is included before, that
/// compiled with our flags.

#include <memory>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::bench {

/// Returns a body's real simplices, moved, as a model with a tree of these volumes.
template <class Volume>
std::shared_ptr<fcl::BVHModel<Volume>> fcl_model(const LrbRep& rep, const Pose& pose = {}) {
  auto model = std::make_shared<fcl::BVHModel<Volume>>();
  std::vector<fcl::Vector3d> points;
  for (const Eigen::Vector3d& v : rep.vertices()) points.push_back(pose.apply(v));
  std::vector<fcl::Triangle> triangles;
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    triangles.emplace_back(v[0], v[1], v[2]);
  }
  model->beginModel();
  model->addSubModel(points, triangles);
  model->endModel();
  return model;
}

inline fcl::Transform3d fcl_pose(const Pose& p) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = p.r;
  t.translation() = p.t;
  return t;
}

}  // namespace lrb::bench

#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// World coordinates of one body's vertices during one query: each vertex is moved at most once, when it is
/// first needed.
class WorldVertices {
 public:
  void begin(const LrbRep& rep, const Pose& pose) {
    rep_ = &rep;
    pose_ = pose;
    if (slots_.size() < rep.vertices().size()) slots_.resize(rep.vertices().size());
    if (++epoch_ == 0) {
      for (Slot& s : slots_) s.epoch = 0;
      epoch_ = 1;
    }
  }

  const LrbRep& rep() const { return *rep_; }
  const Pose& pose() const { return pose_; }

  /// Returns the world coordinates (x, y, z) of a vertex. The pointer is valid until the next begin().
  const double* operator()(VertexId v) {
    Slot& s = slots_[v];
    if (s.epoch != epoch_) {
      s.x = pose_.apply(rep_->vertices()[v]);
      s.epoch = epoch_;
    }
    return s.x.data();
  }

  /// Writes pointers to the world coordinates of a simplex's corners (3, or 2 in 2D) to out.
  void corners(SimplexId s, const double* out[3]) {
    VertexId v[3];
    rep_->simplex(s, v);
    for (int k = 0; k < rep_->simplex_size(); ++k) out[k] = (*this)(v[k]);
  }

 private:
  struct Slot {
    Eigen::Vector3d x;
    std::uint32_t epoch = 0;
  };
  const LrbRep* rep_ = nullptr;
  Pose pose_;
  std::uint32_t epoch_ = 0;
  std::vector<Slot> slots_;
};

}  // namespace lrb

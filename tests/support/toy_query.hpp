#pragma once
/// A slow, plain two-body query that talks to a probe like the real one: all pairs of faces of both wrappers,
/// refining what hits, until nothing new hits.

#include <array>
#include <set>
#include <utility>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::toy {

using Corners = std::array<Eigen::Vector3d, 3>;

inline Corners corners_of(const LrbRep& rep, const Pose& pose, SimplexId s) {
  VertexId v[3] = {};
  rep.simplex(s, v);
  Corners c;
  for (int i = 0; i < rep.simplex_size(); ++i)
    c[static_cast<std::size_t>(i)] = pose.apply(rep.vertices()[v[i]]);
  return c;
}

inline exact::Meet meet(int dim, const Corners& a, const Corners& b) {
  const double* const p[3] = {a[0].data(), a[1].data(), a[2].data()};
  const double* const q[3] = {b[0].data(), b[1].data(), b[2].data()};
  return dim == 2 ? exact::meet_segments(p, q) : exact::meet_triangles(p, q);
}

inline std::uint32_t depth_of(const LrbRep& rep, FaceId f) {
  const CellId cell = rep.outer_cell(f);
  return is_region(cell) ? rep.depth(cell.as_region()) : 0;
}

/// `watch()` is called after each call of the probe.
template <class Probe, class Watch>
class Query {
 public:
  Query(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b, WrapperMode mode,
        Probe& probe, Watch watch)
      : reps_{&a, &b},
        poses_{pose_a, pose_b},
        wrappers_{Wrapper(a, mode), Wrapper(b, mode)},
        probe_(probe),
        watch_(std::move(watch)) {}

  CollideResult run() {
    while (round()) {
    }
    result_.relation = result_.pairs.empty() ? Relation::separate : Relation::crossing;
    return result_;
  }

  const Wrapper& wrapper(std::size_t side) const { return wrappers_[side]; }

 private:
  /// One pass over the present faces; true if it refined something.
  bool round() {
    bool refined = false;
    const std::vector<FaceId> faces_a = wrappers_[0].boundary(), faces_b = wrappers_[1].boundary();
    for (const FaceId fa : faces_a)
      for (const FaceId fb : faces_b)
        if (wrappers_[0].on_boundary(fa) && wrappers_[1].on_boundary(fb)) refined |= test_faces(fa, fb);
    return refined;
  }

  bool test_faces(FaceId fa, FaceId fb) {
    const auto end_of = [](const LrbRep& rep, FaceId f) {
      return f + 1 < rep.face_count() ? rep.first_simplex(FaceId(f + 1)).value() : rep.simplex_count();
    };
    if (!tested_.insert({fa, fb}).second) return false;
    for (SimplexId sa = reps_[0]->first_simplex(fa); sa < end_of(*reps_[0], fa); ++sa)
      for (SimplexId sb = reps_[1]->first_simplex(fb); sb < end_of(*reps_[1], fb); ++sb)
        if (test(sa, fa, sb, fb)) return true;
    return false;
  }

  bool test(SimplexId sa, FaceId fa, SimplexId sb, FaceId fb) {
    const exact::Meet m =
        meet(reps_[0]->dim(), corners_of(*reps_[0], poses_[0], sa), corners_of(*reps_[1], poses_[1], sb));
    ++result_.counters.face_tests;
    probe_.face_test(sa, sb, m, depth_of(*reps_[0], fa), depth_of(*reps_[1], fb));
    watch_();
    if (m == exact::Meet::disjoint) return false;
    if (reps_[0]->is_real(fa) && reps_[1]->is_real(fb)) {
      result_.pairs.push_back({sa, sb});
      probe_.contact(sa, sb, m);
      watch_();
      return false;
    }
    const bool a = refine(Side::a, fa), b = refine(Side::b, fb);
    return a || b;
  }

  bool refine(Side side, FaceId f) {
    const auto i = static_cast<std::size_t>(side);
    if (reps_[i]->is_real(f)) return false;
    const RegionId r = reps_[i]->inner_cell(f).as_region();
    const bool first = wrappers_[i].included(r);
    if (!wrappers_[i].refine_face(f)) return false;
    ++result_.counters.refinements;
    probe_.refine(side, r, first ? static_cast<std::uint32_t>(reps_[i]->floor(r).size()) : 0);
    watch_();
    return true;
  }

  std::array<const LrbRep*, 2> reps_;
  std::array<Pose, 2> poses_;
  std::array<Wrapper, 2> wrappers_;
  Probe& probe_;
  Watch watch_;
  std::set<std::pair<FaceId, FaceId>> tested_;
  CollideResult result_;
};

}  // namespace lrb::toy

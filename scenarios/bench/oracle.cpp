#include "scenarios/bench/oracle.hpp"

#include <algorithm>

#include "engine/exact/simplex_test.hpp"
#include "engine/mesh/box_pairs.hpp"

namespace lrb::bench {
namespace {

struct WorldBody {
  WorldBody(const LrbRep& r, const Pose& pose) : rep(r) {
    for (const Eigen::Vector3d& v : r.vertices()) x.push_back(pose.apply(v));
    for (SimplexId s = 0; s < r.real_simplex_count(); ++s) whole.extend(box(s));
  }
  void corners(SimplexId s, const double* out[3]) const {
    VertexId v[3] = {};
    rep.simplex(s, v);
    for (int k = 0; k < 3; ++k) out[k] = x[v[k]].data();
  }
  Box box(SimplexId s) const {
    VertexId v[3] = {};
    rep.simplex(s, v);
    Box b;
    for (const VertexId i : v) b.extend(x[i]);
    return b;
  }
  const LrbRep& rep;
  std::vector<Eigen::Vector3d> x;
  Box whole;
};

}  // namespace

std::vector<SimplexPair> exact_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                     const Pose& pose_b) {
  const WorldBody wa(a, pose_a), wb(b, pose_b);
  const std::uint32_t first_of_b = a.real_simplex_count();
  std::vector<Box> boxes(first_of_b + b.real_simplex_count());
  const auto add = [&](const WorldBody& body, const Box& other, std::uint32_t first) {
    for (SimplexId s = 0; s < body.rep.real_simplex_count(); ++s)
      if (const Box box = body.box(s); box.intersects(other)) boxes[first + s] = box;
  };
  add(wa, wb.whole, 0);
  add(wb, wa.whole, first_of_b);
  std::vector<SimplexPair> pairs;
  BoxTree(boxes).for_each_pair([&](std::uint32_t i, std::uint32_t j) {
    if (i >= first_of_b || j < first_of_b) return;
    const double *ca[3], *cb[3];
    const SimplexPair pair{SimplexId(i), SimplexId(j - first_of_b)};
    wa.corners(pair.a, ca);
    wb.corners(pair.b, cb);
    if (exact::meet_triangles(ca, cb) != exact::Meet::disjoint) pairs.push_back(pair);
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace lrb::bench

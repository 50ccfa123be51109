#pragma once
/// Brute force for bodies that are too large for it: pairs of simplices whose boxes in the world are apart
/// are left out, which is exact, as the boxes are those of the very doubles that the answer is about. Boxes
/// are sorted along one axis and swept. No tree, no float, nothing shared with the query but exact predicates
/// and the definition of world coordinates.

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "engine/exact/locate.hpp"
#include <lrbscope/collide.hpp>

namespace lrb::torture {

class SweptBody {
 public:
  struct Box {
    double low[3], high[3];
    bool meets(const Box& o) const {
      for (int k = 0; k < 3; ++k)
        if (high[k] < o.low[k] || o.high[k] < low[k]) return false;
      return true;
    }
    void extend(const Box& o) {
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], o.low[k]);
        high[k] = std::max(high[k], o.high[k]);
      }
    }
  };

  SweptBody(const LrbRep& rep, const Pose& pose) : rep_(rep) {
    for (const auto& v : rep.vertices()) x_.push_back(pose.apply(v));
    boxes_.resize(rep.real_simplex_count());
    for (SimplexId s = 0; s < boxes_.size(); ++s) {
      const double* c[3];
      corners(s, c);
      for (int k = 0; k < 3; ++k) {
        const double z = rep.dim() == 2 && k == 2 ? 0 : c[0][k];
        boxes_[s].low[k] = boxes_[s].high[k] = z;
        for (int i = 1; i < rep.simplex_size() && k < rep.dim(); ++i) {
          boxes_[s].low[k] = std::min(boxes_[s].low[k], c[i][k]);
          boxes_[s].high[k] = std::max(boxes_[s].high[k], c[i][k]);
        }
      }
    }
  }

  const LrbRep& rep() const { return rep_; }
  const Box& box(SimplexId s) const { return boxes_[s]; }
  const double* vertex(VertexId v) const { return x_[v].data(); }

  void corners(SimplexId s, const double* out[3]) const {
    VertexId v[3];
    rep_.simplex(s, v);
    for (int k = 0; k < rep_.simplex_size(); ++k) out[k] = x_[v[k]].data();
  }

  static Box whole(const SweptBody& body, const std::vector<SimplexId>& list) {
    constexpr double kMax = std::numeric_limits<double>::max();
    Box all{{kMax, kMax, kMax}, {-kMax, -kMax, -kMax}};
    for (const SimplexId s : list) all.extend(body.box(s));
    return all;
  }

  bool is_apart_from(const SweptBody& other) const {
    return !whole(*this, all()).meets(whole(other, other.all()));
  }

  bool holds(const double* point) const {
    int crossings = 0;
    const double* c[3];
    for (SimplexId s = 0; s < boxes_.size(); ++s) {
      const Box& b = boxes_[s];
      if (b.high[0] < point[0] || b.high[1] < point[1] || point[1] < b.low[1]) continue;
      if (rep_.dim() == 3 && (b.high[2] < point[2] || point[2] < b.low[2])) continue;
      corners(s, c);
      const exact::RayHit hit =
          rep_.dim() == 3 ? exact::ray_crosses(point, c) : exact::ray_crosses_2d(point, c);
      crossings += hit == exact::RayHit::crosses;
    }
    return crossings % 2 != 0;
  }

 private:
  std::vector<SimplexId> all() const {
    std::vector<SimplexId> out(boxes_.size());
    std::iota(out.begin(), out.end(), SimplexId{0});
    return out;
  }

  const LrbRep& rep_;
  std::vector<Eigen::Vector3d> x_;
  std::vector<Box> boxes_;
};

/// The simplices of both bodies that reach into the box of the other's such simplices.
inline void clip(const SweptBody& a, const SweptBody& b, std::vector<SimplexId>& in_a,
                 std::vector<SimplexId>& in_b) {
  in_a.resize(a.rep().real_simplex_count());
  in_b.resize(b.rep().real_simplex_count());
  std::iota(in_a.begin(), in_a.end(), SimplexId{0});
  std::iota(in_b.begin(), in_b.end(), SimplexId{0});
  for (std::size_t before = 0; before != in_a.size() + in_b.size() && !in_a.empty() && !in_b.empty();) {
    before = in_a.size() + in_b.size();
    const auto of_a = SweptBody::whole(a, in_a);
    std::erase_if(in_b, [&](SimplexId s) { return !of_a.meets(b.box(s)); });
    const auto of_b = SweptBody::whole(b, in_b);
    std::erase_if(in_a, [&](SimplexId s) { return !of_b.meets(a.box(s)); });
  }
}

/// brute_force(), faster.
inline BruteForceResult swept_brute_force(const LrbRep& rep_a, const Pose& pose_a, const LrbRep& rep_b,
                                          const Pose& pose_b) {
  const SweptBody a(rep_a, pose_a), b(rep_b, pose_b);
  std::vector<SimplexId> in_a, in_b;
  clip(a, b, in_a, in_b);
  // Along the longest side: b by lower end, with the highest upper end so far.
  const auto all = SweptBody::whole(b, in_b);
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (all.high[k] - all.low[k] > all.high[axis] - all.low[axis]) axis = k;
  std::sort(in_b.begin(), in_b.end(),
            [&](SimplexId s, SimplexId t) { return b.box(s).low[axis] < b.box(t).low[axis]; });
  std::vector<double> reach;
  for (const SimplexId t : in_b)
    reach.push_back(std::max(reach.empty() ? b.box(t).high[axis] : reach.back(), b.box(t).high[axis]));

  std::vector<std::pair<SimplexPair, exact::Meet>> found;
  const double *ca[3], *cb[3];
  for (const SimplexId s : in_a) {
    const auto& box = a.box(s);
    auto i =
        static_cast<std::size_t>(std::lower_bound(reach.begin(), reach.end(), box.low[axis]) - reach.begin());
    a.corners(s, ca);
    for (; i < in_b.size() && b.box(in_b[i]).low[axis] <= box.high[axis]; ++i) {
      if (!box.meets(b.box(in_b[i]))) continue;
      b.corners(in_b[i], cb);
      const exact::Meet meet =
          rep_a.dim() == 3 ? exact::meet_triangles(ca, cb) : exact::meet_segments(ca, cb);
      if (meet != exact::Meet::disjoint) found.push_back({{s, in_b[i]}, meet});
    }
  }
  std::sort(found.begin(), found.end());

  BruteForceResult r;
  r.relation = Relation::touching;
  for (const auto& [pair, meet] : found) {
    r.pairs.push_back(pair);
    r.meets.push_back(meet);
    if (meet == exact::Meet::cross) r.relation = Relation::crossing;
  }
  if (!found.empty()) return r;
  r.relation = a.is_apart_from(b) ? Relation::separate : Relation::undefined;
  if (!rep_a.closed() || !rep_b.closed()) return r;
  const auto held = [](const SweptBody& inner, const SweptBody& outer) {
    const auto vertices = inner.rep().component_vertices();
    return std::count_if(vertices.begin(), vertices.end(),
                         [&](VertexId v) { return outer.holds(inner.vertex(v)); });
  };
  const auto a_in_b = held(a, b), b_in_a = held(b, a);
  const auto pieces_a = static_cast<std::ptrdiff_t>(rep_a.component_vertices().size()),
             pieces_b = static_cast<std::ptrdiff_t>(rep_b.component_vertices().size());
  r.relation = Relation::separate;
  if (b_in_a > 0) r.relation = Relation::b_inside_a;
  if (a_in_b > 0 && (a_in_b == pieces_a || b_in_a != pieces_b)) r.relation = Relation::a_inside_b;
  return r;
}

}  // namespace lrb::torture

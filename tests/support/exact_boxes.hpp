#pragma once
/// Boxes of two nodes, as a kernel turns them to a set of axes, against what they must hold in exact
/// arithmetic. To be included after a kernel.

#include <cmath>
#include <set>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
#include <doctest/doctest.h>

#include "bench/cases/families.hpp"
#include "engine/tree/kernel_boxes.inl"
#include "tests/support/bodies.hpp"
#include "tests/support/margins.hpp"
#include "tests/support/rational_oracle.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb {
namespace {

using boost::multiprecision::cpp_int;
using cases::RandomEngine;

/// mantissa * 2^exponent: sums and products of doubles without rounding.
class Exact {
 public:
  Exact() = default;
  /// Floats that overflowed count as 0 here: the kernel culls nothing by them, so that they bound nothing.
  Exact(double x) {
    if (!std::isfinite(x)) return;
    int e = 0;
    mantissa_ = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &e), 53));
    exponent_ = e - 53;
  }
  friend Exact operator+(const Exact& x, const Exact& y) {
    if (x.mantissa_ == 0) return y;
    if (y.mantissa_ == 0) return x;
    const long low = std::min(x.exponent_, y.exponent_);
    return {(x.mantissa_ << (x.exponent_ - low)) + (y.mantissa_ << (y.exponent_ - low)), low};
  }
  friend Exact operator-(const Exact& x, const Exact& y) { return x + Exact(-y.mantissa_, y.exponent_); }
  friend Exact operator*(const Exact& x, const Exact& y) {
    return {x.mantissa_ * y.mantissa_, x.exponent_ + y.exponent_};
  }
  friend bool operator<(const Exact& x, const Exact& y) { return (x - y).mantissa_ < 0; }
  Exact times_power_of_two(int e) const { return {mantissa_, exponent_ + e}; }

 private:
  Exact(cpp_int mantissa, long exponent) : mantissa_(std::move(mantissa)), exponent_(exponent) {}
  cpp_int mantissa_ = 0;
  long exponent_ = 0;
};

using Exact3 = std::array<Exact, 3>;

struct Range {
  Exact low, high;
  bool empty = true;
  void extend(const Exact& x) {
    if (empty || x < low) low = x;
    if (empty || high < x) high = x;
    empty = false;
  }
  void extend(const Range& r) {
    if (r.empty) return;
    extend(r.low);
    extend(r.high);
  }
};
using Range3 = std::array<Range, 3>;

struct Scene {
  const LrbRep *a, *b;
  Pose pose_a, pose_b;
};

/// Two leaves of a body, and a simplex of each, by three numbers in [0, 1).
struct LeafPair {
  const LrbRep& body = bumps();
  const ObbTree& tree = body.tree();
  std::uint32_t index[2];
  int lane[2];

  explicit LeafPair(std::span<const double> genes) {
    std::vector<std::uint32_t> leaves;
    for (std::uint32_t n = 0; n < tree.nodes().size(); ++n)
      if (tree.nodes()[n].is_leaf) leaves.push_back(n);
    for (std::size_t side = 0; side < 2; ++side) {
      index[side] = leaves[static_cast<std::size_t>(genes[side] * static_cast<double>(leaves.size()))];
      lane[side] = static_cast<int>(genes[2] * node(side).count);
    }
  }
  const TreeNode& node(std::size_t side) const { return tree.nodes()[index[side]]; }
  const LeafBlock& block(std::size_t side) const { return tree.blocks()[node(side).first]; }

  /// Returns how much of Between::edge_error two edges of a simplex use. map: from the body to the kernel's
  /// axes; at(block, corner, axis, lane): a corner there, by the kernel.
  template <class At>
  double share(std::size_t side, const Eigen::Matrix3d& map, const Between& w, At&& at) const {
    VertexId v[3];
    body.simplex(block(side).simplex[lane[side]], v);
    double most = 0;
    for (int corner = 0; corner < 2; ++corner) {
      const Eigen::Vector3d exact = map * (body.vertices()[v[corner + 1]] - body.vertices()[v[corner]]);
      for (int i = 0; i < 3; ++i) {
        const float edge =
            at(block(side), corner + 1, i, lane[side]) - at(block(side), corner, i, lane[side]);
        most = std::max(most, std::abs(exact[i] - double{edge}));
      }
    }
    return most / w.edge_error[side];
  }

  /// Returns the upper end of a leaf's content along d.
  double end(std::size_t side, const Eigen::Vector3d& d) const {
    double most = -INFINITY;
    for (int k = 0; k < node(side).count; ++k) {
      VertexId v[3];
      body.simplex(block(side).simplex[k], v);
      for (const VertexId corner : v) most = std::max(most, d.dot(body.vertices()[corner]));
    }
    return most;
  }

 private:
  static const LrbRep& bumps() {
    static const LrbRep rep = test::closed(shapes::bumpy_sphere(1, 3));
    return rep;
  }
};

/// Appends the simplices beneath a node.
void simplices_under(const ObbTree& t, std::uint32_t node, std::vector<SimplexId>& out) {
  const TreeNode& n = t.nodes()[node];
  for (std::uint32_t k = 0; k < n.count; ++k) {
    if (n.is_leaf)
      out.push_back(t.blocks()[n.first].simplex[k]);
    else
      simplices_under(t, n.first + k, out);
  }
}

/// The simplices that each box of a node must hold.
std::vector<std::vector<SimplexId>> contents(const LrbRep& rep, std::uint32_t node) {
  const TreeNode& n = rep.tree().nodes()[node];
  std::vector<std::vector<SimplexId>> r(n.count);
  for (std::uint32_t k = 0; k < n.count; ++k) {
    if (n.is_leaf)
      r[k].push_back(rep.tree().blocks()[n.first].simplex[k]);
    else
      simplices_under(rep.tree(), n.first + k, r[k]);
  }
  return r;
}

/// The ranges of every real simplex, of its vertices' coordinates.
std::vector<Range3> ranges(const LrbRep& rep, const std::vector<Exact3>& x) {
  std::vector<Range3> r(rep.real_simplex_count());
  for (SimplexId s = 0; s < r.size(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    for (int corner = 0; corner < rep.dim(); ++corner)
      for (int i = 0; i < 3; ++i) r[s][i].extend(x[v[corner]][i]);
  }
  return r;
}

Range3 united(const std::vector<Range3>& of, const std::vector<SimplexId>& list) {
  Range3 r;
  for (const SimplexId s : list)
    for (int i = 0; i < 3; ++i) r[i].extend(of[s][i]);
  return r;
}

/// How far content reaches out of a box less `error`; not below 0. Where floats overflowed nothing is
/// outside, and nothing is culled.
Exact outside(const Range& r, float centre, float half_size, float error) {
  Exact most(0.0);
  if (!std::isfinite(centre) || !std::isfinite(half_size)) return most;
  const Exact half = Exact(half_size) - Exact(error);
  for (const Exact& over : {Exact(centre) - half - r.low, r.high - Exact(centre) - half})
    if (most < over) most = over;
  return most;
}

struct Share {
  void operator+=(const Share& s) {
    boxes += s.boxes;
    culled += s.culled;
    too_small += s.too_small;
    wrong += s.wrong;
  }
  std::uint64_t boxes = 0, culled = 0;
  std::uint64_t too_small = 0;  ///< boxes that, grown by the error, do not hold what they must
  std::uint64_t wrong = 0;      ///< culled, but not apart
};

/// One set of axes: boxes that are at home there, and boxes turned into it and grown by the error.
void check_axes(const std::vector<Range3>& home, const std::vector<Range3>& guest, const Boxes& home_boxes,
                const Turned& guest_boxes, float error, Share& share) {
  if (!std::isfinite(error)) return;  // every box is grown to hold all
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Exact> home_off, guest_off;
    for (std::size_t i = 0; i < home.size(); ++i)
      home_off.push_back(outside(home[i][axis], home_boxes.centre[axis][i], home_boxes.half[axis][i], 0));
    for (std::size_t j = 0; j < guest.size(); ++j)
      guest_off.push_back(
          outside(guest[j][axis], guest_boxes.centre[axis][j], guest_boxes.half[axis][j], error));
    for (std::size_t i = 0; i < home.size(); ++i)
      for (std::size_t j = 0; j < guest.size(); ++j) {
        ++share.boxes;
        // Both boxes, grown once by the error, hold their contents.
        share.too_small += Exact(error) < home_off[i] + guest_off[j];
        // And as the kernel decides, rounding included: culled pairs are disjoint.
        const float gap = std::fabs(guest_boxes.centre[axis][j] - home_boxes.centre[axis][i]);
        if (!(gap > guest_boxes.half[axis][j] + home_boxes.half[axis][i])) continue;
        ++share.culled;
        share.wrong += !(home[i][axis].high < guest[j][axis].low || guest[j][axis].high < home[i][axis].low);
      }
  }
}

/// How two simplices meet in the world, says the rational oracle.
int oracle_meet(const Scene& s, SimplexId a, SimplexId b) {
  const test::Points x = test::simplex_points(*s.a, s.pose_a, a), y = test::simplex_points(*s.b, s.pose_b, b);
  return oracle::meet_of_simplices(test::pointers(x).data(), test::pointers(y).data(), 3);
}

Eigen::AlignedBox3d world_box(const LrbRep& rep, const Pose& pose, SimplexId simplex) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : test::simplex_points(rep, pose, simplex)) box.extend(x);
  return box;
}

struct Checked {
  int dropped = 0, disjoint = 0, cross = 0;
};

/// Checks decided pairs of the kernel against the rational oracle.
void check_certain(const Scene& s, std::span<const Candidate> found, RandomEngine& random, int most,
                   Checked& checked) {
  for (int i = 0; i < most && !found.empty(); ++i) {
    const Candidate& c = found[random() % found.size()];
    if (c.certainty != Certainty::cross && c.certainty != Certainty::disjoint) continue;
    const bool cross = c.certainty == Certainty::cross;
    ++(cross ? checked.cross : checked.disjoint);
    REQUIRE(oracle_meet(s, c.a, c.b) == (cross ? 2 : 0));
  }
}

/// Returns the pairs that a kernel, made ready for the scene, does not drop.
std::vector<Candidate> candidates_of(const Scene& s, TreeKernel& k, void (*run)(TreeKernel&)) {
  std::vector<NodePair> pairs;
  std::vector<Candidate> out(64 + std::size_t{s.a->real_simplex_count()} * s.b->real_simplex_count());
  start_at_roots(k, s.a->tree(), s.b->tree(), pairs);
  k.out = out.data();
  k.out_capacity = static_cast<std::uint32_t>(out.size());
  run(k);
  REQUIRE(is_done(k));
  out.resize(k.out_size);
  return out;
}

/// Pairs culled by boxes or planes are disjoint according to the rational oracle, and decided ones of the
/// others is true. `found`: all that were not dropped.
void check_outcome(const Scene& s, std::span<const Candidate> found, RandomEngine& random, int most,
                   Checked& checked) {
  std::set<std::pair<SimplexId, SimplexId>> kept;
  for (const Candidate& c : found) kept.insert({c.a, c.b});
  for (int i = 0, compared = 0; i < 20 * most && compared < most; ++i) {
    const auto sa = static_cast<SimplexId>(random() % s.a->real_simplex_count()),
               sb = static_cast<SimplexId>(random() % s.b->real_simplex_count());
    if (kept.contains({sa, sb}) || !world_box(*s.a, s.pose_a, sa).intersects(world_box(*s.b, s.pose_b, sb)))
      continue;
    ++compared;
    ++checked.dropped;
    REQUIRE(oracle_meet(s, sa, sb) == 0);
  }
  check_certain(s, found, random, 5 * most, checked);
}

/// Checks that more than `boxes` pairs were compared, and more than the share `culled` of them culled: else
/// nothing was tested.
void check_extent(const Share& share, const Checked& checked, std::uint64_t boxes, double culled) {
  CHECK(share.boxes > boxes);
  CHECK(static_cast<double>(share.culled) > culled * static_cast<double>(share.boxes));
  CHECK(checked.dropped > 100);
  CHECK(checked.disjoint > 100);
  CHECK(checked.cross > 100);
  MESSAGE(share.boxes << " pairs of boxes on an axis, " << share.culled << " culled; " << checked.dropped
                      << " dropped pairs asked again, " << checked.disjoint << " called disjoint, "
                      << checked.cross << " called crossing");
}

}  // namespace
}  // namespace lrb

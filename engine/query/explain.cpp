#include "engine/query/explain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "engine/core/error.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include "engine/query/collide_impl.hpp"
#include "engine/query/node_boxes.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

/// Where a simplex stands in a tree.
struct Path {
  std::vector<std::uint32_t> nodes;  ///< from the root to the leaf
  std::vector<int> child;            ///< (|nodes|) which child of its parent; kWhole: the root
  int place = 0;                     ///< of the simplex in its leaf

  Path(const ObbTree& tree, SimplexId s) {
    const auto& all = tree.nodes();
    std::vector<std::uint32_t> parent(all.size(), 0);
    std::uint32_t leaf = 0;
    for (std::uint32_t n = 0; n < all.size(); ++n) {
      if (all[n].is_leaf == 0) {
        for (std::uint32_t k = 0; k < all[n].count; ++k) parent[all[n].first + k] = n;
        continue;
      }
      const SimplexId* held = tree.blocks()[all[n].first].simplex;
      const SimplexId* at = std::find(held, held + all[n].count, s);
      if (at != held + all[n].count) leaf = n, place = static_cast<int>(at - held);
    }
    for (std::uint32_t n = leaf;; n = parent[n]) {
      nodes.push_back(n);
      child.push_back(n == 0 ? kWhole : static_cast<int>(n - all[parent[n]].first));
      if (n == 0) break;
    }
    std::reverse(nodes.begin(), nodes.end());
    std::reverse(child.begin(), child.end());
  }
};

/// Steps through the walk of two trees.
class Stepper {
 public:
  explicit Stepper(QueryContext& ctx) : ctx_(ctx), k_(start_kernel(ctx, kCapacity)) {}

  /// What came of one pair of nodes: pairs of children, or of simplices.
  struct Outcome {
    std::vector<NodePair> children;
    std::vector<Candidate> candidates;
    std::uint64_t face_pairs;  ///< whose boxes meet
  };

  Outcome step(const NodePair& pair) {
    k_.stack[0] = pair;
    k_.stack_size = 1;
    k_.out_size = 0;
    k_.most_node_pairs = k_.node_pairs + 1;
    const std::uint64_t before = k_.prefilter_tests;
    run_tree_kernel(k_);
    return {
        {k_.stack, k_.stack + k_.stack_size}, {k_.out, k_.out + k_.out_size}, k_.prefilter_tests - before};
  }

  bool is_leaf(Side side, std::uint32_t node) const { return tree(side).nodes()[node].is_leaf != 0; }
  const ObbTree& tree(Side side) const { return ctx_[side].tree(); }

 private:
  static constexpr std::size_t kCapacity = 128;

  QueryContext& ctx_;
  TreeKernel k_;
};

/// Follows the way from the roots to two simplices.
class Way {
 public:
  Way(QueryContext& ctx, PairExplanation& out)
      : ctx_(ctx),
        out_(out),
        stepper_(ctx),
        path_{Path(tree(Side::a), out.pair.a), Path(tree(Side::b), out.pair.b)} {}

  void follow() {
    add_nodes({kWhole, kWhole});
    for (;;) {
      const std::array<std::uint32_t, 2> here = {node(0), node(1)};
      const Stepper::Outcome outcome = stepper_.step({here[0], here[1]});
      if (stepper_.is_leaf(Side::a, here[0]) && stepper_.is_leaf(Side::b, here[1]))
        return compare_faces(outcome);
      const std::array<bool, 2> moves = moves_to(outcome);
      for (int s = 0; s < 2; ++s) at_[s] += moves[s];
      add_nodes({moves[0] ? path_[0].child[at_[0]] : kWhole, moves[1] ? path_[1].child[at_[1]] : kWhole});
      if (!goes_on_) {
        out_.decided_by = out_.nodes.back().gap > 0 ? DecidedBy::node_boxes : DecidedBy::needles;
        return;
      }
    }
  }

 private:
  const ObbTree& tree(Side side) const { return ctx_[side].tree(); }
  std::uint32_t node(int s) const { return path_[s].nodes[at_[s]]; }
  std::uint32_t next(int s) const {
    return at_[s] + 1 < path_[s].nodes.size() ? path_[s].nodes[at_[s] + 1] : node(s);
  }

  /// Adds the pair of nodes that the way has come to. `child`: which box of its parent was compared; kWhole: the
  /// node's own, because only the other one was descended.
  void add_nodes(const std::array<int, 2>& child) {
    BoxPair pair;
    std::array<WorldBox, 2> box;
    for (int s = 0; s < 2; ++s) {
      const Side side = static_cast<Side>(s);
      pair.node[s] = node(s);
      box[s] = box_of(tree(side), child[s] == kWhole ? node(s) : path_[s].nodes[at_[s] - 1], child[s],
                      ctx_[side].world.pose());
    }
    compare_boxes(box[0], box[1], pair);
    out_.nodes.push_back(pair);
  }

  /// Tells which of the two nodes the query descends here, and whether it goes on to the next pair of the way.
  std::array<bool, 2> moves_to(const Stepper::Outcome& outcome) {
    goes_on_ = false;
    std::optional<std::array<bool, 2>> kind;  // of any pair of children: they all descend the same nodes
    for (const NodePair& c : outcome.children) {
      kind = {c.a != node(0), c.b != node(1)};
      const bool on_way = c.a == ((*kind)[0] ? next(0) : node(0)) && c.b == ((*kind)[1] ? next(1) : node(1));
      if (on_way) goes_on_ = true;
    }
    if (kind) return *kind;
    // No two boxes met, so that nothing shows which were compared: those of both nodes where both have some.
    const bool leaf_a = stepper_.is_leaf(Side::a, node(0)), leaf_b = stepper_.is_leaf(Side::b, node(1));
    return {!leaf_a, !leaf_b};
  }

  void compare_faces(const Stepper::Outcome& outcome) {
    out_.reaches_faces = true;
    out_.face_boxes.node = {node(0), node(1)};
    compare_boxes(box_of(tree(Side::a), node(0), path_[0].place, ctx_[Side::a].world.pose()),
                  box_of(tree(Side::b), node(1), path_[1].place, ctx_[Side::b].world.pose()),
                  out_.face_boxes);
    const auto found =
        std::find_if(outcome.candidates.begin(), outcome.candidates.end(),
                     [&](const Candidate& c) { return c.a == out_.pair.a && c.b == out_.pair.b; });
    if (found == outcome.candidates.end()) {
      out_.decided_by = out_.face_boxes.gap > 0 ? DecidedBy::face_boxes : DecidedBy::planes;
    } else {
      const bool certain = found->certainty == Certainty::cross || found->certainty == Certainty::disjoint;
      out_.decided_by = certain ? DecidedBy::floats : DecidedBy::exact;
    }
  }

  QueryContext& ctx_;
  PairExplanation& out_;
  Stepper stepper_;
  std::array<Path, 2> path_;
  std::array<std::size_t, 2> at_ = {0, 0};  ///< places on the paths
  bool goes_on_ = false;
};

using Corners = std::array<const double*, 3>;

Vector3d point(const double* x) {
  return {x[0], x[1], x[2]};
}

PlaneSides sides_of(int dim, const Corners& corners, const Corners& plane) {
  PlaneSides out;
  const Vector3d origin = point(plane[0]), u = point(plane[1]) - origin;
  const Vector3d normal = dim == 3 ? Vector3d(u.cross(point(plane[2]) - origin)) : Vector3d(-u.y(), u.x(), 0);
  const double length = normal.norm();
  for (int i = 0; i < dim; ++i) {
    const auto sign = [&] {
      return dim == 3 ? exact::orient3d(plane[0], plane[1], plane[2], corners[i])
                      : exact::orient2d(plane[0], plane[1], corners[i]);
    };
    out.exact[i] = sign();
    const exact::FloatingPredicates floating;
    out.in_double[i] = sign();
    out.distance[i] = length > 0 ? normal.dot(point(corners[i]) - origin) / length : 0;
  }
  return out;
}

/// Two points, one of each of two simplices.
struct NearPoints {
  Vector3d a, b;
  double distance_sq = std::numeric_limits<double>::infinity();

  void see(const Vector3d& of_a, const Vector3d& of_b) {
    const double d = (of_a - of_b).squaredNorm();
    if (d < distance_sq) a = of_a, b = of_b, distance_sq = d;
  }
};

/// Sees the nearest points of the lines through two segments, if they are on the segments. (Else a corner of one is
/// nearest to the other.)
void see_edges(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s, NearPoints& out) {
  const Vector3d d = q - p, e = s - r, w = p - r;
  const double dd = d.dot(d), ee = e.dot(e), de = d.dot(e), dw = d.dot(w), ew = e.dot(w);
  const double det = dd * ee - de * de;
  if (!(det > 0)) return;
  const double x = (de * ew - ee * dw) / det, y = (dd * ew - de * dw) / det;
  if (x >= 0 && x <= 1 && y >= 0 && y <= 1) out.see(p + x * d, r + y * e);
}

NearPoints nearest_points(int dim, const Corners& a, const Corners& b) {
  NearPoints out;
  const auto on = [dim](const Vector3d& p, const Corners& t) {
    const SimplexPoint n = dim == 3 ? nearest_on_triangle(p, point(t[0]), point(t[1]), point(t[2]))
                                    : nearest_on_segment(p, point(t[0]), point(t[1]));
    Vector3d x = n.weight[0] * point(t[0]) + n.weight[1] * point(t[1]);
    if (dim == 3) x += n.weight[2] * point(t[2]);
    return x;
  };
  for (int i = 0; i < dim; ++i) {
    out.see(point(a[i]), on(point(a[i]), b));
    out.see(on(point(b[i]), a), point(b[i]));
  }
  if (dim == 3)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        see_edges(point(a[i]), point(a[(i + 1) % 3]), point(b[j]), point(b[(j + 1) % 3]), out);
  return out;
}

double ulp_of(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity()) - x;
}

/// Fills in what does not depend on the way.
void explain_faces(QueryContext& ctx, PairExplanation& out) {
  const int dim = ctx[Side::a].rep().dim();
  Corners a{}, b{};
  ctx[Side::a].world.corners(out.pair.a, a.data());
  ctx[Side::b].world.corners(out.pair.b, b.data());
  out.meet = test_simplices(ctx, out.pair.a, out.pair.b);
  out.sides = {sides_of(dim, a, b), sides_of(dim, b, a)};
  if (out.meet != exact::Meet::disjoint)
    out.contact = dim == 3 ? exact::contact_of_triangles(a.data(), b.data())
                           : exact::contact_of_segments(a.data(), b.data());
  const NearPoints near = nearest_points(dim, a, b);
  out.nearest = {near.a, near.b};
  out.distance = out.meet == exact::Meet::disjoint ? std::sqrt(near.distance_sq) : 0;
  double most = 0;
  for (const Corners& corners : {a, b})
    for (int i = 0; i < dim; ++i) most = std::max(most, point(corners[i]).cwiseAbs().maxCoeff());
  out.ulp = ulp_of(most);
  for (const Side side : {Side::a, Side::b}) {
    const LrbRep& rep = ctx[side].rep();
    std::vector<RegionId>& regions = out.hidden_by[static_cast<int>(side)];
    const SimplexId s = side == Side::a ? out.pair.a : out.pair.b;
    for (CellId c = rep.outer_cell(rep.face_of_simplex(s)); is_region(c); c = rep.parent(c.as_region()))
      regions.push_back(c.as_region());
    std::reverse(regions.begin(), regions.end());
  }
}

void check_simplex(const LrbRep& rep, SimplexId s, const char* whose) {
  if (s < rep.real_simplex_count()) return;
  throw InputError(std::string("no simplex ") + std::to_string(s) + " of " + whose + ": there are " +
                   std::to_string(rep.real_simplex_count()) + ", numbered from 0");
}

void begin(QueryContext& ctx, const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  check_query(a, pose_a, b, pose_b);
  ctx[Side::a].begin(a, pose_a, WrapperMode::regularised);
  ctx[Side::b].begin(b, pose_b, WrapperMode::regularised);
}

/// The nearest pairs of those that were compared.
class NearestPairs {
 public:
  explicit NearestPairs(QueryContext& ctx) : ctx_(ctx) {}

  void see(const SimplexPair& pair) {
    Corners a{}, b{};
    ctx_[Side::a].world.corners(pair.a, a.data());
    ctx_[Side::b].world.corners(pair.b, b.data());
    found_.push_back({nearest_points(ctx_[Side::a].rep().dim(), a, b).distance_sq, pair});
    std::sort(found_.begin(), found_.end(), [](const Found& x, const Found& y) {
      return x.distance_sq != y.distance_sq ? x.distance_sq < y.distance_sq : x.pair < y.pair;
    });
    if (found_.size() > WalkExplanation::kMostNear) found_.pop_back();
  }

  std::vector<SimplexPair> take() const {
    std::vector<SimplexPair> out;
    for (const Found& f : found_) out.push_back(f.pair);
    return out;
  }

 private:
  struct Found {
    double distance_sq;
    SimplexPair pair;
  };
  QueryContext& ctx_;
  std::vector<Found> found_;
};

}  // namespace

PairExplanation explain_pair(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                             const SimplexPair& pair) {
  check_simplex(a, pair.a, "A");
  check_simplex(b, pair.b, "B");
  QueryContext ctx;
  begin(ctx, a, pose_a, b, pose_b);
  PairExplanation out;
  out.pair = pair;
  Way(ctx, out).follow();
  explain_faces(ctx, out);
  return out;
}

WalkExplanation explain_walk(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  QueryContext ctx;
  NullProbe probe;
  WalkExplanation out;
  CollideRequest request;
  request.separation = true;
  out.result = collide(a, pose_a, b, pose_b, request, ctx, probe);
  begin(ctx, a, pose_a, b, pose_b);
  if (a.tree().empty() || b.tree().empty()) return out;
  compare_boxes(box_of(a.tree(), 0, kWhole, pose_a), box_of(b.tree(), 0, kWhole, pose_b), out.roots);
  Stepper stepper(ctx);
  NearestPairs nearest(ctx);
  std::vector<NodePair> now = {{0, 0}}, then;
  for (; !now.empty(); now.swap(then)) {
    then.clear();
    WalkDepth depth;
    for (const NodePair& pair : now) {
      const Stepper::Outcome outcome = stepper.step(pair);
      ++depth.node_pairs;
      depth.ended += outcome.children.empty() && outcome.face_pairs == 0;
      out.leaf_pairs += stepper.is_leaf(Side::a, pair.a) && stepper.is_leaf(Side::b, pair.b);
      out.face_pairs += outcome.face_pairs;
      out.left += outcome.candidates.size();
      for (const Candidate& c : outcome.candidates) {
        out.certain += c.certainty == Certainty::cross || c.certainty == Certainty::disjoint;
        if (out.result.pairs.empty()) nearest.see({c.a, c.b});
      }
      then.insert(then.end(), outcome.children.begin(), outcome.children.end());
    }
    out.depths.push_back(depth);
  }
  out.near = nearest.take();
  return out;
}

}  // namespace lrb

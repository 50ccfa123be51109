/// Explains the complete query: how it decides about two faces, and how it proceeds as a whole. Both parts
/// run the query's kernel on one pair of nodes at a time.
///
/// explain_pair():
/// 1. Follow the paths from both roots to the leaves of the faces; stop where boxes separate nodes.
/// 2. At the leaves, report which test decides: boxes, planes, floats, or the exact test.
/// 3. Add the facts that do not depend on the traversal: signs, contact, closest points, regions.
///
/// explain_walk():
/// 1. Answer the query.
/// 2. Traverse the trees breadth first; count the work at each depth, and find the rejected boxes and the
///    faces that come closest.
/// 3. For separate bodies, try the directions of box axes and of closest points for a separating plane.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "engine/collide/explain_parts.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

using Eigen::Vector3d;

/// Adds the closest points of the lines through two segments if they are on the segments. (Otherwise the
/// closest points of the segments include an end of one.)
void see_edges(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s, NearPoints& out) {
  // Closest points of two lines (Ericson 2005, section 5.1.8).
  const Vector3d d = q - p, e = s - r, w = p - r;
  const double dd = d.dot(d), ee = e.dot(e), de = d.dot(e), dw = d.dot(w), ew = e.dot(w);
  const double det = dd * ee - de * de;
  // Parallel lines: a corner is among the closest points.
  if (!(det > 0)) return;
  const double x = (de * ew - ee * dw) / det, y = (dd * ew - de * dw) / det;
  if (x >= 0 && x <= 1 && y >= 0 && y <= 1) out.add(p + x * d, r + y * e);
}

}  // namespace

NearPoints nearest_points(int dim, const Corners& a, const Corners& b) {
  NearPoints out;
  const auto on = [dim](const Vector3d& p, const Corners& t) {
    const SimplexPoint n = dim == 3 ? nearest_on_triangle(p, point(t[0]), point(t[1]), point(t[2]))
                                    : nearest_on_segment(p, point(t[0]), point(t[1]));
    Vector3d x = n.weight[0] * point(t[0]) + n.weight[1] * point(t[1]);
    if (dim == 3) x += n.weight[2] * point(t[2]);
    return x;
  };
  // Closest points of disjoint simplices include a corner, or are on an edge of each.
  for (int i = 0; i < dim; ++i) {
    out.add(point(a[i]), on(point(a[i]), b));
    out.add(on(point(b[i]), a), point(b[i]));
  }
  if (dim == 3)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        see_edges(point(a[i]), point(a[(i + 1) % 3]), point(b[j]), point(b[(j + 1) % 3]), out);
  return out;
}

WorldBox box_of(const ObbTree& tree, std::uint32_t node, int child, const Pose& pose) {
  const FloatMode float_mode;
  const TreeNode& n = tree.nodes()[node];
  Vector3d local, half;
  Eigen::Matrix3d frame;
  for (int i = 0; i < 3; ++i) {
    const double low = child == kWhole ? 0 : n.lo[i][child],
                 high = child == kWhole ? kQuantizedMost : n.hi[i][child];
    // Decode the quantized box in the node's frame.
    local[i] = n.base[i] + n.scale[i] * (low + high) / 2;
    half[i] = n.scale[i] * (high - low) / 2;
    for (int j = 0; j < 3; ++j) frame(i, j) = n.frame[i][j];
  }
  WorldBox out;
  const Vector3d origin(n.origin[0], n.origin[1], n.origin[2]);
  out.centre = pose.apply((origin + frame.transpose() * local) * tree.unit());
  // Normals are transformed by the inverse transpose, for poses that scale or shear.
  const double volume = pose.r.determinant();
  const Eigen::Matrix3d normals = volume != 0 ? Eigen::Matrix3d(pose.r.inverse().transpose()) : pose.r;
  for (int i = 0; i < 3; ++i) {
    out.half[i] = pose.r * (frame.row(i).transpose() * (half[i] * tree.unit()));
    out.across[i] = (normals * frame.row(i).transpose()).normalized();
  }
  return out;
}

void compare_boxes(const WorldBox& a, const WorldBox& b, BoxPair& out, int dim) {
  const FloatMode float_mode;
  out.gap = -std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 6; ++axis) {
    // Separating axis test along the six side normals: centre distance minus both half widths.
    const Vector3d& n = axis < 3 ? a.across[axis] : b.across[axis - 3];
    if (dim == 2 && std::abs(n.z()) > 0.5) continue;  // across the plane
    double gap = std::abs(n.dot(a.centre - b.centre));
    for (int i = 0; i < 3; ++i) gap -= std::abs(n.dot(a.half[i])) + std::abs(n.dot(b.half[i]));
    if (gap > out.gap) out.gap = gap, out.axis = static_cast<BoxAxis>(axis);
  }
}

/// The leaf and the index of each simplex in a tree.
struct Places {
  std::vector<std::uint32_t> parent;  ///< (nodes) the node above
  std::vector<std::uint32_t> leaf;    ///< (simplices) the leaf that contains it
  std::vector<std::uint8_t> place;    ///< (simplices) its index in that leaf

  Places(const ObbTree& tree, std::uint32_t simplices)
      : parent(tree.nodes().size(), 0), leaf(simplices, 0), place(simplices, 0) {
    const std::vector<TreeNode>& all = tree.nodes();
    for (std::uint32_t n = 0; n < all.size(); ++n)
      for (std::uint32_t k = 0; k < all[n].count; ++k) {
        // The children of an inner node are contiguous; a leaf refers to a block of simplices.
        if (all[n].is_leaf == 0) {
          parent[all[n].first + k] = n;
          continue;
        }
        const SimplexId s = tree.blocks()[all[n].first].simplex[k];
        leaf[s] = n;
        place[s] = static_cast<std::uint8_t>(k);
      }
  }
};

namespace {

/// The path to a simplex in a tree.
struct Path {
  std::vector<std::uint32_t> nodes;  ///< from the root to the leaf
  std::vector<int> child;            ///< (|nodes|) which child of its parent; kWhole: the root
  int place;                         ///< index of the simplex in its leaf

  Path(const ObbTree& tree, const Places& places, SimplexId s) : place(places.place[s]) {
    // Climb from the leaf to the root, then reverse.
    for (std::uint32_t n = places.leaf[s];; n = places.parent[n]) {
      nodes.push_back(n);
      child.push_back(n == 0 ? kWhole : static_cast<int>(n - tree.nodes()[places.parent[n]].first));
      if (n == 0) break;
    }
    std::reverse(nodes.begin(), nodes.end());
    std::reverse(child.begin(), child.end());
  }
};

/// Follows the paths from the roots to two simplices.
class Way {
 public:
  Way(QueryContext& ctx, Stepper& stepper, const std::array<Places, 2>& places, PairExplanation& out)
      : ctx_(ctx),
        out_(out),
        stepper_(stepper),
        path_{Path(tree(Side::a), places[0], out.pair.a), Path(tree(Side::b), places[1], out.pair.b)} {}

  void follow() {
    // The roots have no parents: add their own boxes.
    add_nodes({kWhole, kWhole});
    for (;;) {
      const std::array<std::uint32_t, 2> current = {node(0), node(1)};
      // Run the query's kernel on this pair of nodes.
      const Stepper::Outcome outcome = stepper_.step({current[0], current[1]});
      if (outcome.parts_whole) {
        if (at_[0] + at_[1] > 0) add_nodes({kWhole, kWhole});  // the roots' own boxes were added before
        return end_at_nodes();
      }
      // Two leaves: the simplices themselves are next.
      if (stepper_.is_leaf(Side::a, current[0]) && stepper_.is_leaf(Side::b, current[1]))
        return compare_faces(outcome);
      // Descend in the same tree or trees as the query.
      const std::array<bool, 2> moves = moves_to(outcome);
      for (int s = 0; s < 2; ++s) at_[s] += moves[s];
      add_nodes({moves[0] ? path_[0].child[at_[0]] : kWhole, moves[1] ? path_[1].child[at_[1]] : kWhole});
      // The next pair on the path was rejected: its boxes decide.
      if (!goes_on_) return end_at_nodes();
    }
  }

 private:
  void end_at_nodes() {
    out_.decided_by = out_.nodes.back().gap > 0 ? DecidedBy::node_boxes : DecidedBy::node_edges;
  }

  const ObbTree& tree(Side side) const { return ctx_[side].tree(); }
  int dim() const { return ctx_[Side::a].rep().dim(); }
  std::uint32_t node(int s) const { return path_[s].nodes[at_[s]]; }
  std::uint32_t next(int s) const {
    return at_[s] + 1 < path_[s].nodes.size() ? path_[s].nodes[at_[s] + 1] : node(s);
  }

  /// Adds the current pair of nodes. `child`: which box of its parent was compared; kWhole: the node's own
  /// box, because only the other node was descended.
  void add_nodes(const std::array<int, 2>& child) {
    BoxPair pair;
    std::array<WorldBox, 2> box;
    for (int s = 0; s < 2; ++s) {
      const Side side = static_cast<Side>(s);
      pair.node[s] = node(s);
      box[s] = box_of(tree(side), child[s] == kWhole ? node(s) : path_[s].nodes[at_[s] - 1], child[s],
                      ctx_[side].world.pose());
    }
    compare_boxes(box[0], box[1], pair, dim());
    out_.nodes.push_back(pair);
  }

  /// Returns which of the two nodes the query descends here. Sets goes_on_ to true if it reaches the next
  /// pair of the path.
  std::array<bool, 2> moves_to(const Stepper::Outcome& outcome) {
    goes_on_ = false;
    // Equal for all pairs of children, which descend the same nodes.
    std::optional<std::array<bool, 2>> kind;
    for (const NodePair& c : outcome.children) {
      // Where a node differs from the current one, its tree was descended.
      kind = {c.a != node(0), c.b != node(1)};
      const bool on_way = c.a == ((*kind)[0] ? next(0) : node(0)) && c.b == ((*kind)[1] ? next(1) : node(1));
      if (on_way) goes_on_ = true;
    }
    if (kind) return *kind;
    // No boxes overlapped, so that the output does not show which were compared. Assume the children of every
    // node that is not a leaf.
    const bool leaf_a = stepper_.is_leaf(Side::a, node(0)), leaf_b = stepper_.is_leaf(Side::b, node(1));
    return {!leaf_a, !leaf_b};
  }

  void compare_faces(const Stepper::Outcome& outcome) {
    out_.reaches_faces = true;
    out_.face_boxes.node = {node(0), node(1)};
    compare_boxes(box_of(tree(Side::a), node(0), path_[0].place, ctx_[Side::a].world.pose()),
                  box_of(tree(Side::b), node(1), path_[1].place, ctx_[Side::b].world.pose()), out_.face_boxes,
                  dim());
    // The kernel returns only simplices that neither boxes nor planes separated.
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
  Stepper& stepper_;
  std::array<Path, 2> path_;
  std::array<std::size_t, 2> at_ = {0, 0};  ///< positions on the paths
  bool goes_on_ = false;
};

PlaneSides sides_of(int dim, const Corners& corners, const Corners& plane) {
  PlaneSides out;
  // Signed distance in plain doubles, for display.
  const Vector3d origin = point(plane[0]), u = point(plane[1]) - origin;
  const Vector3d normal = dim == 3 ? Vector3d(u.cross(point(plane[2]) - origin)) : Vector3d(-u.y(), u.x(), 0);
  const double length = normal.norm();
  for (int i = 0; i < dim; ++i) {
    const auto sign = [&] {
      return dim == 3 ? exact::orient3d(plane[0], plane[1], plane[2], corners[i])
                      : exact::orient2d(plane[0], plane[1], corners[i]);
    };
    // First exactly, then without the exact fallback, to show where rounding gives a wrong sign.
    out.exact[i] = sign();
    const exact::FloatingPredicates floating;
    out.in_double[i] = sign();
    out.distance[i] = length > 0 ? normal.dot(point(corners[i]) - origin) / length : 0;
  }
  return out;
}

double ulp_of(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity()) - x;
}

/// Fills in the facts that do not depend on the traversal.
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
  // Closest points, in doubles. Faces that intersect have distance 0 regardless.
  const NearPoints near = nearest_points(dim, a, b);
  out.nearest = {near.a, near.b};
  out.distance = out.meet == exact::Meet::disjoint ? std::sqrt(near.distance_sq) : 0;
  // One unit in the last place of the largest coordinate: the resolution of the doubles there.
  double most = 0;
  for (const Corners& corners : {a, b})
    for (int i = 0; i < dim; ++i) most = std::max(most, point(corners[i]).cwiseAbs().maxCoeff());
  out.ulp = ulp_of(most);
  for (const Side side : {Side::a, Side::b}) {
    const LrbRep& rep = ctx[side].rep();
    std::vector<RegionId>& regions = out.hidden_by[static_cast<int>(side)];
    const SimplexId s = side == Side::a ? out.pair.a : out.pair.b;
    // Climb from the face outward through its regions, then reverse the list.
    for (CellId c = rep.outer_cell(rep.face_of_simplex(s)); is_region(c); c = rep.parent(c.as_region()))
      regions.push_back(c.as_region());
    std::reverse(regions.begin(), regions.end());
  }
}

void check_simplex(const LrbRep& rep, SimplexId s, const char* whose) {
  if (s < rep.real_simplex_count()) return;
  throw InputError(std::string("simplex of ") + whose + ": expected a number below " +
                   std::to_string(rep.real_simplex_count()) + ", found " + std::to_string(s));
}

}  // namespace

struct PairExplainer::Parts {
  const LrbRep &a, &b;
  std::array<Places, 2> places;
  QueryContext ctx;
  std::optional<Stepper> stepper = {};  ///< of the poses
};

PairExplainer::PairExplainer(const LrbRep& a, const LrbRep& b)
    : parts_(new Parts{
          a, b, {Places(a.tree(), a.real_simplex_count()), Places(b.tree(), b.real_simplex_count())}, {}}) {}
PairExplainer::~PairExplainer() = default;

void PairExplainer::place(const Pose& pose_a, const Pose& pose_b) {
  const FloatMode float_mode;
  begin(parts_->ctx, parts_->a, pose_a, parts_->b, pose_b);
  parts_->stepper.emplace(parts_->ctx);
}

PairExplanation PairExplainer::explain(const SimplexPair& pair) {
  const FloatMode float_mode;
  check_simplex(parts_->a, pair.a, "A");
  check_simplex(parts_->b, pair.b, "B");
  PairExplanation out;
  out.pair = pair;
  Way(parts_->ctx, *parts_->stepper, parts_->places, out).follow();
  explain_faces(parts_->ctx, out);
  return out;
}

PairExplanation explain_pair(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                             const SimplexPair& pair) {
  PairExplainer explainer(a, b);
  explainer.place(pose_a, pose_b);
  return explainer.explain(pair);
}

}  // namespace lrb

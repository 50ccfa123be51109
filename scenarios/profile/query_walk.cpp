#include "scenarios/profile/query_walk.hpp"

#include <cmath>

#include "scenarios/profile/captured_run.hpp"

namespace lrb::profile {
namespace {

/// A pair of nodes, and the step that leads from it to a given pair.
struct PairAbove {
  std::uint32_t a, b;
  NodeStep step;
};

/// Calls visit(above) with the pairs from which two nodes may have been reached, until it returns true.
template <class Visit>
void find_above(const TreeIndex& tree_a, std::uint32_t a, const TreeIndex& tree_b, std::uint32_t b,
                const Visit& visit) {
  const std::uint32_t up_a = tree_a.parent[a], up_b = tree_b.parent[b];
  const PairAbove above[] = {
      {up_a, b, NodeStep::descend_a}, {a, up_b, NodeStep::descend_b}, {up_a, up_b, NodeStep::descend_both}};
  for (const PairAbove& pair : above)
    if (pair.a != kNull && pair.b != kNull && visit(pair)) return;
}

}  // namespace

TreeIndex::TreeIndex(const capture::Tree& tree, std::size_t triangles)
    : parent(tree.size(), kNull),
      depth(tree.size(), kNull),
      leaf(triangles, kNull),
      triangles_below(tree.size(), 0),
      has_children(tree.size(), 0) {
  for (std::uint32_t n = 0; n < tree.size(); ++n) has_children[n] = !tree.is_leaf(n);
  // Breadth first from the root. A node that was reached before keeps its first parent, so that this ends for
  // graphs with cycles.
  from_root.push_back(0);
  depth[0] = 0;
  for (std::size_t i = 0; i < from_root.size(); ++i) {
    const std::uint32_t n = from_root[i];
    for (const std::uint32_t child : tree.children(n)) {
      if (depth[child] != kNull) continue;
      parent[child] = n;
      depth[child] = depth[n] + 1;
      from_root.push_back(child);
    }
    for (const std::uint32_t t : tree.triangles(n)) {
      if (t >= triangles) continue;
      if (leaf[t] == kNull)
        leaf[t] = n;
      else if (tree.splits && leaf[t] != n)
        more_leaves.emplace_back(t, n);
    }
  }
  std::ranges::sort(more_leaves);
  // Sums from the leaves upward.
  for (std::size_t i = from_root.size(); i-- > 0;) {
    const std::uint32_t n = from_root[i];
    triangles_below[n] += static_cast<std::uint32_t>(tree.triangles(n).size());
    if (parent[n] != kNull) triangles_below[parent[n]] += triangles_below[n];
  }
}

std::vector<Visit> visits_of(const TreeIndex& tree_a, const TreeIndex& tree_b,
                             std::span<const capture::Event> events) {
  std::vector<Visit> out(events.size());
  PairMap tests;  // the last test of each pair of nodes
  // Links visit i, of nodes a and b, to its predecessor. All children of a pair are reached by the same step.
  const auto link = [&](std::uint32_t a, std::uint32_t b, std::uint32_t i) {
    find_above(tree_a, a, tree_b, b, [&](const PairAbove& pair) {
      const std::uint32_t* const found = tests.find(pair.a, pair.b);
      if (found == nullptr || !out[*found].lead(pair.step)) return false;
      out[i].parent = *found;
      return true;
    });
  };
  for (std::uint32_t i = 0; i < events.size(); ++i) {
    const capture::Event& e = events[i];
    if (e.kind == capture::EventKind::triangles) {
      const std::uint32_t a = tree_a.leaf[e.a], b = tree_b.leaf[e.b];
      if (a == kNull || b == kNull) continue;
      std::uint32_t last = kNull;  // test of leaves that have the triangles
      tree_a.for_each_leaf(e.a, [&](std::uint32_t x) {
        tree_b.for_each_leaf(e.b, [&](std::uint32_t y) {
          const std::uint32_t* const found = tests.find(x, y);
          if (found != nullptr && (last == kNull || *found > last)) last = *found;
        });
      });
      if (last != kNull)
        out[i].parent = last;
      else
        link(a, b, i);  // an engine without a test of the leaves' volumes
    } else if (e.kind == capture::EventKind::nodes) {
      tests.insert(e.a, e.b, i) = i;
      if (tree_a.is_leaf(e.a) && tree_b.is_leaf(e.b)) out[i].step = NodeStep::leaves;
      link(e.a, e.b, i);
    }
  }
  return out;
}

namespace {

/// The length of a ray's direction in the frame of its pose, whose x axis has that direction.
double ray_unit(const capture::Query& query) {
  const std::array<double, 8>& n = query.probe.numbers;
  return Eigen::Vector3d(n[3], n[4], n[5]).stableNorm() / query.poses[1].r.col(0).norm();
}

}  // namespace

void set_segment(capture::Tree& tree, double begin, double end) {
  const bool is_round = tree.volume == capture::VolumeKind::rss;
  const double length = end - begin;
  tree.volumes.assign(is_round ? 10 : 12, 0);
  tree.volumes[0] = is_round ? begin : begin + length / 2;
  tree.volumes[3] = is_round ? length : length / 2;
}

ProbeBody probe_body(const capture::Query& query, const capture::Tree& tree, double reach) {
  ProbeBody out;
  const bool is_round = tree.volume == capture::VolumeKind::sphere || tree.volume == capture::VolumeKind::rss;
  const std::array<double, 8>& n = query.probe.numbers;
  const Pose& pose = query.poses[1];
  out.mesh.name = name_of(query.probe.shape);
  out.tree.first_child = {0, 0};
  out.tree.first_triangle = {0, 1};
  out.tree.triangle = {0};
  if (query.probe.shape == capture::ProbeShape::box) {
    for (unsigned i = 0; i < 8; ++i)
      out.mesh.vertices.emplace_back(n[i & 1 ? 3 : 0], n[i & 2 ? 4 : 1], n[i & 4 ? 5 : 2]);
    for (const auto& [a, b, c, d] : std::to_array<std::array<std::uint32_t, 4>>(
             {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})) {
      out.mesh.triangles.push_back({a, b, c});
      out.mesh.triangles.push_back({a, c, d});
    }
    out.tree.volumes.assign(n.begin(), n.begin() + 6);
    return out;
  }
  double begin = 0, end = 0;
  if (query.probe.shape == capture::ProbeShape::ray) {
    const double unit = ray_unit(query);
    const double rounding = 1.001;  // also for poses that are rigid within 1e-6
    const double beyond = rounding * ((pose.t - query.poses[0].t).stableNorm() + reach);
    // The mesh is between -beyond and beyond: the ray is cut at a power of two outside of it.
    const double cut = beyond > 0 ? std::exp2(std::min(std::ceil(std::log2(beyond)), 1023.0)) : 0;
    begin = std::clamp(n[6] * unit, -cut, cut), end = std::clamp(n[7] * unit, -cut, cut);
  }
  const double length = end - begin;
  out.mesh.vertices = {{begin, 0, 0}, {end, 0, 0}, {begin + length / 2, 0, 0}};
  out.mesh.triangles = {{0, 1, 2}};
  // A volume of the same kind as those of A if these are rounded, for the test of both.
  out.tree.volume = is_round ? capture::VolumeKind::rss : capture::VolumeKind::obb;
  set_segment(out.tree, begin, end);
  return out;
}

double reach_of(const capture::Mesh& mesh) {
  double out = 0;
  for (const Eigen::Vector3d& x : mesh.vertices) out = std::max(out, x.stableNorm());
  return out;
}

void fill_box(const capture::Query& query, const LrbRep& body, const capture::Mesh& mesh,
              std::vector<SimplexPair>& pairs) {
  if (query.probe.shape != capture::ProbeShape::box) return;
  for (SimplexPair& pair : pairs) pair.b = SimplexId(0);
  const Eigen::Map<const Eigen::Vector3d> least(query.probe.numbers.data()),
      greatest(query.probe.numbers.data() + 3);
  const ObbTree& tree = body.tree();
  for (std::vector<std::uint32_t> open(1, 0); !open.empty();) {
    const TreeNode& node = tree.nodes()[open.back()];
    open.pop_back();
    // The ball around all triangles beneath; rounding errors must not lose any.
    constexpr double kSlack = 1.001, kRounding = 1e-12;
    const Eigen::Vector3d centre =
        query.poses[0].apply(tree.unit() * Eigen::Map<const Eigen::Vector3d>(node.origin));
    const double outside = (least - centre).cwiseMax(centre - greatest).cwiseMax(0).norm();
    if (outside > kSlack * tree.unit() * node.radius + kRounding * (centre.norm() + query.poses[0].t.norm()))
      continue;
    for (std::uint32_t k = 0; k < node.count && !node.is_leaf; ++k) open.push_back(node.first + k);
    for (std::uint32_t k = 0; k < node.count && node.is_leaf; ++k) {
      // The corners of a triangle that does not meet the surface are all inside or all outside: the one
      // farthest from the surface decides.
      const SimplexId t = tree.blocks()[node.first].simplex[k];
      double margin = 0;
      for (const Eigen::Vector3d& corner : corners_of(mesh, t)) {
        const Eigen::Vector3d x = query.poses[0].apply(corner);
        const double inside = std::min((x - least).minCoeff(), (greatest - x).minCoeff());
        if (std::abs(inside) > std::abs(margin)) margin = inside;
      }
      if (margin > 0) pairs.push_back({t, SimplexId(0)});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

std::array<double, 2> hit_of(const capture::Query& query, const capture::Mesh& mesh, std::uint32_t triangle,
                             double error) {
  const Eigen::Vector3d along = query.poses[1].r.col(0);
  std::array<Eigen::Vector3d, 3> corners = corners_of(mesh, triangle);
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (Eigen::Vector3d& x : corners) {
    x = query.poses[0].apply(x) - query.poses[1].t;
    const double at = x.dot(along) / along.squaredNorm();
    least = std::min(least, at - error), greatest = std::max(greatest, at + error);
  }
  const Eigen::Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0], product = u.cross(v);
  const Eigen::Vector3d normal = product.stableNormalized();
  const double longest = std::max({u.norm(), v.norm(), (u - v).norm()}), slope = normal.dot(along);
  // Corners that are wrong by `error` turn the normal: u and v are wrong by twice as much, and normalising
  // doubles the relative error of their product. The plane at the hit, at most `longest` from a corner, moves
  // with it.
  const double turn = error > 0 ? 8 * error * longest / product.stableNorm() : 0;
  least = std::max(least, query.probe.numbers[6] * ray_unit(query));
  if (!(std::abs(slope) > turn)) return {least, greatest};  // possibly in one plane
  const double at = normal.dot(corners[0]) / slope, by = (error + turn * longest) / (std::abs(slope) - turn);
  return {std::max(least, at - by), std::min(greatest, at + by)};
}

CapturedBodies::CapturedBodies(const capture::Capture& capture) : capture_(&capture) {
  update();
}

void CapturedBodies::update() {
  // Bodies do not refer to the capture; indices and volumes refer to its trees.
  if (!bodies_.empty()) bodies_.back().reset();
  bodies_.resize(capture_->meshes.size() + 1);
  reach_.resize(capture_->meshes.size(), -1);
  indices_.clear();
  indices_.resize(capture_->trees.size() + 1);
  volumes_.clear();
  volumes_.resize(capture_->trees.size() + 1);
  probe_ = {};
}

const LrbRep* CapturedBodies::body(std::uint32_t mesh) {
  const capture::Mesh& m = this->mesh(mesh);
  if (m.triangles.empty()) return nullptr;
  std::unique_ptr<bodies::LoadedBody>& out = slot(bodies_, mesh);
  if (!out) out = std::make_unique<bodies::LoadedBody>(captured_body(m));
  return &out->rep;
}

const TreeIndex& CapturedBodies::index(std::uint32_t tree) {
  std::unique_ptr<TreeIndex>& out = slot(indices_, tree);
  if (!out) out = std::make_unique<TreeIndex>(this->tree(tree), mesh_of(tree).triangles.size());
  return *out;
}

const Volumes& CapturedBodies::volumes(std::uint32_t tree) {
  std::unique_ptr<Volumes>& out = slot(volumes_, tree);
  if (!out) out = std::make_unique<Volumes>(this->tree(tree));
  return *out;
}

std::optional<std::array<std::uint32_t, 2>> CapturedBodies::trees_of(const capture::Query& query) {
  std::array<std::uint32_t, 2> out = query.trees;
  if (query.probe.shape != capture::ProbeShape::none) {
    double& reach = reach_[tree(out[0]).mesh];
    if (reach < 0) reach = reach_of(mesh_of(out[0]));
    ProbeBody probe = probe_body(query, tree(out[0]), reach);
    out[1] = probe.tree.mesh = kProbe;
    if (probe.mesh.vertices == probe_.mesh.vertices && probe.tree.volume == probe_.tree.volume) return out;
    probe_ = std::move(probe);
    bodies_.back().reset(), indices_.back().reset(), volumes_.back().reset();
    return out;
  }
  if (query.kind == capture::QueryKind::self && out[1] == kNull) out[1] = out[0];
  if (out[0] == kNull || out[1] == kNull || query.kind == capture::QueryKind::shape) return std::nullopt;
  return out;
}

QueryWalk::QueryWalk(CapturedBodies& bodies, const capture::Query& query,
                     const std::array<std::uint32_t, 2>& trees)
    : query_(&query), trees_(trees), index_{&bodies.index(trees[0]), &bodies.index(trees[1])} {
  visits_ = visits_of(*index_[0], *index_[1], query.events);
  for (std::uint32_t i = 0; i < query.events.size(); ++i) {
    const capture::Event& e = query.events[i];
    if (e.kind != capture::EventKind::nodes) continue;
    ++visit_count_;
    wide_ = wide_ || e.tests > 1;
    if (first_.insert(e.a, e.b, i) == i) by_a_.push_back(i);
    if (depth_of(i) != kNone) order_.push_back(i);
  }
  std::ranges::sort(by_a_, {}, [&](std::uint32_t i) { return query.events[i].a; });
  visits_roots_ = visit_of(0, 0) != kNone;
  // If a pair was visited repeatedly, its first visit is the parent.
  parent_.assign(visits_.size(), kNone);
  for (std::size_t i = 0; i < visits_.size(); ++i)
    if (visits_[i].parent != Visit::kNone) parent_[i] = first_visit(visits_[i].parent);
  link_strays();
  // A parent's nodes are less deep by at least one level in total.
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::uint32_t x, std::uint32_t y) { return depth_of(x) < depth_of(y); });
}

/// Links visits whose parents come later in the list of events, as events of other threads may, and those of
/// engines that skip levels.
void QueryWalk::link_strays() {
  for (const std::uint32_t i : order_) {
    if (parent_[i] != kNone || visit_of(0, 0) == i) continue;
    const capture::Event& e = query_->events[i];
    find_above(*index_[0], e.a, *index_[1], e.b, [&](const PairAbove& pair) {
      const std::uint32_t from = visit_of(pair.a, pair.b);
      if (from == kNone || !visits_[from].lead(pair.step)) return false;
      parent_[i] = from;
      return true;
    });
    if (parent_[i] == kNone) parent_[i] = closest_above(e.a, e.b);
  }
}

template <class Accept>
std::uint32_t QueryWalk::deepest_from(std::uint32_t a, std::uint32_t b, const Accept& accept) const {
  std::uint32_t best = kNone, best_depth = 0;
  const std::uint32_t depth_b = index_[1]->depth[b];
  std::vector<std::uint32_t> above_b;  // and b itself, from the root downward
  for (std::uint32_t y = b; y != kNull; y = index_[1]->parent[y]) above_b.push_back(y);
  std::ranges::reverse(above_b);
  const auto consider = [&](std::uint32_t visit) {
    if (visit == kNone || !accept(query_->events[visit])) return false;
    const std::uint32_t depth = depth_of(visit);
    if (best == kNone || depth > best_depth) best = visit, best_depth = depth;
    return true;
  };
  for (std::uint32_t x = a; x != kNull; x = index_[0]->parent[x]) {
    if (best != kNone && index_[0]->depth[x] + depth_b <= best_depth) break;  // the rest is less deep
    // The visits of x, or the nodes above b, whichever are fewer: in trees like lists both may be many.
    const auto first = std::partition_point(by_a_.begin(), by_a_.end(),
                                            [&](std::uint32_t i) { return query_->events[i].a < x; });
    const auto last =
        std::partition_point(first, by_a_.end(), [&](std::uint32_t i) { return query_->events[i].a == x; });
    const std::span<const std::uint32_t> visits(by_a_.data() + (first - by_a_.begin()),
                                                static_cast<std::size_t>(last - first));
    if (visits.size() < above_b.size()) {
      for (const std::uint32_t visit : visits) {
        const std::uint32_t y = query_->events[visit].b, depth_y = index_[1]->depth[y];
        if (depth_y < above_b.size() && above_b[depth_y] == y) consider(visit);
      }
    } else {
      // Pairs with the same x are less deep after the first.
      std::any_of(above_b.rbegin(), above_b.rend(),
                  [&](std::uint32_t y) { return consider(visit_of(x, y)); });
    }
  }
  return best;
}

std::uint32_t QueryWalk::closest_above(std::uint32_t a, std::uint32_t b) const {
  return deepest_from(a, b, [&](const capture::Event& e) { return e.met > 0 && (e.a != a || e.b != b); });
}

bool QueryWalk::is_start(std::size_t event) const {
  const capture::Event& e = query_->events[event];
  const std::uint32_t a = index_[0]->depth[e.a], b = index_[1]->depth[e.b];
  return visits_roots_ ? a == 0 && b == 0 : parent_[event] == kNone && a <= 1 && b <= 1;
}

std::uint32_t QueryWalk::depth_of(std::size_t event) const {
  const capture::Event& e = query_->events[event];
  const std::uint32_t a = index_[0]->depth[e.a], b = index_[1]->depth[e.b];
  return a == kNull || b == kNull ? kNone : a + b;
}

std::uint32_t QueryWalk::deepest_above(const TrianglePair& pair) const {
  const std::uint32_t found = deepest_above(pair.a, pair.b);
  if (query_->kind != capture::QueryKind::self) return found;
  // A query of one tree may visit the pair in either order.
  const std::uint32_t turned = deepest_above(pair.b, pair.a);
  if (found == kNone || turned == kNone) return found == kNone ? turned : found;
  return depth_of(turned) > depth_of(found) ? turned : found;
}

std::uint32_t QueryWalk::deepest_above(std::uint32_t a, std::uint32_t b) const {
  // Of several pairs of leaves (spatial splits), those that were rejected may hold disjoint parts of the
  // triangles.
  std::uint32_t best = kNone;
  const auto rank = [&](std::uint32_t visit) {
    return std::pair(query_->events[visit].met > 0, depth_of(visit));
  };
  index_[0]->for_each_leaf(a, [&](std::uint32_t x) {
    index_[1]->for_each_leaf(b, [&](std::uint32_t y) {
      const std::uint32_t found = deepest_from(x, y, [](const capture::Event&) { return true; });
      if (found != kNone && (best == kNone || rank(found) > rank(best))) best = found;
    });
  });
  return best;
}

}  // namespace lrb::profile

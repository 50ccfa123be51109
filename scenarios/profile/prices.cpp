#include "scenarios/profile/prices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <lrbscope/distance.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::profile {
namespace {

/// The pairs of nodes that a search for the least number may look at, and the levels of both trees together.
/// Beyond them there is no answer.
constexpr std::size_t kMaxPairs = 50'000'000;
constexpr std::uint32_t kMaxLevels = 4000;

class Search {
 public:
  Search(CapturedBodies& bodies, const QueryWalk& walk)
      : walk_(walk),
        trees_{&bodies.tree(walk.trees()[0]), &bodies.tree(walk.trees()[1])},
        volumes_{&bodies.volumes(walk.trees()[0]), &bodies.volumes(walk.trees()[1])} {
    for (const std::uint32_t i : walk.from_root())
      opens_both_ = opens_both_ || walk.step(i) == NodeStep::descend_both;
  }

  bool gave_up() const { return gave_up_; }

  /// Marks the pairs of leaves that a descent with the least number of visits reaches. Call least() before.
  void reach(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t visit = walk_.visit_of(a, b);
    const bool inner_a = has_children(0, a), inner_b = has_children(1, b);
    if (!overlaps(a, b, visit)) return;
    if (!inner_a && !inner_b) {
      reached_.insert(a, b, 1);
      return;
    }
    // The search has left out what cannot become the best: there is a number for all pairs of a best choice.
    const std::uint32_t* const best = least_.find(a, b);
    for (const NodeStep step : {NodeStep::descend_a, NodeStep::descend_b, NodeStep::descend_both}) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> next;
      std::uint64_t sum = 1;
      const bool possible = for_each_next(a, b, step, visit, [&](std::uint32_t x, std::uint32_t y) {
        const std::uint32_t* const known = least_.find(x, y);
        sum += known == nullptr ? kMaxPairs : *known;
        next.emplace_back(x, y);
        return true;
      });
      if (!possible || best == nullptr || sum != *best) continue;
      for (const auto& [x, y] : next) reach(x, y);
      return;
    }
  }
  bool is_reached(std::uint32_t a, std::uint32_t b) const { return reached_.find(a, b) != nullptr; }

  /// Returns the least number of visits of a pair and beneath it.
  std::uint32_t least(std::uint32_t a, std::uint32_t b) {
    if (const std::uint32_t* const known = least_.find(a, b)) return *known;
    if (least_.size() >= kMaxPairs) gave_up_ = true;
    if (gave_up_) return 1;
    std::uint32_t best = 1;
    const std::uint32_t visit = walk_.visit_of(a, b);
    const bool inner_a = has_children(0, a), inner_b = has_children(1, b);
    if ((inner_a || inner_b) && overlaps(a, b, visit)) {
      best = std::numeric_limits<std::uint32_t>::max();
      const auto recorded = visit == QueryWalk::kNone ? std::nullopt : walk_.step(visit);
      // The recorded choice first, because it limits the others.
      if (recorded) try_step(a, b, *recorded, visit, best);
      for (const NodeStep step : {NodeStep::descend_a, NodeStep::descend_b, NodeStep::descend_both})
        if (step != recorded) try_step(a, b, step, visit, best);
    }
    return least_.insert(a, b, best);
  }

 private:
  bool has_children(std::size_t side, std::uint32_t node) const { return !walk_.index(side).is_leaf(node); }

  bool overlaps(std::uint32_t a, std::uint32_t b, std::uint32_t visit) const {
    if (visit != QueryWalk::kNone && walk_.query().events[visit].met == 0) return false;
    return overlap(*volumes_[0], a, walk_.query().poses[0], *volumes_[1], b, walk_.query().poses[1]);
  }

  /// Calls visit(x, y) for each pair that follows a choice, until it returns false. `recorded`: the visit, if
  /// the engine chose the same. Returns false if the choice is not possible.
  template <class Visit>
  bool for_each_next(std::uint32_t a, std::uint32_t b, NodeStep step, std::uint32_t recorded,
                     const Visit& visit) {
    const bool opens_a = step != NodeStep::descend_b, opens_b = step != NodeStep::descend_a;
    if ((opens_a && !has_children(0, a)) || (opens_b && !has_children(1, b))) return false;
    if (opens_a && opens_b && !opens_both_) return false;
    if (recorded != QueryWalk::kNone && walk_.step(recorded) != step) recorded = QueryWalk::kNone;
    const std::uint32_t only_a[] = {a}, only_b[] = {b};
    const std::span<const std::uint32_t> all_a = opens_a ? trees_[0]->children(a) : std::span(only_a);
    const std::span<const std::uint32_t> all_b = opens_b ? trees_[1]->children(b) : std::span(only_b);
    for (const std::uint32_t x : all_a) {
      if (opens_a && walk_.index(0).parent[x] != a) continue;  // also another node's child
      for (const std::uint32_t y : all_b) {
        if (opens_b && walk_.index(1).parent[y] != b) continue;
        if (walk_.wide() && !is_visited(x, y, recorded)) continue;
        if (!visit(x, y)) return true;
      }
    }
    return true;
  }

  /// Lowers `best` to the number for a choice.
  void try_step(std::uint32_t a, std::uint32_t b, NodeStep step, std::uint32_t recorded,
                std::uint32_t& best) {
    std::uint32_t sum = 1;
    const bool possible = for_each_next(a, b, step, recorded, [&](std::uint32_t x, std::uint32_t y) {
      if (sum >= best || gave_up_) return false;
      sum += least(x, y);
      return true;
    });
    if (possible) best = std::min(best, sum);
  }

  /// Wide nodes: returns true if the volumes of two children overlap.
  bool is_visited(std::uint32_t x, std::uint32_t y, std::uint32_t recorded) const {
    if (recorded != QueryWalk::kNone && walk_.visit_of(x, y) == QueryWalk::kNone) return false;
    return overlaps(x, y, QueryWalk::kNone);
  }

  const QueryWalk& walk_;
  std::array<const capture::Tree*, 2> trees_;
  std::array<const Volumes*, 2> volumes_;
  PairMap least_, reached_;
  bool opens_both_ = false, gave_up_ = false;
};

std::uint32_t levels_of(const TreeIndex& index) {
  return index.depth[index.from_root.back()];  // breadth first: the deepest node is last
}

}  // namespace

std::optional<std::uint64_t> least_visits(CapturedBodies& bodies, const QueryWalk& walk,
                                          std::uint64_t* saved) {
  // The search recurses once for each level.
  if (levels_of(walk.index(0)) + levels_of(walk.index(1)) > kMaxLevels) return std::nullopt;
  Search search(bodies, walk);
  std::uint64_t least = 0;
  for (const std::uint32_t i : walk.from_root())
    if (walk.is_start(i) && walk.first_visit(i) == i)
      least += search.least(walk.query().events[i].a, walk.query().events[i].b);
  if (search.gave_up()) return std::nullopt;
  if (saved == nullptr) return least;
  const std::vector<capture::Event>& events = walk.query().events;
  for (const std::uint32_t i : walk.from_root())
    if (walk.is_start(i) && walk.first_visit(i) == i) search.reach(events[i].a, events[i].b);
  for (const capture::Event& e : events) {
    if (e.kind != capture::EventKind::triangles) continue;
    bool is_reached = false;
    walk.index(0).for_each_leaf(e.a, [&](std::uint32_t a) {
      walk.index(1).for_each_leaf(
          e.b, [&](std::uint32_t b) { is_reached = is_reached || search.is_reached(a, b); });
    });
    *saved += !is_reached;
  }
  return least;
}

namespace {

using capture::Event;
using capture::EventKind;
using capture::QueryKind;

/// Counts the tests, whatever they are good for.
void count_tests(const capture::Query& query, Prices& out) {
  for (const Event& e : query.events) {
    if (e.kind == EventKind::nodes) ++out.visits, out.volume_tests += e.tests;
    if (e.kind == EventKind::triangles) ++out.triangle_tests;
  }
}

bool is_exact(const QueryWalk& walk, std::span<const TrianglePair> exact, const Event& e) {
  TrianglePair pair{e.a, e.b};
  if (walk.query().kind == QueryKind::self && pair.a > pair.b) std::swap(pair.a, pair.b);
  return std::binary_search(exact.begin(), exact.end(), pair);
}

/// Returns the intersecting pairs that a query of kind any found; none for other kinds.
std::vector<TrianglePair> found_early(const QueryWalk& walk, std::span<const TrianglePair> exact) {
  std::vector<TrianglePair> found;
  if (walk.query().kind == QueryKind::any)
    for (const Event& e : walk.query().events)
      if (e.kind == EventKind::triangles && e.met > 0 && is_exact(walk, exact, e))
        found.push_back({e.a, e.b});
  return found;
}

/// Returns true if a query descended until no pair was left, and its events are complete.
bool is_exhaustive(const capture::Query& query) {
  return query.complete() && (query.kind == QueryKind::all_pairs ||
                              (query.kind == QueryKind::any && query.verdict == capture::Verdict::separate));
}

/// Returns true if two triangles share their pair of leaves with others, and their own volumes were not
/// compared before, as those of the children of two wide leaves are.
bool is_crowded(const QueryWalk& walk, std::size_t event) {
  const Event& e = walk.query().events[event];
  std::uint32_t a = walk.index(0).leaf[e.a], b = walk.index(1).leaf[e.b];
  const std::uint32_t visit = walk.parent(event);
  if (a == kNull || b == kNull) return false;
  if (visit != QueryWalk::kNone) {
    const Event& test = walk.query().events[visit];
    if (walk.index(0).is_leaf(test.a) && walk.index(1).is_leaf(test.b)) a = test.a, b = test.b;
    if (test.tests > 1 && test.a == a && test.b == b) return false;
  }
  return std::uint64_t{walk.index(0).triangles_below[a]} * walk.index(1).triangles_below[b] > 1;
}

}  // namespace

Prices& Prices::operator+=(const Prices& other) {
  for (const auto& [name, count] : kPriceCounts) this->*count += other.*count;
  for (std::size_t i = 0; i < saved_by_leaves.size(); ++i) saved_by_leaves[i] += other.saved_by_leaves[i];
  return *this;
}

Prices PriceBook::add(const capture::Query& query, const QueryWalk* walk, std::span<const TrianglePair> exact,
                      bool split) {
  Prices out;
  count_tests(query, out);
  if (walk == nullptr || query.kind == QueryKind::first_contact) {
    out.unattributed = out.visits;
    return out;
  }
  if (query.kind == QueryKind::distance) {
    price_distance(*walk, exact, split, out);
    return out;
  }
  const std::vector<TrianglePair> found = found_early(*walk, exact);
  const bool one_is_enough = !found.empty();
  price_visits(*walk, one_is_enough ? std::span<const TrianglePair>(found) : exact, one_is_enough,
               std::nullopt, out);
  price_leaves(*walk, out);
  for (std::size_t i = 0; i < query.events.size(); ++i) {
    const Event& e = query.events[i];
    if (e.kind != EventKind::triangles || is_exact(*walk, exact, e)) continue;
    ++out.triangle_tests_for_nothing;
    out.crowded_tests += is_crowded(*walk, i);
  }
  const std::uint64_t wasted = std::exchange(out.unsplit, 0);
  if (one_is_enough) {
    out.order = wasted;
    out.triangles_by_order = out.triangle_tests_for_nothing;
  } else if (wasted > 0 && split && is_exhaustive(query)) {
    if (const auto least = least_visits(bodies_, *walk, &out.triangles_by_order)) {
      const std::uint64_t certain = out.needed + out.proof;
      out.volumes = std::min(*least > certain ? *least - certain : 0, wasted);
      out.order = wasted - out.volumes;
    } else {
      out.unsplit = wasted;
    }
  } else {
    out.unsplit = wasted;
  }
  return out;
}

void PriceBook::price_distance(const QueryWalk& walk, std::span<const TrianglePair> exact, bool split,
                               Prices& out) {
  const capture::Query& query = walk.query();
  const LrbRep* const a = bodies_.body(bodies_.tree(walk.trees()[0]).mesh);
  const LrbRep* const b = bodies_.body(bodies_.tree(walk.trees()[1]).mesh);
  if (a == nullptr || b == nullptr) {
    out.unattributed = out.visits;
    return;
  }
  constexpr double kRounding = 1e-9;  // hits this close to the first one are as close
  // Step 1: the exact distance, and all pairs of triangles at that distance.
  const bool of_ray = is_first_hit(query);
  std::vector<TrianglePair> closest(exact.begin(), exact.end());
  double distance = 0;
  if (of_ray && !exact.empty()) {
    const capture::Mesh& mesh = bodies_.mesh_of(walk.trees()[0]);
    distance = std::numeric_limits<double>::infinity();
    for (const TrianglePair& pair : exact) distance = std::min(distance, hit_of(query, mesh, pair.a)[1]);
    std::erase_if(closest, [&](const TrianglePair& pair) {
      return hit_of(query, mesh, pair.a)[0] > distance + kRounding * std::abs(distance);
    });
  } else if (closest.empty() && !of_ray) {
    DistanceRequest request;
    request.relation = false;
    NearPairsRequest near;
    near.within = distance =
        lrb::distance(*a, query.poses[0], *b, query.poses[1], request, workspace_).value().upper;
    for (const NearPair& pair :
         near_pairs(*a, query.poses[0], *b, query.poses[1], near, workspace_).value().pairs)
      closest.push_back({pair.a.value(), query.probe.shape == capture::ProbeShape::box ? 0 : pair.b.value()});
  }
  // Step 2: the one that the engine tested first, or if none was, the first in a visited pair of leaves.
  std::optional<TrianglePair> goal;
  for (std::size_t i = 0; i < query.events.size(); ++i) {
    const Event& e = query.events[i];
    if (e.kind != EventKind::triangles) continue;
    const bool is_closest = is_exact(walk, closest, e);
    out.triangle_tests_for_nothing += !is_closest;
    out.crowded_tests += !is_closest && is_crowded(walk, i);
    if (is_closest && !goal) goal = {e.a, e.b};
  }
  for (std::size_t i = 0; i < closest.size() && !goal; ++i)
    if (walk.deepest_above(closest[i]) != QueryWalk::kNone) goal = closest[i];
  // Step 3: the visits.
  if (!goal) {
    price_visits(walk, {}, false, std::nullopt, out);
    if (of_ray) out.volumes = std::exchange(out.unsplit, 0);  // of one tree: no order saves them
    return;
  }
  const bool touching = distance == 0 && !of_ray, with_distance = split && !touching;
  price_visits(walk, {&*goal, 1}, touching, with_distance ? std::optional(distance) : std::nullopt, out);
  if (touching)
    out.order = std::exchange(out.unsplit, 0), out.triangles_by_order = out.triangle_tests_for_nothing;
  if (with_distance) out.volumes = std::exchange(out.unsplit, 0);
}

void PriceBook::price_visits(const QueryWalk& walk, std::span<const TrianglePair> goals, bool one_is_enough,
                             std::optional<double> distance, Prices& out) {
  constexpr std::uint32_t kNone = QueryWalk::kNone;
  constexpr double kRounding = 1e-9;  // volumes this close to the distance count as no closer
  const std::vector<Event>& events = walk.query().events;
  // Needed: the visits above a pair of triangles, from the deepest upward until one that is marked already.
  std::vector<char> needed(events.size(), 0);
  for (const TrianglePair& pair : goals)
    for (std::uint32_t i = walk.deepest_above(pair); i != kNone && !needed[i]; i = walk.parent(i))
      needed[i] = 1;
  std::vector<char> attached(events.size(), 0);
  // With a distance: at this visit, or above it, the volumes are no closer. Without: they are disjoint, and
  // the engine went on beneath. Unused if one pair is enough: then all waste is of order.
  std::vector<char> ends(events.size(), 0);
  const Volumes &of_a = bodies_.volumes(walk.trees()[0]), &of_b = bodies_.volumes(walk.trees()[1]);
  const std::array<Pose, 2>& poses = walk.query().poses;
  // A ray up to its first hit.
  const bool is_cut = distance && is_first_hit(walk.query());
  capture::Tree cut = is_cut ? of_b.tree() : capture::Tree();
  if (is_cut) set_segment(cut, bodies_.mesh_of(walk.trees()[1]).vertices[0].x(), *distance);
  const Volumes up_to_hit(cut);
  std::uint64_t known = 0;
  for (const std::uint32_t i : walk.from_root()) {
    const Event& e = events[i];
    const std::uint32_t up = walk.parent(i);
    attached[i] = up == kNone ? walk.is_start(i) : attached[up];
    if (!attached[i]) continue;
    ++known;
    const std::uint32_t first = walk.first_visit(i);
    const bool repeated = first != i;
    if (needed[i] && !repeated) {
      ++out.needed;
      continue;
    }
    const bool below_needed = up == kNone || needed[up];
    const bool ended_above = !below_needed && ends[up];
    if (distance)
      ends[i] = ended_above ||
                (is_cut ? !overlap(of_a, e.a, poses[0], up_to_hit, e.b, poses[1])
                        : gap(of_a, e.a, poses[0], of_b, e.b, poses[1]) >= *distance * (1 - kRounding));
    else if (!one_is_enough)
      ends[i] =
          ended_above || !((e.met == 0 && !walk.wide()) || overlap(of_a, e.a, poses[0], of_b, e.b, poses[1]));
    if (below_needed && !repeated && !one_is_enough) {
      ++out.proof;
      continue;
    }
    // A visit of wide nodes follows a comparison of their own volumes.
    const bool ended = ended_above || (walk.wide() && ends[i]);
    const bool by_order = distance && (repeated || ended);
    const bool by_test = !distance && !repeated && ended;
    ++(by_order ? out.order : by_test ? out.test : out.unsplit);
    const std::uint32_t nodes[] = {e.a, e.b};
    for (std::size_t side = 0; side < 2; ++side) {
      std::vector<double>& waste = waste_of_nodes_[walk.trees()[side]];
      waste.resize(walk.index(side).parent.size());
      waste[nodes[side]] += 0.5;
    }
  }
  out.unattributed = out.visits - known;
  // Tests of triangles beneath pairs of nodes that are not needed.
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::uint32_t up = walk.parent(i);
    if (events[i].kind != EventKind::triangles || up == kNone || !attached[up]) continue;
    if (needed[up] && walk.first_visit(up) == up) continue;
    ++out.triangles_by_volumes;
    if (ends[up]) ++(distance ? out.triangles_by_order : out.triangles_by_test);
  }
}

/// Estimates what larger leaves would save.
void PriceBook::price_leaves(const QueryWalk& walk, Prices& out) {
  constexpr std::uint32_t kNone = QueryWalk::kNone;
  const std::vector<Event>& events = walk.query().events;
  // The visits and tests of triangles beneath each visit, from the leaves upward.
  std::vector<std::uint64_t> beneath(events.size(), 0);
  for (std::size_t i = 0; i < events.size(); ++i)
    if (events[i].kind == EventKind::triangles && walk.parent(i) != kNone) ++beneath[walk.parent(i)];
  const std::vector<std::uint32_t>& order = walk.from_root();
  for (std::size_t k = order.size(); k-- > 0;)
    if (const std::uint32_t up = walk.parent(order[k]); up != kNone)
      beneath[up] += events[order[k]].tests + beneath[order[k]];
  for (std::size_t s = 0; s < kLargerLeaves.size(); ++s) {
    const auto would_be_leaves = [&](std::uint32_t i) {
      return walk.index(0).triangles_below[events[i].a] <= kLargerLeaves[s] &&
             walk.index(1).triangles_below[events[i].b] <= kLargerLeaves[s];
    };
    for (const std::uint32_t i : order) {
      const std::uint32_t up = walk.parent(i);
      if (events[i].met == 0 || !would_be_leaves(i) || (up != kNone && would_be_leaves(up))) continue;
      const std::uint64_t tests = std::uint64_t{walk.index(0).triangles_below[events[i].a]} *
                                  walk.index(1).triangles_below[events[i].b];
      out.saved_by_leaves[s] += static_cast<std::int64_t>(beneath[i]) - static_cast<std::int64_t>(tests);
    }
  }
}

std::vector<double> PriceBook::waste_by_triangle(std::uint32_t tree) {
  std::vector<double> out(bodies_.mesh_of(tree).triangles.size(), 0);
  const auto found = waste_of_nodes_.find(tree);
  if (found == waste_of_nodes_.end()) return out;
  const TreeIndex& index = bodies_.index(tree);
  // The share of each triangle below a node, as a sum from the root.
  std::vector<double> share(index.parent.size(), 0);
  for (const std::uint32_t n : index.from_root) {
    if (index.triangles_below[n] == 0) continue;
    share[n] = found->second[n] / index.triangles_below[n];
    if (index.parent[n] != kNull) share[n] += share[index.parent[n]];
    for (const std::uint32_t t : bodies_.tree(tree).triangles(n))
      if (t < out.size()) out[t] += share[n];
  }
  return out;
}

std::string advice(const Prices& sum) {
  const std::uint64_t tests = sum.volume_tests + sum.triangle_tests;
  if (tests == 0) return "No tests were recorded.";
  if (sum.visits == 0)
    return "No tests of volumes were recorded (LRBCAP_NODE), so nothing can be said about volumes, order and "
           "leaves.";
  if (sum.unattributed == sum.visits)
    return "No visit is attributed, as for queries of shapes or of first contact, so nothing can be said about "
           "volumes, order and leaves.";
  struct Gain {
    double rank, most;  ///< tests saved: those ascribed to it, and an upper bound
    std::string change;
  };
  std::vector<Gain> gains;
  const auto add = [&gains](double rank, double most, const std::string& change) {
    gains.push_back({rank, std::max(rank, most), change});
  };
  // A visit of wide nodes compares several volumes.
  const double each = static_cast<double>(sum.volume_tests) / static_cast<double>(sum.visits);
  const auto tests_of = [each](std::uint64_t visits, std::uint64_t triangles) {
    return each * static_cast<double>(visits) + static_cast<double>(triangles);
  };
  const double all = tests_of(sum.wasted(), sum.triangles_by_volumes);
  const double apart = static_cast<double>(sum.triangles_by_volumes) -
                       static_cast<double>(std::min(sum.triangles_by_volumes, sum.crowded_tests));
  if (sum.unsplit > sum.volumes + sum.order) {
    add(tests_of(sum.unsplit, 0) + apart, all, "tighter volumes or another order of descent");
  } else {
    const double order = tests_of(sum.order, sum.triangles_by_order);
    add(order, order, "another order of descent");
    add(tests_of(sum.volumes, 0) + apart, all, "tighter volumes");
  }
  const double sharper = tests_of(sum.test, sum.triangles_by_test);
  add(sharper, sharper, "a sharper test of these volumes");
  add(static_cast<double>(sum.crowded_tests), 0, "smaller leaves");
  const auto best = std::max_element(sum.saved_by_leaves.begin(), sum.saved_by_leaves.end());
  add(static_cast<double>(*best), 0,
      "leaves of up to " +
          std::to_string(kLargerLeaves[static_cast<std::size_t>(best - sum.saved_by_leaves.begin())]) +
          " triangles");
  std::stable_sort(gains.begin(), gains.end(), [](const Gain& x, const Gain& y) { return x.rank > y.rank; });
  const auto percent = [&](double saved) {
    const double share = std::ceil(100 * saved / static_cast<double>(tests) - 1e-9);
    return std::to_string(std::max(0L, std::lround(share))) + " %";
  };
  // Where the bound is not what it is ranked by, both are said.
  const auto share = [&](const Gain& gain, const std::string& of) {
    const bool has_both = percent(gain.most) != percent(gain.rank);
    return ", at most " + percent(gain.most) + of +
           (has_both ? ", of which no other change saves " + percent(gain.rank) : "");
  };
  if (!(gains[0].rank > 0)) return "Nothing to gain: every visit was needed.";
  return "Most to gain: " + gains[0].change +
         share(gains[0], " of " + render::group_digits(tests) + " tests of volumes and triangles") +
         "; next: " + gains[1].change + share(gains[1], "") + ".";
}

}  // namespace lrb::profile

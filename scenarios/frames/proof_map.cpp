#include "scenarios/frames/proof_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>

#include <lrbscope/explain.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::frames {

namespace palette = render::palette;

const ArgumentLook& look_of(Argument argument) {
  static constexpr std::array<ArgumentLook, kArguments> kLooks = {{
      {"boxes of nodes", palette::kBlue, 0.9},
      {"oriented boxes of nodes", palette::kGreen, 0.8},
      {"boxes of faces", palette::kSkyBlue, 0},
      {"planes of faces", palette::kPurple, 0},
      {"intervals in floats", palette::kOrange, 0},
      {"floating-point filter", palette::kVermillion, 0},
      {"exact arithmetic", palette::kInk, 0},
      {"intersecting", palette::kContact, 0},
      {"within the tolerance", palette::kFaint, 0},
      {"not needed", palette::kRule, 0.5},
  }};
  return kLooks[static_cast<std::size_t>(argument)];
}

std::string argument_name(Argument argument, const RecordedRun& recorded, const trace::Step& step) {
  const bool ours = recorded.trace->header.engine.empty();
  if (argument == Argument::child_boxes && !ours) return "bounding volumes";
  if (argument == Argument::floats && !ours) return "tests of triangles";
  if (argument == Argument::open && recorded.trace->truncated()) return "not recorded";
  if (argument == Argument::open && !ours) return "not needed or not reported";
  if (argument == Argument::tolerance && std::isfinite(step.result.error_bound) &&
      step.result.error_bound > 0)
    return "apart by at most " + render::short_number(step.result.error_bound);
  return std::string(look_of(argument).name);
}

MapAxis::MapAxis(const trace::TreeShape& tree) : low(tree.size()), high(tree.size()) {
  // Parents come before children: each divides its range among its simplices and children.
  for (const std::uint32_t n : tree.from_root()) {
    if (tree.depth(n) == 0) high[n] = tree.beneath(n);
    std::uint32_t next = low[n];
    for (const SimplexId s : tree.simplices(n)) {
      if (s >= leaf.size()) leaf.resize(s.value() + std::size_t{1}, kNull), rank.resize(leaf.size(), kNull);
      repeats |= leaf[s] != kNull;
      leaf[s] = n;
      rank[s] = next++;
    }
    for (const std::uint32_t child : tree.children(n)) {
      low[child] = next;
      high[child] = next += tree.beneath(child);
    }
  }
}

render::Rgba colour_of(const ProofMap& map, const render::Style& style, Argument argument, double pairs) {
  const ArgumentLook& look = look_of(argument);
  const double all = static_cast<double>(map.size[0]) * map.size[1];
  return style.pale(style.of(look.colour), look.pale * std::sqrt(std::log(pairs + 1) / std::log(all + 1)));
}

render::Image pixels_of(const ProofMap& map, const render::Style& style, const Eigen::AlignedBox2d& part,
                        int size, double point) {
  constexpr int kOutlined = 10;      // pixels
  constexpr double kOutline = 0.25;  // share of ink
  const int dot = std::max(1, static_cast<int>(std::lround(point)));
  render::Image out(size, size, style.paper);
  for (const MapCell& cell : map.cells) {
    std::array<int, 2> low{}, high{};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto axis = static_cast<Eigen::Index>(1 - i);  // A's simplices are rows
      // Neighbours round their common border alike, so that no gap is between them.
      const auto pixel = [&](std::uint32_t at) {
        const double x = (static_cast<double>(at) / map.size[i] - part.min()[axis]) / part.sizes()[axis];
        return static_cast<int>(std::lround(std::clamp(x, -1.0, 2.0) * size));
      };
      low[i] = pixel(cell.low[i]), high[i] = pixel(cell.high[i]);
      const int least = cell.is_upon() ? (cell.argument < Argument::contact ? 1 : 2) * dot : 0;
      if (const int more = least - (high[i] - low[i]); more > 0) low[i] -= more / 2, high[i] = low[i] + least;
    }
    const bool outlined = std::min(high[0] - low[0], high[1] - low[1]) >= kOutlined;
    const render::Rgba inside = colour_of(map, style, cell.argument, static_cast<double>(cell.pairs())),
                       rim = outlined ? render::mix(inside, style.ink, kOutline) : inside;
    for (int y = std::max(0, low[0]); y < std::min(high[0], size); ++y)
      for (int x = std::max(0, low[1]); x < std::min(high[1], size); ++x)
        out.at(x, y) = y == low[0] || x == low[1] || y == high[0] - 1 || x == high[1] - 1 ? rim : inside;
  }
  return out;
}

trace::TreeShape walked_shape(const RecordedRun& recorded, std::size_t side, std::uint32_t walked) {
  return recorded.trace->header.engine.empty()
             ? trace::TreeShape(trace::walked_tree(*recorded.reps[side], walked))
             : (*recorded.trees)[side];
}

namespace {

using trace::Event;
using trace::EventId;

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{a} << 32 | b;
}

/// Divides the square as the traversal did.
class MapMaker {
 public:
  /// `begin`: the event that begins the traversal; `end`: the end of its step.
  MapMaker(const RecordedRun& p, std::size_t step, EventId begin, EventId end)
      : p_(p), events_(p.trace->events), step_(p.trace->steps[step]) {
    const auto walk = events_[begin].phase_begin();
    walked_ = map_.walked = {walk.walked_a, walk.walked_b};
    for (std::size_t i = 0; i < 2; ++i) {
      tree_[i] = walked_shape(p, i, walked_[i]);
      axis_.emplace_back(tree_[i]);
      map_.size[i] = tree_[i].size() > 0 ? axis_[i].high[0] : 0;
    }
    for (EventId i = begin; i < end; ++i) {
      const Event& e = events_[i];
      if (e.kind == EventKind::node_pair) visits_.emplace(key_of(e.a, e.b), i);
      if ((e.kind == EventKind::face_test || e.kind == EventKind::plane_test) && e.a < axis_[0].leaf.size() &&
          e.b < axis_[1].leaf.size())
        tests_[key_of(axis_[0].leaf[e.a], axis_[1].leaf[e.b])][key_of(e.a, e.b)] = i;
    }
    visits_.contains(0) ? divide(0, 0) : add(0, 0, begin, Argument::open);
    map_.strays = visits_.size() - map_.visits + tests_.size();
    std::stable_sort(map_.cells.begin(), map_.cells.end(), [](const MapCell& x, const MapCell& y) {
      return (x.is_upon() ? x.argument : Argument::child_boxes) <
             (y.is_upon() ? y.argument : Argument::child_boxes);
    });
  }

  std::optional<ProofMap> take() {
    if (axis_[0].repeats || axis_[1].repeats) return std::nullopt;
    return std::move(map_);
  }

 private:
  using Nodes = std::span<const std::uint32_t>;

  bool ours() const { return p_.trace->header.engine.empty(); }
  /// Returns true for a query of another engine that need not visit all pairs.
  bool ends_early() const {
    return step_.result.engine && step_.result.engine->query != trace::EngineQuery::all_pairs;
  }
  std::uint64_t& count(Argument argument) { return map_.pairs[static_cast<std::size_t>(argument)]; }

  void add(std::uint32_t a, std::uint32_t b, EventId event, Argument argument) {
    const MapAxis &x = axis_[0], &y = axis_[1];
    const MapCell cell{{x.low[a], y.low[b]}, {x.high[a], y.high[b]}, {a, b}, event, argument};
    count(argument) += cell.pairs();
    if (cell.pairs() > 0) map_.cells.push_back(cell);
  }

  /// Divides the pairs of simplices below a visited pair of nodes.
  void divide(const std::uint32_t& a, const std::uint32_t& b) {
    const EventId visit = visits_.at(key_of(a, b));
    const trace::payload::NodePair pair = events_[visit].node_pair();
    ++map_.visits;
    if (pair.end.step == NodeStep::whole) return add(a, b, visit, Argument::node_boxes);
    if (!ours() && pair.work.met == 0) return add(a, b, visit, Argument::child_boxes);
    if (tree_[0].is_leaf(a) && tree_[1].is_leaf(b)) return divide_leaves(a, b, visit);
    // Visits of other trees may stay although only this node has children.
    const auto below = [&](std::size_t side, const std::uint32_t& node, NodeStep stays, std::uint32_t other) {
      const bool stay = pair.end.step == stays && !tree_[1 - side].is_leaf(other);
      return stay || tree_[side].is_leaf(node) ? Nodes(&node, 1) : tree_[side].children(node);
    };
    const Nodes of_a = below(0, a, NodeStep::descend_b, b), of_b = below(1, b, NodeStep::descend_a, a);
    struct Rest {
      const std::uint32_t *a, *b;
      double gap = 0;
    };
    std::vector<Rest> rest;  // the pairs of children that were not visited
    for (const std::uint32_t& i : of_a)
      for (const std::uint32_t& k : of_b)
        visits_.contains(key_of(i, k)) ? divide(i, k) : rest.push_back({&i, &k});
    // If a query ended early, some of them waited: those whose boxes overlap most. Another engine with one
    // test for each visit rejects a pair when it visits it.
    const std::size_t visited = of_a.size() * of_b.size() - rest.size(),
                      waited = ours() ? std::max<std::size_t>(pair.work.met, visited) - visited
                                      : (pair.work.box_tests <= 1 || ends_early() ? rest.size() : 0);
    const auto box = [&](std::size_t side, std::uint32_t node, Nodes of, const std::uint32_t* child) {
      const bool stays = of.size() == 1 && *child == node;
      return box_of(trace::walked_tree(*p_.reps[side], walked_[side]), node,
                    stays ? kWhole : static_cast<int>(child - of.data()),
                    side == 0 ? step_.pose_a : step_.pose_b);
    };
    if (ours() && waited > 0)
      for (Rest& r : rest) {
        BoxPair boxes;
        compare_boxes(box(0, a, of_a, r.a), box(1, b, of_b, r.b), boxes, p_.reps[0]->dim());
        r.gap = boxes.gap;
      }
    std::stable_sort(rest.begin(), rest.end(), [](const Rest& x, const Rest& y) { return x.gap < y.gap; });
    for (std::size_t i = 0; i < rest.size(); ++i)
      add(*rest[i].a, *rest[i].b, visit, i < waited ? Argument::open : Argument::child_boxes);
  }

  void divide_leaves(std::uint32_t a, std::uint32_t b, EventId visit) {
    const Argument rest = ours() ? Argument::face_boxes : Argument::open;
    add(a, b, visit, rest);
    std::uint64_t tested = 0, by_planes = 0;
    for (const auto& [pair, test] : tests_[key_of(a, b)]) {
      const Event& e = events_[test];
      const std::array<std::uint32_t, 2> at = {axis_[0].rank[e.a], axis_[1].rank[e.b]};
      map_.cells.push_back({at, {at[0] + 1, at[1] + 1}, {a, b}, test, argument_of(e)});
      ++count(argument_of(e)), --count(rest);
      ++(e.kind == EventKind::plane_test ? by_planes : tested);
    }
    tests_.erase(key_of(a, b));
    if (!ours()) return;
    // Below EventLevel::all, only the number of pairs that planes reject is known.
    const trace::NodeWork work = events_[visit].work();
    const std::uint64_t planes = work.rejected - by_planes,
                        left = std::max<std::uint64_t>(work.met - work.rejected, tested) - tested;
    count(Argument::planes) += planes, count(Argument::open) += left, count(rest) -= planes + left;
  }

  Argument argument_of(const Event& e) const {
    if (e.kind == EventKind::plane_test) return Argument::planes;
    if (e.meet != exact::Meet::disjoint)
      return walked_[0] + walked_[1] > 0 ? Argument::tolerance : Argument::contact;
    const TestedBy by = e.tested_by();
    if (by == TestedBy::filter || by == TestedBy::shared_corners) return Argument::filter;
    return by == TestedBy::expansions ? Argument::expansions : Argument::floats;
  }

  const RecordedRun& p_;
  const std::vector<Event>& events_;
  const trace::Step& step_;
  std::array<std::uint32_t, 2> walked_{};
  std::array<trace::TreeShape, 2> tree_;
  std::vector<MapAxis> axis_;
  std::unordered_map<std::uint64_t, EventId> visits_;  ///< by pair of nodes: the first
  /// By pair of leaves: the last test of each pair of simplices.
  std::unordered_map<std::uint64_t, std::map<std::uint64_t, EventId>> tests_;
  ProofMap map_;
};

}  // namespace

std::optional<ProofMap> proof_map(const RecordedRun& recorded, std::size_t step) {
  const trace::Trace& trace = *recorded.trace;
  const bool known =
      trace.header.engine.empty() || (recorded.trees != nullptr && recorded.trees->size() == 2);
  if (recorded.reps.size() != 2 || !known) return std::nullopt;
  const EventId first = trace.steps[step].first_event,
                end = first + static_cast<EventId>(trace.events_of(step).size());
  EventId walk = end, begin = end;  // the last traversal with visits
  for (EventId i = first; i < end; ++i) {
    const Event& e = trace.events[i];
    if (e.kind == EventKind::begin) walk = walks_trees(e.phase()) ? i : end;
    if (e.kind == EventKind::node_pair && walk < end) begin = walk;
  }
  if (begin == end) return std::nullopt;
  return MapMaker(recorded, step, begin, end).take();
}

}  // namespace lrb::frames

#include "scenarios/xray/foreign_run.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <unordered_map>

#include "trace/recorder.hpp"

namespace lrb::xray {
namespace {

std::vector<std::uint32_t> parents_of(const trace::TreeShape& tree) {
  std::vector<std::uint32_t> out(tree.size(), kNull);
  for (std::uint32_t n = 0; n < tree.size(); ++n)
    for (const std::uint32_t child : tree.children(n)) out[child] = n;
  return out;
}

/// Returns the leaf of each simplex.
std::vector<std::uint32_t> leaves_of(const trace::TreeShape& tree) {
  std::vector<std::uint32_t> out(tree.size() > 0 ? tree.beneath(0) : 0);
  for (std::uint32_t n = 0; n < tree.size(); ++n)
    for (const SimplexId s : tree.simplices(n))
      if (s < out.size()) out[s] = n;
  return out;
}

/// A pair of bounding volumes with what led to it.
struct Visit {
  std::size_t parent = kNone;  ///< index of a visit; kNone: the first pair
  std::optional<NodeStep> step;
  std::uint8_t children = 0;  ///< pairs that it led to
  static constexpr std::size_t kNone = ~std::size_t{0};
};

/// Finds which pair led to which: that of the parents, or of one parent and the other node.
class Descent {
 public:
  explicit Descent(const std::array<trace::TreeShape, 2>& trees)
      : trees_(trees),
        parents_{parents_of(trees[0]), parents_of(trees[1])},
        leaves_{leaves_of(trees[0]), leaves_of(trees[1])} {}

  /// Returns a visit for each event; those of leaf tests mean nothing.
  std::vector<Visit> visits_of(const std::vector<ForeignEvent>& events) {
    std::vector<Visit> out(events.size());
    visited_.clear();
    for (std::size_t i = 0; i < events.size(); ++i) {
      const ForeignEvent& e = events[i];
      if (e.is_leaf_test) {  // without a test of the leaves' boxes, if the engine does none
        const std::uint32_t a = leaves_[0][e.a], b = leaves_[1][e.b];
        if (!visited_.count(key(a, b))) lead(a, b, i, out);
        continue;
      }
      visited_[key(e.a, e.b)] = i;
      if (trees_[0].is_leaf(e.a) && trees_[1].is_leaf(e.b)) out[i].step = NodeStep::leaves;
      lead(e.a, e.b, i, out);
    }
    return out;
  }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

  /// Finds what led to visit i, of nodes a and b.
  void lead(std::uint32_t a, std::uint32_t b, std::size_t i, std::vector<Visit>& out) const {
    const std::uint32_t up_a = parents_[0][a], up_b = parents_[1][b];
    const struct {
      std::uint32_t a, b;
      NodeStep step;
    } above[] = {
        {up_a, b, NodeStep::descend_a}, {a, up_b, NodeStep::descend_b}, {up_a, up_b, NodeStep::descend_both}};
    for (const auto& pair : above) {
      if (pair.a == kNull || pair.b == kNull) continue;
      const auto found = visited_.find(key(pair.a, pair.b));
      if (found == visited_.end() || (out[found->second].step && *out[found->second].step != pair.step))
        continue;
      out[i].parent = found->second;
      out[found->second].step = pair.step;
      ++out[found->second].children;
      return;
    }
  }

  const std::array<trace::TreeShape, 2>& trees_;
  std::array<std::vector<std::uint32_t>, 2> parents_;
  std::array<std::vector<std::uint32_t>, 2> leaves_;  ///< of simplices
  std::unordered_map<std::uint64_t, std::size_t> visited_;
};

std::vector<SimplexPair> pairs_of(const ForeignStep& step) {
  std::vector<SimplexPair> out;
  for (const ForeignEvent& e : step.events)
    if (e.is_leaf_test && e.meet) out.push_back({SimplexId(e.a), SimplexId(e.b)});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Tells the recorder what the engine did, and returns its answer.
CollideResult replay(const ForeignStep& step, Descent& descent, trace::Recorder& recorder) {
  const std::vector<Visit> visits = descent.visits_of(step.events);
  std::vector<std::uint32_t> told(visits.size(), kNull);
  CollideResult result;
  recorder.begin(Phase::walk, 0, 0);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const ForeignEvent& e = step.events[i];
    const exact::Meet meet = e.meet ? exact::Meet::cross : exact::Meet::disjoint;
    if (e.is_leaf_test) {
      recorder.face_test(SimplexId(e.a), SimplexId(e.b), meet, 0, 0);
      if (e.meet) recorder.contact(SimplexId(e.a), SimplexId(e.b), meet);
      continue;
    }
    const Visit& v = visits[i];
    const bool leaves = v.step == NodeStep::leaves;
    const auto met = static_cast<std::uint8_t>(leaves ? e.meet : v.children);
    told[i] = recorder.node_pair({.a = e.a,
                                  .b = e.b,
                                  .parent = v.parent == Visit::kNone ? kNull.kValue : told[v.parent],
                                  .step = v.step.value_or(NodeStep::descend_both),
                                  .box_tests = 1,
                                  .met = met});
  }
  recorder.end(Phase::walk, step.box_tests);
  result.pairs = pairs_of(step);
  result.relation = result.pairs.empty() ? Relation::separate : Relation::crossing;
  result.counters.node_pairs = result.counters.box_tests = step.box_tests;
  result.counters.face_tests = result.counters.real_tests = step.leaf_tests;
  return result;
}

}  // namespace

run::Recording recording_of(const ForeignWalk& walk, const run::Recording& ours,
                            const spec::Scenario& scenario) {
  run::Recording out;
  out.bodies = ours.bodies;
  out.results = ours.results;
  out.trees = {walk.trees[0], walk.trees[1]};
  trace::RecorderSettings settings;
  settings.scenario = scenario.name;
  settings.scenario_hash = scenario.hash;
  settings.sources = {ours.trace.header.bodies[0].source, ours.trace.header.bodies[1].source};
  settings.event_cap = scenario.event_cap;
  settings.level = EventLevel::nodes;
  settings.engine = walk.title;
  trace::Recorder recorder(ours.bodies[0].rep, ours.bodies[1].rep, settings);
  Descent descent(walk.trees);
  for (std::size_t i = 0; i < walk.steps.size(); ++i) {
    const trace::Step& step = ours.trace.steps[i];
    recorder.begin_step(step.index, step.pose_a, step.pose_b);
    recorder.end_step(replay(walk.steps[i], descent, recorder));
    const WrongPairs wrong = wrong_pairs(walk.steps[i], ours.results[i].pairs);
    std::vector<run::WrongPair>& here = out.wrong.emplace_back();
    for (const SimplexPair& pair : wrong.too_many) here.push_back({pair, false});
    for (const SimplexPair& pair : wrong.missing) here.push_back({pair, true});
  }
  out.trace = recorder.take();
  if (out.trace.truncated())
    out.notes.push_back(walk.title + ": the trace holds the first " +
                        std::to_string(out.trace.events.size()) + " of " +
                        std::to_string(out.trace.events_seen) + " events");
  return out;
}

WrongPairs wrong_pairs(const ForeignStep& step, const std::vector<SimplexPair>& exact) {
  const std::vector<SimplexPair> found = pairs_of(step);
  WrongPairs out;
  std::set_difference(found.begin(), found.end(), exact.begin(), exact.end(),
                      std::back_inserter(out.too_many));
  std::set_difference(exact.begin(), exact.end(), found.begin(), found.end(),
                      std::back_inserter(out.missing));
  return out;
}

}  // namespace lrb::xray

#include "scenarios/profile/least_visits.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace lrb::profile {
namespace {

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
        if (step != recorded) try_step(a, b, step, QueryWalk::kNone, best);
    }
    return least_.insert(a, b, best);
  }

 private:
  bool has_children(std::size_t side, std::uint32_t node) const { return !walk_.index(side).is_leaf(node); }

  bool overlaps(std::uint32_t a, std::uint32_t b, std::uint32_t visit) const {
    if (visit != QueryWalk::kNone) return walk_.query().events[visit].met > 0;
    return overlap(*volumes_[0], a, walk_.query().poses[0], *volumes_[1], b, walk_.query().poses[1]);
  }

  /// Lowers `best` to the number for a choice. `recorded`: the visit, if the engine chose the same.
  void try_step(std::uint32_t a, std::uint32_t b, NodeStep step, std::uint32_t recorded,
                std::uint32_t& best) {
    const bool opens_a = step != NodeStep::descend_b, opens_b = step != NodeStep::descend_a;
    if ((opens_a && !has_children(0, a)) || (opens_b && !has_children(1, b))) return;
    if (opens_a && opens_b && !opens_both_) return;
    const std::uint32_t only_a[] = {a}, only_b[] = {b};
    const std::span<const std::uint32_t> all_a = opens_a ? trees_[0]->children(a) : std::span(only_a);
    const std::span<const std::uint32_t> all_b = opens_b ? trees_[1]->children(b) : std::span(only_b);
    std::uint32_t sum = 1;
    for (const std::uint32_t x : all_a) {
      if (opens_a && walk_.index(0).parent[x] != a) continue;  // also another node's child
      for (const std::uint32_t y : all_b) {
        if (opens_b && walk_.index(1).parent[y] != b) continue;
        if (walk_.wide() && !is_visited(x, y, recorded)) continue;
        if (sum >= best || gave_up_) return;
        sum += least(x, y);
      }
    }
    best = std::min(best, sum);
  }

  /// Wide nodes: returns true if the volumes of two children overlap.
  bool is_visited(std::uint32_t x, std::uint32_t y, std::uint32_t recorded) const {
    if (walk_.visit_of(x, y) != QueryWalk::kNone) return true;
    return recorded == QueryWalk::kNone && overlaps(x, y, QueryWalk::kNone);
  }

  const QueryWalk& walk_;
  std::array<const capture::Tree*, 2> trees_;
  std::array<const Volumes*, 2> volumes_;
  PairMap least_;
  bool opens_both_ = false, gave_up_ = false;
};

std::uint32_t levels_of(const TreeIndex& index) {
  return index.depth[index.from_root.back()];  // breadth first: the deepest node is last
}

}  // namespace

std::optional<std::uint64_t> least_visits(CapturedBodies& bodies, const QueryWalk& walk) {
  // The search recurses once for each level.
  if (levels_of(walk.index(0)) + levels_of(walk.index(1)) > kMaxLevels) return std::nullopt;
  Search search(bodies, walk);
  std::uint64_t least = 0;
  for (const std::uint32_t i : walk.from_root())
    if (walk.is_start(i) && walk.first_visit(i) == i)
      least += search.least(walk.query().events[i].a, walk.query().events[i].b);
  if (search.gave_up()) return std::nullopt;
  return least;
}

}  // namespace lrb::profile

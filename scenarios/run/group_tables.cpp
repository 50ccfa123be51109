#include "scenarios/run/group_tables.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

#include "render/overlay.hpp"
#include "scenarios/run/face_groups.hpp"
#include "trace/counters.hpp"
#include "trace/node_work.hpp"

namespace lrb::run {
namespace {

using render::group_digits;

/// Sums over the faces of a group.
struct GroupSums {
  std::uint64_t faces = 0, tests = 0, hits = 0, misses = 0, expansions = 0;
  double box_tests = 0;
  std::uint64_t refined = 0;  ///< how often the region was

  GroupSums& operator+=(const GroupSums& o) {
    faces += o.faces, tests += o.tests, hits += o.hits, misses += o.misses, expansions += o.expansions;
    box_tests += o.box_tests, refined += o.refined;
    return *this;
  }
};

/// Counts for each group of a body's faces; the last one is of faces without a group.
class Groups {
 public:
  Groups(const RecordedRun& p, Side side, std::size_t count,
         const std::function<std::uint32_t(const LrbRep&, FaceId)>& group_of)
      : rep_(*p.reps[static_cast<std::size_t>(side)]), with_boxes_(p.trees != nullptr && !p.trees->empty()) {
    sums.resize(count + 1);
    const trace::FaceCounts counts = trace::count_faces(rep_, side, p.trace->events);
    std::vector<double> boxes(rep_.face_count());
    if (with_boxes_) {
      const trace::TreeShape& tree = (*p.trees)[static_cast<std::size_t>(side)];
      boxes = trace::box_tests_by_face(rep_, tree, trace::count_nodes(tree, side, p.trace->events));
    }
    for (FaceId f = 0; f < rep_.face_count(); ++f)
      sums[std::min<std::size_t>(group_of(rep_, f), count)] +=
          {1, counts.tests[f], counts.hits[f], counts.misses[f], counts.expansions[f], boxes[f], 0};
  }

  /// Returns the titles of the columns that cells() fills.
  std::vector<std::string> columns() const {
    std::vector<std::string> out = {"faces", "tests", "hits", "misses"};
    if (with_boxes_) out.insert(out.end(), {"expansions", "box tests"});
    return out;
  }
  std::vector<std::string> cells(const GroupSums& s) const {
    std::vector<std::string> out = {group_digits(s.faces), group_digits(s.tests), group_digits(s.hits),
                                    group_digits(s.misses)};
    if (with_boxes_)
      out.insert(out.end(), {group_digits(s.expansions),
                             group_digits(static_cast<std::uint64_t>(std::llround(s.box_tests)))});
    return out;
  }
  GroupSums total() const { return std::accumulate(sums.begin(), sums.end(), GroupSums(), add); }
  static GroupSums add(GroupSums x, const GroupSums& y) { return x += y; }

  std::vector<GroupSums> sums;

 private:
  const LrbRep& rep_;
  bool with_boxes_;
};

void append(std::vector<std::string>& row, const std::vector<std::string>& cells) {
  row.insert(row.end(), cells.begin(), cells.end());
}

report::PageTable level_table(const RecordedRun& p, Side side) {
  const LrbRep& rep = *p.reps[static_cast<std::size_t>(side)];
  std::uint32_t levels = 0;
  for (FaceId f = 0; f < rep.face_count(); ++f) levels = std::max(levels, level_of(rep, f) + 1);
  const Groups groups(p, side, levels, level_of);
  report::PageTable t;
  t.title = "Counters of " + std::string(name_of(side)) + " by level";
  t.columns = {"level"};
  append(t.columns, groups.columns());
  for (std::uint32_t level = 0; level < levels; ++level) {
    t.rows.push_back({std::to_string(level)});
    append(t.rows.back(), groups.cells(groups.sums[level]));
  }
  t.rows.push_back({"all"});
  append(t.rows.back(), groups.cells(groups.total()));
  t.note =
      "Over all time steps. Level: number of regions between a face and the outside. Misses: tests that led to nothing.";
  return t;
}

report::PageTable region_table(const RecordedRun& p, Side side) {
  constexpr std::size_t kMostRows = 20;
  const LrbRep& rep = *p.reps[static_cast<std::size_t>(side)];
  Groups groups(p, side, rep.region_count(), region_of);
  for (const trace::Event& e : p.trace->events)
    if (e.kind == EventKind::refine && e.side == side) ++groups.sums[e.region().value()].refined;
  std::vector<std::uint32_t> order(rep.region_count());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
    return groups.sums[x].tests > groups.sums[y].tests;
  });
  report::PageTable t;
  t.title = "Counters of " + std::string(name_of(side)) + " by region";
  t.rows_are = side == Side::a ? report::PageRows::regions_of_a : report::PageRows::regions_of_b;
  t.columns = {"region", "layer", "depth"};
  append(t.columns, groups.columns());
  t.columns.emplace_back("refined");
  const auto add = [&](std::vector<std::string> first, const GroupSums& s) {
    append(first, groups.cells(s));
    first.push_back(group_digits(s.refined));
    t.rows.push_back(std::move(first));
  };
  for (std::size_t i = 0; i < std::min(order.size(), kMostRows); ++i) {
    const RegionId r(order[i]);
    add({std::to_string(order[i]), std::to_string(rep.layer(r)), std::to_string(rep.depth(r))},
        groups.sums[order[i]]);
  }
  if (order.size() > kMostRows) {
    GroupSums rest;
    for (std::size_t i = kMostRows; i < order.size(); ++i) rest += groups.sums[order[i]];
    add({group_digits(order.size() - kMostRows) + " others", "", ""}, rest);
  }
  add({"no region", "", ""}, groups.sums.back());
  add({"all", "", ""}, groups.total());
  t.note =
      "Over all time steps; those with the most tests. A click on a row selects the region in the view. A real face belongs to the region that covers it, a pseudo face "
      "to the one that it hides.";
  return t;
}

}  // namespace

std::vector<report::PageTable> group_tables(const RecordedRun& run) {
  if (run.reps.size() != 2) return {};
  std::vector<report::PageTable> out;
  for (const Side side : {Side::a, Side::b}) out.push_back(level_table(run, side));
  for (const Side side : {Side::a, Side::b})
    if (run.reps[static_cast<std::size_t>(side)]->region_count() > 0) out.push_back(region_table(run, side));
  return out;
}

}  // namespace lrb::run

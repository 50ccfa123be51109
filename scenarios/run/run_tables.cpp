#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/face_colours.hpp"
#include "scenarios/run/run_charts.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/work.hpp>
#include <lrbscope/validate.hpp>

namespace lrb::run {
namespace {

using render::group_digits;

/// Sums over the faces of a group.
struct GroupSums {
  std::uint64_t faces = 0, tests = 0, hits = 0, misses = 0, expansions = 0;
  double box_tests = 0;
  std::uint64_t refined = 0;  ///< number of refinements of the region

  GroupSums& operator+=(const GroupSums& o) {
    faces += o.faces, tests += o.tests, hits += o.hits, misses += o.misses, expansions += o.expansions;
    box_tests += o.box_tests, refined += o.refined;
    return *this;
  }
};

/// Counts for each group of a body's faces; the last one is for faces without a group.
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

report::Table level_table(const RecordedRun& p, Side side) {
  const LrbRep& rep = *p.reps[static_cast<std::size_t>(side)];
  std::uint32_t levels = 0;
  for (FaceId f = 0; f < rep.face_count(); ++f) levels = std::max(levels, level_of(rep, f) + 1);
  const Groups groups(p, side, levels, level_of);
  report::Table t{"Counters of " + std::string(name_of(side)) + " by level", {"level"}};
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

report::Table region_table(const RecordedRun& p, Side side) {
  constexpr std::size_t kMaxRows = 20;
  const LrbRep& rep = *p.reps[static_cast<std::size_t>(side)];
  Groups groups(p, side, rep.region_count(), region_of);
  for (const trace::Event& e : p.trace->events)
    if (e.kind == EventKind::refine && e.side == side) ++groups.sums[e.region().value()].refined;
  std::vector<std::uint32_t> order(rep.region_count());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
    return groups.sums[x].tests > groups.sums[y].tests;
  });
  report::Table t{"Counters of " + std::string(name_of(side)) + " by region", {"region", "layer", "depth"}};
  append(t.columns, groups.columns());
  t.columns.emplace_back("refined");
  const auto add = [&](std::vector<std::string> first, const GroupSums& s) {
    append(first, groups.cells(s));
    first.push_back(group_digits(s.refined));
    t.rows.push_back(std::move(first));
  };
  for (std::size_t i = 0; i < std::min(order.size(), kMaxRows); ++i) {
    const RegionId r(order[i]);
    add({std::to_string(order[i]), std::to_string(rep.layer(r)), std::to_string(rep.depth(r))},
        groups.sums[order[i]]);
    t.targets.push_back((side == Side::a ? "region 0 " : "region 1 ") + std::to_string(order[i]));
  }
  if (order.size() > kMaxRows) {
    GroupSums rest;
    for (std::size_t i = kMaxRows; i < order.size(); ++i) rest += groups.sums[order[i]];
    add({group_digits(order.size() - kMaxRows) + " others", "", ""}, rest);
  }
  add({"no region", "", ""}, groups.sums.back());
  add({"all", "", ""}, groups.total());
  t.note =
      "Over all time steps; those with the most tests. A click on a row selects the region in the view. A real face belongs to the region that covers it, a pseudo face "
      "to the one that it hides.";
  return t;
}

}  // namespace

std::vector<report::Table> group_tables(const RecordedRun& run) {
  if (run.reps.size() != 2) return {};
  std::vector<report::Table> out;
  for (const Side side : {Side::a, Side::b}) out.push_back(level_table(run, side));
  for (const Side side : {Side::a, Side::b})
    if (run.reps[static_cast<std::size_t>(side)]->region_count() > 0) out.push_back(region_table(run, side));
  return out;
}

namespace {

using render::percent;
using render::short_number;

report::Table share_table(const trace::Trace& trace) {
  report::Table t{"Where the work went", {"part of the query", "events", "box tests", "count", "of"}};
  const bool timed = !trace.wall_ns.empty();
  if (timed) t.columns.insert(t.columns.end(), {"microseconds", "share"});
  const std::vector<trace::WorkShare> shares = trace::work_shares(trace);
  double all = 0;
  for (const trace::WorkShare& s : shares) all += s.seconds;
  for (const trace::WorkShare& s : shares) {
    if (s.events == 0) continue;
    t.rows.push_back({io::in_words(s.name), group_digits(s.events),
                      s.box_tests > 0 ? group_digits(s.box_tests) : "", group_digits(s.count),
                      std::string(s.what)});
    if (timed)
      t.rows.back().insert(t.rows.back().end(), {short_number(1e6 * s.seconds), percent(s.seconds / all)});
  }
  t.note =
      "Over all time steps. Traversal: pairs of inner nodes; leaves: pairs of leaves, whose faces' boxes and planes "
      "are compared eight at a time; face tests by what decided them.";
  if (timed) t.note += " Times include the recording.";
  return t;
}

report::Table depth_table(const RecordedRun& p, Side side) {
  const trace::TreeShape& tree = (*p.trees)[static_cast<std::size_t>(side)];
  report::Table t{"The walk of " + std::string(name_of(side)) + "'s tree, by depth",
                  {"depth", "nodes", "expected", "visited", "visits", "ended here", "box tests"}};
  const auto depths = trace::work_by_depth(tree, trace::count_nodes(tree, side, p.trace->events));
  for (std::size_t d = 0; d < depths.size(); ++d) {
    const trace::DepthWork& w = depths[d];
    t.rows.push_back({std::to_string(d), group_digits(w.nodes), short_number(w.expected),
                      group_digits(w.nodes_visited), group_digits(w.visits), group_digits(w.ended),
                      group_digits(w.box_tests)});
    t.targets.push_back("boxes " + std::to_string(d));
  }
  t.note =
      "Over all time steps; walks of levels are left out. Expected: nodes that a random line through the root's box "
      "meets, by the surface area heuristic. Visited: different nodes; visits: pairs of nodes, a node once with each of the other body's. A click on a row shows the boxes of this "
      "depth in the view.";
  return t;
}

/// A line of the quality sheet: its name, and its value for each body.
struct Quality {
  const char* name;
  std::function<std::string(const LrbRep&, const TreeQuality&)> value;
  const char* best;
};

const std::vector<Quality>& qualities() {
  static const std::vector<Quality> all = {
      {"tree: nodes", [](const LrbRep&, const TreeQuality& q) { return group_digits(q.nodes); }, ""},
      {"tree: height", [](const LrbRep&, const TreeQuality& q) { return std::to_string(q.height); }, ""},
      {"tree: inner nodes a random line visits",
       [](const LrbRep&, const TreeQuality& q) { return short_number(q.sah_inner); }, "small"},
      {"tree: leaves it visits",
       [](const LrbRep&, const TreeQuality& q) { return short_number(q.sah_leaves); }, "small"},
      {"tree: children of 8 a node",
       [](const LrbRep&, const TreeQuality& q) { return percent(q.child_fill); }, "high"},
      {"tree: faces of 8 a leaf", [](const LrbRep&, const TreeQuality& q) { return percent(q.leaf_fill); },
       "high"},
      {"tree: siblings that overlap",
       [](const LrbRep&, const TreeQuality& q) { return percent(q.sibling_overlap); }, "low"},
      {"tree: bytes a triangle",
       [](const LrbRep&, const TreeQuality& q) { return short_number(q.bytes_per_simplex); }, "low"},
      {"LRB-rep: faces in all per real face",
       [](const LrbRep& r, const TreeQuality&) {
         return short_number(static_cast<double>(r.face_count()) / r.real_face_count());
       },
       "near 1"},
      {"LRB-rep: regions", [](const LrbRep& r, const TreeQuality&) { return group_digits(r.region_count()); },
       ""},
      {"LRB-rep: layers", [](const LrbRep& r, const TreeQuality&) { return std::to_string(r.layer_count()); },
       ""},
      {"LRB-rep: faces of the outermost wrapper",
       [](const LrbRep& r, const TreeQuality&) {
         return r.region_count() == 0 ? "no wrapper" : group_digits(r.outermost_faces().size());
       },
       "few"},
      {"LRB-rep: mean height of lids above what they hide, share of the size",
       [](const LrbRep& r, const TreeQuality&) {
         return r.region_count() == 0 ? "no lids" : percent(lid_height(r) / box_of(r).diagonal().norm());
       },
       "low"},
  };
  return all;
}

}  // namespace

std::vector<report::Table> work_tables(const RecordedRun& run) {
  if (run.trees == nullptr || run.trees->empty()) return {};
  return {share_table(*run.trace), depth_table(run, Side::a), depth_table(run, Side::b)};
}

report::Table quality_table(const RecordedRun& run) {
  report::Table t{"Quality of the bodies", {"figure"}};
  std::vector<TreeQuality> trees;
  for (std::size_t i = 0; i < run.reps.size(); ++i) {
    t.columns.push_back(run.reps.size() == 1 ? "body" : i == 0 ? "A" : "B");
    trees.push_back(tree_quality(run.reps[i]->tree()));
  }
  t.columns.emplace_back("best");
  for (const Quality& q : qualities()) {
    t.rows.push_back({q.name});
    for (std::size_t i = 0; i < run.reps.size(); ++i)
      t.rows.back().push_back(q.value(*run.reps[i], trees[i]));
    t.rows.back().push_back(q.best);
  }
  t.note =
      "A random line through the root's box meets a node's box as often as their areas say: the cost by the surface "
      "area heuristic.";
  return t;
}

}  // namespace lrb::run

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

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

/// The meaning of each column and key figure on the page of a run, for tooltips.
constexpr std::pair<std::string_view, std::string_view> kMeaningOfNames[] = {
    // Key figures.
    {"Relation",
     "how the bodies are to each other at the last step: separate, touching, crossing, or one inside the other"},
    {"Pairs", "pairs of intersecting faces, one of A and one of B; none is missed"},
    {"Contact regions", "connected groups of intersecting pairs"},
    {"First contact", "the step, with fraction, at which the surfaces first touch; proven"},
    {"Refined", "regions that the query removed from the wrappers because the other body is near"},
    {"Real faces", "faces of the bodies themselves, without pseudo faces"},
    {"Pseudo faces", "faces of the wrappers that are not faces of the body"},
    {"Outermost wrapper", "faces of the simplest surface that encloses the body"},
    {"Regions", "spaces between wrappers and body, removed one by one"},
    {"Without wrapper", "bodies without regions: the query compares all their faces"},
    {"Error bound", "largest deviation of the compared wrappers from the bodies, in mesh units; proven"},
    {"Penetration depth", "length of the shortest translation of B that separates the bodies; proven bounds"},
    {"Shared volume", "volume common to both bodies; proven bounds"},
    {"Passes", "passes of the builder that made regions"},
    {"Caps", "covers of a patch with fewer faces, which the builder accepted"},
    {"Wrong verdicts", "queries whose yes or no contradicts the exact answer"},
    {"Missed pairs", "pairs of triangles that intersect and that the engine did not find"},
    {"False pairs", "pairs of triangles that the engine found and that are disjoint"},
    // Columns.
    {"step", "number of the time step"},
    {"query", "number of the query"},
    {"region", "number of the region"},
    {"layer", "pass of the builder that made the region; 0 lies on the body"},
    {"depth", "of a region: steps to the outside; of a tree node: steps to the root"},
    {"level", "number of regions between a face and the outside"},
    {"relation", "how the bodies are to each other at the step"},
    {"pairs", "intersecting pairs of faces"},
    {"faces", "faces in the group, real and pseudo"},
    {"tests", "exact comparisons of these faces with faces of the other body"},
    {"hits", "tests that found the faces to intersect"},
    {"misses", "tests of disjoint faces"},
    {"expansions", "tests that only exact arithmetic could decide"},
    {"box tests", "tests of two boxes, of tree nodes or of faces"},
    {"plane tests", "pairs of faces with overlapping boxes, compared by their planes"},
    {"face tests", "exact tests of two triangles (2D: segments)"},
    {"refinements", "regions removed from a wrapper"},
    {"refined", "times that the region was removed from its wrapper"},
    {"microseconds", "wall-clock time, recording included"},
    {"share", "part of the total"},
    {"events", "recorded events of this part"},
    {"count", "operations of this part, named in the next column"},
    {"fingerprint", "hash of the sorted pairs: equal answers have equal fingerprints"},
    {"error bound", "largest deviation of the compared wrappers from the bodies; 0: the answer is exact"},
    {"finished", "no: a limit was reached before the tolerance"},
    {"proof of separation", "faces of two disjoint wrappers that enclose the bodies"},
    {"distance", "smallest distance of the two surfaces, in mesh units; proven bounds"},
    {"contact kind", "clash class of the contact"},
    {"points inside", "points of B inside A"},
    {"smallest distance", "of the points of B to A, negative inside A"},
    {"contact manifolds", "groups of contact points with one normal"},
    {"points", "contact points of all manifolds, before reduction"},
    {"nodes", "nodes of the tree at this depth"},
    {"expected", "nodes whose box a random line meets, by the surface area heuristic"},
    {"visited", "different nodes that were visited"},
    {"visits", "visited pairs of nodes that this depth is part of"},
    {"ended here", "visits that led no deeper"},
    {"curves", "intersection curves of the contact region"},
    {"length", "total length of the curves, in mesh units"},
    {"area", "area that the curves span, or of coplanar contact, in mesh units squared"},
    {"depth, estimated", "estimated translation of B along the normal that separates the region"},
    {"centroid", "centre of the contact region, world frame"},
    {"normal, A to B", "mean unit normal of the contact region, world frame"},
    {"A", "value of body A"},
    {"B", "value of body B"},
    {"body", "value of the body"},
    {"pass", "number of the pass"},
    {"max deviation", "deviation that the pass allows for its caps, in mesh units; estimated"},
    {"deviation", "largest deviation of the caps of the pass, in mesh units; estimated"},
    {"faces before", "faces of the front before the pass"},
    {"after", "faces of the front after the pass"},
    {"regions", "regions that the pass made"},
    {"patches", "parts of the front for which the pass tried a cap"},
    {"caps", "caps that were accepted, or have this verdict"},
    {"cost", "new faces for each face that the front loses"},
    {"rejected", "caps that were tried and not accepted"},
    {"engine's pairs", "pairs of triangles that the engine reported"},
    {"right", "reported pairs that intersect"},
    {"missed", "intersecting pairs that the engine did not report"},
    {"false", "reported pairs that are disjoint"},
    {"tests of volumes", "tests of two bounding volumes by the engine"},
    {"tests of triangles", "tests of two triangles by the engine"},
    {"thread", "thread of the engine that ran the query"},
    {"values", "how often the engine reported the counter"},
    {"least", "smallest value"},
    {"mean", "mean of the values"},
    {"greatest", "largest value"},
    {"sum", "sum of the values"},
};

}  // namespace

std::string_view meaning_for_engines(std::string_view name) {
  if (name == "Faces") return "faces of both bodies";
  if (name == "depth") return "steps to the root of the tree";
  if (name == "faces") return "faces of the bodies";
  return meaning_of_column(name);
}

std::string_view meaning_of_column(std::string_view name) {
  std::string column(name);  // a key figure without its own entry is named like a column
  if (!column.empty() && column[0] >= 'A' && column[0] <= 'Z') column[0] += 'a' - 'A';
  for (const std::string_view key : {name, std::string_view(column)})
    for (const auto& [entry, meaning] : kMeaningOfNames)
      if (entry == key) return meaning;
  for (const auto& n : NearPairsNumbers::kShown)
    if (n.on_pages == column) return n.meaning;
  return {};
}

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
  Groups(const frames::RecordedRun& p, Side side, std::size_t count,
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

report::Table level_table(const frames::RecordedRun& p, Side side) {
  const LrbRep& rep = *p.reps[static_cast<std::size_t>(side)];
  std::uint32_t levels = 0;
  for (FaceId f = 0; f < rep.face_count(); ++f) levels = std::max(levels, frames::level_of(rep, f) + 1);
  const Groups groups(p, side, levels, frames::level_of);
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

report::Table region_table(const frames::RecordedRun& p, Side side) {
  constexpr std::size_t kMaxRows = 20;
  const LrbRep& rep = *p.reps[static_cast<std::size_t>(side)];
  Groups groups(p, side, rep.region_count(), frames::region_of);
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

std::vector<report::Table> group_tables(const frames::RecordedRun& run) {
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

report::Table depth_table(const frames::RecordedRun& p, Side side) {
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
         return r.region_count() == 0 ? "no lids"
                                      : percent(lid_height(r) / pictures::box_of(r).diagonal().norm());
       },
       "low"},
  };
  return all;
}

}  // namespace

std::vector<report::Table> work_tables(const frames::RecordedRun& run) {
  if (run.trees == nullptr || run.trees->empty()) return {};
  return {share_table(*run.trace), depth_table(run, Side::a), depth_table(run, Side::b)};
}

report::Table quality_table(const frames::RecordedRun& run) {
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

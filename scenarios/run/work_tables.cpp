#include "scenarios/run/work_tables.hpp"

#include <algorithm>
#include <functional>
#include <string>

#include "engine/lrb/validate.hpp"
#include "engine/tree/tree_quality.hpp"
#include "render/overlay.hpp"
#include "scenarios/run/chosen_view.hpp"
#include "scenarios/run/view_camera.hpp"
#include "trace/node_work.hpp"
#include "trace/work_shares.hpp"

namespace lrb::run {
namespace {

using render::group_digits;
using render::short_number;

std::string percent(double share) {
  return short_number(100 * share) + " %";
}

report::PageTable share_table(const trace::Trace& trace) {
  report::PageTable t;
  t.title = "Where the work went";
  t.columns = {"part of the query", "events", "box tests", "count", "of"};
  const bool timed = !trace.wall_ns.empty();
  if (timed) t.columns.insert(t.columns.end(), {"microseconds", "share"});
  const std::vector<trace::WorkShare> shares = trace::work_shares(trace);
  double all = 0;
  for (const trace::WorkShare& s : shares) all += s.seconds;
  for (const trace::WorkShare& s : shares) {
    if (s.events == 0) continue;
    std::string name(s.name);
    std::replace(name.begin(), name.end(), '_', ' ');
    t.rows.push_back({name, group_digits(s.events), s.box_tests > 0 ? group_digits(s.box_tests) : "",
                      group_digits(s.count), std::string(s.what)});
    if (timed)
      t.rows.back().insert(t.rows.back().end(), {short_number(1e6 * s.seconds), percent(s.seconds / all)});
  }
  t.note =
      "Over all time steps. Traversal: pairs of inner nodes; leaves: pairs of leaves, whose faces' boxes and planes "
      "are compared eight at a time; face tests by what decided them.";
  if (timed) t.note += " Times include the recording.";
  return t;
}

report::PageTable depth_table(const RecordedRun& p, Side side) {
  const trace::TreeShape& tree = (*p.trees)[static_cast<std::size_t>(side)];
  report::PageTable t;
  t.title = "The walk of " + std::string(name_of(side)) + "'s tree, by depth";
  t.columns = {"depth", "nodes", "expected", "visited", "visits", "ended here", "box tests"};
  const auto depths = trace::work_by_depth(tree, trace::count_nodes(tree, side, p.trace->events));
  for (std::size_t d = 0; d < depths.size(); ++d) {
    const trace::DepthWork& w = depths[d];
    t.rows.push_back({std::to_string(d), group_digits(w.nodes), short_number(w.expected),
                      group_digits(w.nodes_visited), group_digits(w.visits), group_digits(w.ended),
                      group_digits(w.box_tests)});
  }
  t.note =
      "Over all time steps; walks of levels are left out. Expected: nodes that a random line through the root's box "
      "meets, by the surface area heuristic. Visited: different nodes; visits: pairs of nodes, a node once with each of the other body's.";
  return t;
}

/// A line of the quality sheet: what it is, and its value for a body.
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

std::vector<report::PageTable> work_tables(const RecordedRun& run) {
  if (run.trees == nullptr || run.trees->empty()) return {};
  return {share_table(*run.trace), depth_table(run, Side::a), depth_table(run, Side::b)};
}

report::PageTable quality_table(const RecordedRun& run) {
  report::PageTable t;
  t.title = "Quality of the bodies";
  t.columns = {"figure"};
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

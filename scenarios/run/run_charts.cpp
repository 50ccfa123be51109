#include "scenarios/run/run_charts.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "scenarios/frames/frame_state.hpp"
#include "scenarios/record/attempts.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>

namespace lrb::run {
namespace {

using render::group_digits;
using render::percent;
using render::short_number;
using Passes = std::vector<trace::PassSummary>;

constexpr const char* kLength = "length, mesh units";

/// Descriptions of the verdicts, in the order of the enum.
constexpr std::array<std::string_view, kEnumNames<CapVerdict>.size()> kMeanings = {
    "it became part of the front",
    "with fewer faces its deviation would exceed the limit of the pass",
    "with fewer faces it would add more space than a collapse may",
    "with fewer faces some would be needles",
    "no position for the new vertex is in front of all removed faces and within the bounds",
    "collapsing any more edges would leave no surface",
    "it saves too few faces to be worth a region",
    "a polygon of the mesh has one face in the LRB-rep: it is covered as a whole or not at all",
    "at its boundary it would have turned inward",
    "its own faces intersected",
    "it intersected the faces to be covered",
    "it intersected another part of the front: a gap is too narrow for it",
    "it might enclose another component",
    "another cap of the same pass, with less area per removed face, was accepted first",
    "bridging joins one outline with its convex hull, and there are several",
    "bridging is skipped for convex hulls with very large polygons or fans",
    "the convex hull has no interior, or the outline intersects itself",
    "coordinates are too large for a wrapper around them",
    "the planned wrapper does not contain the front"};

std::vector<std::string> pass_row(const trace::PassSummary& p) {
  const bool made = p.regions > 0;
  const double saved = static_cast<double>(p.covered) - p.lids;
  return {made ? std::to_string(p.number()) : "",
          std::string(name_of(p.stage)),
          p.max_deviation > 0 ? short_number(p.max_deviation) : "",
          p.deviation > 0 ? short_number(p.deviation) : "",
          group_digits(p.faces_before),
          group_digits(p.faces_after),
          group_digits(p.regions),
          group_digits(p.patches),
          group_digits(p.accepted()),
          saved > 0 ? short_number(p.lids / saved) : "",
          group_digits(p.rejected()),
          trace::rejection_text(p.caps)};
}

report::Table pass_table(const Passes& passes) {
  report::Table t{"Passes",
                  {"pass", "stage", "max deviation", "deviation", "faces before", "after", "regions",
                   "patches", "caps", "cost", "rejected", "reasons"}};
  for (const trace::PassSummary& p : passes) t.rows.push_back(pass_row(p));
  t.note =
      "A pass covers the front with patches and tries a cap on each. Max deviation: allowed for caps; deviation: the largest of "
      "its caps; both estimated, in mesh units. Cost: new faces for each that the front loses. Passes without a number "
      "built nothing; the next one allows more.";
  const auto sum = [&](auto member) {
    std::uint64_t n = 0;
    for (const trace::PassSummary& p : passes) n += p.*member;
    return n;
  };
  if (const std::uint64_t merged = sum(&trace::PassSummary::merged); merged > 0)
    t.note +=
        " " + render::counted(merged, "piece", "pieces") + " of space merged into the surrounding region.";
  if (const std::uint64_t retried = sum(&trace::PassSummary::retried); retried > 0)
    t.note += " " + render::counted(retried, "cap", "caps") +
              " intersected something at first and were rebuilt with a check of each collapse.";
  std::uint32_t excluded = 0;
  for (const trace::PassSummary& p : passes) excluded = std::max(excluded, p.excluded);
  if (excluded > 0)
    t.note +=
        " " + render::counted(excluded, "face was", "faces were") +
        " left to the outermost wrapper alone: they intersect others, lie within another component, or belong to a "
        "very large polygon or fan.";
  return t;
}

report::Table rejection_table(const Passes& passes) {
  const auto caps = trace::caps_of(passes);
  std::uint64_t all = 0;
  for (const std::uint32_t n : caps) all += n;
  std::vector<std::size_t> order;
  for (std::size_t v = 0; v < caps.size(); ++v)
    if (caps[v] > 0) order.push_back(v);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t x, std::size_t y) { return caps[x] > caps[y]; });
  report::Table t{"Caps by verdict", {"verdict", "caps", "share", "meaning"}};
  for (const std::size_t v : order)
    t.rows.push_back({std::string(trace::text_of(static_cast<CapVerdict>(v))), group_digits(caps[v]),
                      percent(static_cast<double>(caps[v]) / static_cast<double>(all)),
                      std::string(kMeanings[v])});
  t.note =
      "Over all passes; a part of the front without a cap is tried again in later ones. A cap with too many faces counts by the "
      "reason that rejects most of the remaining collapses, limits before geometry.";
  return t;
}

/// Returns the regions where most caps were rejected first, and how each was made.
report::Table region_table(const frames::RecordedRun& p) {
  constexpr std::size_t kMaxRows = 200;
  const LrbRep& rep = *p.reps[0];
  const std::vector<record::Attempt> attempts = record::attempts_of(*p.trace);
  const auto of_region = record::attempts_by_region(*p.trace, rep, attempts);
  std::vector<record::VerdictCounts> verdicts;
  std::vector<RegionId> order;
  for (RegionId r(0); r < rep.region_count(); ++r) {
    verdicts.push_back(record::verdicts_of(attempts, of_region[r]));
    order.push_back(r);
  }
  std::stable_sort(order.begin(), order.end(), [&](RegionId x, RegionId y) {
    return record::rejected(verdicts[x]) > record::rejected(verdicts[y]);
  });
  report::Table t{"Regions, by the caps rejected there",
                  {"region", "pass", "lids", "floor", "attempts", "rejected", "reasons"}};
  for (const RegionId r : std::span(order).first(std::min(order.size(), kMaxRows))) {
    t.rows.push_back({group_digits(r), std::to_string(rep.layer(r) + 1), group_digits(rep.lids(r).size()),
                      group_digits(rep.floor(r).size()), group_digits(of_region[r].size()),
                      group_digits(record::rejected(verdicts[r])), trace::rejection_text(verdicts[r])});
    t.targets.push_back("region 0 " + std::to_string(r));
  }
  t.note =
      "Attempts: caps that could have covered a vertex that the region covers. A click selects the region and lists them.";
  if (order.size() > kMaxRows)
    t.note += " The first " + std::to_string(kMaxRows) + " of " + group_digits(order.size()) + " regions.";
  return t;
}

report::Chart chart_of(const trace::Chart& chart, const char* title, const char* y, report::Line line) {
  report::Chart out{title, {std::string(chart.x_name)}, {y}};
  for (const trace::Series& s : chart.series)
    out.series.push_back({std::string(s.name), chart.x, s.values, {line}});
  return out;
}

}  // namespace

std::string_view meaning_of(CapVerdict verdict) {
  return kMeanings[static_cast<std::size_t>(verdict)];
}

void add_construction(report::Document& doc, const frames::RecordedRun& p) {
  const Passes passes = trace::passes_of(*p.trace);
  const auto made = std::count_if(passes.begin(), passes.end(), [](const auto& s) { return s.regions > 0; });
  doc.number({"Passes", std::to_string(made),
              std::to_string(passes.size() - static_cast<std::size_t>(made)) + " more without effect"});
  const auto caps = trace::caps_of(passes);
  std::uint64_t rejected = 0;
  for (std::size_t v = 1; v < caps.size(); ++v) rejected += caps[v];
  const bool tried = caps[0] + rejected > 0;
  if (tried) doc.number({"Caps", group_digits(caps[0]), group_digits(rejected) + " rejected"});
  report::Chart front =
      chart_of(trace::chart_over_construction(*p.trace), "The front, from the body to the outermost wrapper",
               "faces", report::Line::steps);
  front.cursor = report::Cursor::event;
  doc.chart(front);
  if (tried) {
    doc.chart(chart_of(trace::chart_over_passes(*p.trace), "Caps by pass", "caps", report::Line::straight));
  }
  doc.tab("Passes").table(pass_table(passes));
  if (tried) doc.tab("Caps").table(rejection_table(passes));
  if (p.reps[0]->region_count() > 0) doc.tab("Regions").table(region_table(p));
}

namespace {

report::Chart steps_chart(const trace::Trace& trace) {
  report::Ends distance("distance"), depth("depth");
  for (const trace::Step& step : trace.steps) {
    const trace::StepResult& r = step.result;
    if (r.distance) distance.add(step.index, r.distance->lower, r.distance->upper);
    if (r.clash && r.clash->depth) depth.add(step.index, (*r.clash->depth)[0], (*r.clash->depth)[1]);
  }
  report::Chart chart{"Distance and depth by step", {"step"}, {kLength}, {}, {}, report::Cursor::step};
  distance.move_to(chart);
  depth.move_to(chart);
  return chart;
}

report::Chart history_chart(const std::vector<Bounds>& history, const std::string& what, std::uint32_t step) {
  report::Ends ends(what, report::Line::steps);
  for (const Bounds& b : history) ends.add(static_cast<double>(b.work), b.lower, b.upper);
  report::Chart chart{
      "Convergence of the " + what + " bounds, step " + std::to_string(step), {"work"}, {kLength}};
  ends.move_to(chart);
  return chart;
}

report::Chart search_chart(const trace::MeasuredApproach& search) {
  report::Ends distance("distance");
  for (const ContactBounds& b : search.history) {
    const double percent = 100 * b.t0;
    if (distance.lower.x.empty() || percent > distance.lower.x.back())
      distance.add(percent, b.lower, b.upper);
  }
  report::Chart chart{"Search for the first contact",
                      {"proven collision-free part of the path, percent"},
                      {"distance there"},
                      {},
                      "A point for each stage of the search."};
  distance.move_to(chart);
  return chart;
}

}  // namespace

std::vector<report::Chart> measure_charts(const trace::Trace& trace) {
  std::vector<report::Chart> out;
  const trace::Step *of_distance = nullptr, *of_depth = nullptr;
  std::size_t max_distance = 1, max_depth = 1;  // a curve has two points at least
  for (const trace::Step& step : trace.steps) {
    const trace::StepResult& r = step.result;
    if (r.distance && r.distance->history.size() > max_distance) {
      of_distance = &step;
      max_distance = r.distance->history.size();
    }
    if (r.clash && r.clash->history.size() > max_depth) {
      of_depth = &step;
      max_depth = r.clash->history.size();
    }
  }
  const bool measured =
      was_measured(trace, &trace::StepResult::distance) || was_measured(trace, &trace::StepResult::clash);
  if (measured && trace.steps.size() > 1) out.push_back(steps_chart(trace));
  if (of_distance != nullptr)
    out.push_back(history_chart(of_distance->result.distance->history, "distance", of_distance->index));
  if (of_depth != nullptr)
    out.push_back(history_chart(of_depth->result.clash->history, "depth", of_depth->index));
  if (trace.header.first_contact && trace.header.first_contact->history.size() > 1)
    out.push_back(search_chart(*trace.header.first_contact));
  std::erase_if(out, [](const report::Chart& c) { return c.series.empty(); });
  return out;
}

}  // namespace lrb::run

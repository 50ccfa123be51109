#include "scenarios/compare/compare.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <tuple>
#include <unordered_map>

#include "render/pictures/panel.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/record/attempts.hpp"
#include "scenarios/run/run_scenario.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/divergence.hpp>

namespace lrb::compare {
namespace {

/// Compared properties of a region.
struct RegionFacts {
  std::uint32_t lids = 0, floor = 0;
  double bound = 0;   ///< proven maximum deviation of its lids from the body, mesh units
  double volume = 0;  ///< 2D: area
  std::uint32_t attempts = 0;
  record::VerdictCounts verdicts{};  ///< of the attempts

  bool operator==(const RegionFacts&) const = default;
};

/// Two LRB-reps of one body compared by region.
struct RegionComparison {
  RegionMatching matching;
  std::array<std::vector<RegionFacts>, 2> facts;  ///< by region
  std::vector<std::size_t> different;       ///< pairs whose facts differ, by descending real faces in common
  std::array<std::uint32_t, 2> rejected{};  ///< caps in all
  bool has_attempts = false;                ///< both runs are constructions by the builder
};

using render::group_digits;
using render::short_number;

/// The regions above each real face: from the body outward along parents, and those without any along parents
/// above the regions that they touch, so that every region has real faces below it.
class RegionsAbove {
 public:
  explicit RegionsAbove(const LrbRep& rep) : rep_(rep), more_(rep.region_count()) {
    std::vector<bool> is_above(rep.region_count(), false);
    for (FaceId f(0); f < rep.real_face_count(); ++f)
      for (CellId c = rep.outer_cell(f); is_region(c); c = rep.parent(c.as_region()))
        is_above[c.as_region()] = true;
    for (RegionId r(0); r < rep.region_count(); ++r) {
      if (is_above[r]) continue;
      for (const FaceId f : rep.floor(r))
        if (const CellId beneath = rep.inner_cell(f); is_region(beneath))
          more_[beneath.as_region()].push_back(r);
    }
  }

  /// Returns those of a face; valid until the next call.
  const std::vector<RegionId>& of(FaceId face) {
    found_.clear();
    for (CellId c = rep_.outer_cell(face); is_region(c); c = rep_.parent(c.as_region()))
      found_.push_back(c.as_region());
    for (std::size_t i = 0; i < found_.size(); ++i)
      for (const RegionId r : more_[found_[i]])
        if (std::find(found_.begin(), found_.end(), r) == found_.end()) found_.push_back(r);
    return found_;
  }

 private:
  const LrbRep& rep_;
  std::vector<std::vector<RegionId>> more_;
  std::vector<RegionId> found_;
};

/// The real faces below the regions of two bodies with the same real faces.
struct Below {
  std::array<std::vector<std::uint32_t>, 2> each;           ///< number, by region
  std::unordered_map<std::uint64_t, std::uint32_t> common;  ///< number below both of two regions, by key()

  static std::uint64_t key(RegionId x, RegionId y) { return std::uint64_t{x} << 32 | y; }
  static RegionId first_of(std::uint64_t key) { return RegionId(static_cast<std::uint32_t>(key >> 32)); }
  static RegionId second_of(std::uint64_t key) { return RegionId(static_cast<std::uint32_t>(key)); }
};

Below below_regions(const LrbRep& x, const LrbRep& y) {
  Below out{{std::vector<std::uint32_t>(x.region_count()), std::vector<std::uint32_t>(y.region_count())}, {}};
  RegionsAbove above_x(x), above_y(y);
  for (FaceId f(0); f < x.real_face_count(); ++f) {
    const std::vector<RegionId>&of_x = above_x.of(f), &of_y = above_y.of(f);
    for (const RegionId s : of_y) ++out.each[1][s];
    for (const RegionId r : of_x) {
      ++out.each[0][r];
      for (const RegionId s : of_y) ++out.common[Below::key(r, s)];
    }
  }
  return out;
}

std::vector<RegionFacts> facts_of(const record::Recording& run, std::span<const record::Attempt> attempts) {
  const LrbRep& rep = run.bodies[0].rep;
  std::vector<RegionFacts> out(rep.region_count());
  const auto of_region = record::attempts_by_region(run.trace, rep, attempts);
  for (const bodies::RegionFigures& f : bodies::region_figures(rep, bodies::RegionOrder::waste, 1))
    out[f.region] = {f.lids,
                     f.floor,
                     f.thickness,
                     f.volume,
                     static_cast<std::uint32_t>(of_region[f.region].size()),
                     record::verdicts_of(attempts, of_region[f.region])};
  return out;
}

/// Returns "12 | 9", or the number once if both are the same.
std::string both(const std::string& x, const std::string& y) {
  return x == y ? x : x + " | " + y;
}
std::string both(std::uint32_t x, std::uint32_t y) {
  return both(group_digits(x), group_digits(y));
}

/// Returns a table of the regions that differ: those at the same place in both, then those of one alone. A
/// row's target selects the regions in both views.
report::Table region_table(const RegionComparison& c, const Runs& runs) {
  constexpr std::size_t kMaxRows = 300;
  report::Table t{"Regions that differ",
                  {"region, " + runs.names[0], "region, " + runs.names[1], "overlap", "real faces", "lids",
                   "floor", "bound", "volume"}};
  if (c.has_attempts)
    for (const std::string& name : runs.names) t.columns.push_back("rejected, " + name);
  std::size_t count = 0;
  const auto add = [&](const std::array<std::optional<RegionId>, 2>& of, const MatchedRegions* match) {
    if (++count > kMaxRows) return;
    std::array<const RegionFacts*, 2> facts{};
    std::string target = "regions";
    std::vector<std::string> row;
    for (std::size_t i = 0; i < 2; ++i) {
      if (of[i]) facts[i] = &c.facts[i][*of[i]];
      row.push_back(of[i] ? group_digits(*of[i]) : "");
      target += " " + (of[i] ? std::to_string(*of[i]) : std::string("-"));
    }
    const RegionFacts &x = *(facts[0] != nullptr ? facts[0] : facts[1]),
                      &y = *(facts[1] != nullptr ? facts[1] : facts[0]);
    row.push_back(match != nullptr ? render::percent(match->overlap()) : "");
    row.push_back(match != nullptr ? both(match->below[0], match->below[1]) : "");
    row.insert(row.end(), {both(x.lids, y.lids), both(x.floor, y.floor),
                           both(short_number(x.bound), short_number(y.bound)),
                           both(short_number(x.volume), short_number(y.volume))});
    if (c.has_attempts)
      for (const RegionFacts* f : facts)
        row.push_back(f != nullptr ? trace::rejection_text(f->verdicts) : "");
    t.rows.push_back(std::move(row));
    t.targets.push_back(target);
  };
  for (const std::size_t i : c.different) {
    const MatchedRegions& m = c.matching.pairs[i];
    add({m.of[0], m.of[1]}, &m);
  }
  for (const RegionId r : c.matching.unmatched[0]) add({r, std::nullopt}, nullptr);
  for (const RegionId r : c.matching.unmatched[1]) add({std::nullopt, r}, nullptr);
  t.note =
      "Two regions are at the same place if at least half of the real faces below either are below both; "
      "overlap is that share. A cell with two numbers has that of " +
      runs.names[0] + " first. Bound: proven largest deviation of the lids from the body, mesh units.";
  if (count > kMaxRows)
    t.note += " The first " + std::to_string(kMaxRows) + " of " + group_digits(count) + ".";
  return t;
}

}  // namespace

bool same_real_faces(const LrbRep& x, const LrbRep& y) {
  if (x.dim() != y.dim() || x.real_face_count() != y.real_face_count()) return false;
  for (FaceId f(0); f < x.real_face_count(); ++f) {
    const auto p = x.face(f), q = y.face(f);
    if (p.size() != q.size()) return false;
    for (std::size_t k = 0; k < p.size(); ++k)
      if (p[k] != q[k] || x.vertices()[p[k]] != y.vertices()[q[k]]) return false;
  }
  return true;
}

RegionMatching match_regions(const LrbRep& x, const LrbRep& y) {
  const Below below = below_regions(x, y);
  std::vector<MatchedRegions> found;
  for (const auto& [key, common] : below.common) {
    const RegionId r = Below::first_of(key), s = Below::second_of(key);
    const MatchedRegions m{{r, s}, common, {below.each[0][r], below.each[1][s]}};
    if (m.overlap() >= kSamePlace) found.push_back(m);
  }
  // A region and the one above it may have the same real faces below them: then depths decide.
  const auto order = [&](const MatchedRegions& m) {
    const int depths = static_cast<int>(x.depth(m.of[0])) - static_cast<int>(y.depth(m.of[1]));
    return std::tuple(-m.overlap(), std::abs(depths), m.of[0], m.of[1]);
  };
  std::sort(found.begin(), found.end(),
            [&](const MatchedRegions& m, const MatchedRegions& n) { return order(m) < order(n); });
  RegionMatching out;
  std::array<std::vector<bool>, 2> taken = {std::vector<bool>(x.region_count()),
                                            std::vector<bool>(y.region_count())};
  for (const MatchedRegions& m : found) {
    if (taken[0][m.of[0]] || taken[1][m.of[1]]) continue;
    taken[0][m.of[0]] = taken[1][m.of[1]] = true;
    out.pairs.push_back(m);
  }
  std::sort(out.pairs.begin(), out.pairs.end(),
            [](const MatchedRegions& m, const MatchedRegions& n) { return m.of[0] < n.of[0]; });
  for (std::size_t i = 0; i < 2; ++i)
    for (std::uint32_t r = 0; r < taken[i].size(); ++r)
      if (!taken[i][r]) out.unmatched[i].emplace_back(r);
  return out;
}

namespace {

/// Compares the regions of two runs of one body; nullopt if the bodies have different real faces, or none of
/// them has a region.
std::optional<RegionComparison> compare_regions(const Runs& runs) {
  const LrbRep &x = runs.of[0]->bodies[0].rep, &y = runs.of[1]->bodies[0].rep;
  if (x.region_count() + y.region_count() == 0 || !same_real_faces(x, y)) return std::nullopt;
  RegionComparison out;
  out.matching = match_regions(x, y);
  out.has_attempts = true;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<record::Attempt> attempts = record::attempts_of(runs.of[i]->trace);
    out.facts[i] = facts_of(*runs.of[i], attempts);
    out.rejected[i] = static_cast<std::uint32_t>(
        std::count_if(attempts.begin(), attempts.end(), std::mem_fn(&record::Attempt::rejected)));
    out.has_attempts = out.has_attempts && !attempts.empty();
  }
  const auto& pairs = out.matching.pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!(out.facts[0][pairs[i].of[0]] == out.facts[1][pairs[i].of[1]])) out.different.push_back(i);
  std::stable_sort(out.different.begin(), out.different.end(),
                   [&](std::size_t p, std::size_t q) { return pairs[p].common > pairs[q].common; });
  return out;
}

/// Returns the comparison in numbers.
std::string regions_sentence(const RegionComparison& c, const Runs& runs) {
  const auto& [pairs, unmatched] = c.matching;
  std::string out = group_digits(c.facts[0].size()) + " in " + runs.names[0] + ", " +
                    group_digits(c.facts[1].size()) + " in " + runs.names[1] +
                    ". By place, that is by the real " + "faces below them, " + group_digits(pairs.size()) +
                    " are in both (" + group_digits(c.different.size()) +
                    (c.different.size() == 1 ? " differs" : " differ") + "), " +
                    group_digits(unmatched[0].size()) + " only in " + runs.names[0] + ", " +
                    group_digits(unmatched[1].size()) + " only in " + runs.names[1] + ".";
  if (!c.has_attempts) return out;
  out += " Rejected caps:";
  for (std::size_t i = 0; i < 2; ++i)
    out += " " + group_digits(c.rejected[i]) + " in " + runs.names[i] + (i == 0 ? "," : ".");
  return out;
}

const LrbRep& rep_of(const Runs& runs, std::size_t i) {
  return runs.of[i]->bodies[0].rep;
}

/// Returns the chart with the curve of the number of faces.
trace::Chart chart_of_faces(const trace::Trace& trace) {
  return trace.header.construction ? trace::chart_over_construction(trace) : trace::chart_over_events(trace);
}

bool of_one_body(const Runs& runs) {
  return runs.of[0]->bodies.size() == 1 && runs.of[1]->bodies.size() == 1;
}

/// Returns a table of both LRB-reps: faces, regions, layers, outermost wrapper.
report::Table body_table(const Runs& runs) {
  report::Table t{
      "The LRB-reps",
      {"run", "real faces", "faces for each", "regions", "layers", "outermost wrapper", "events"}};
  for (std::size_t i = 0; i < 2; ++i) {
    const LrbRep& rep = rep_of(runs, i);
    t.rows.push_back({runs.names[i], group_digits(rep.real_face_count()),
                      short_number(static_cast<double>(rep.face_count()) / rep.real_face_count()),
                      group_digits(rep.region_count()), std::to_string(rep.layer_count()),
                      group_digits(rep.outermost_faces().size()),
                      group_digits(runs.of[i]->trace.events.size())});
  }
  return t;
}

/// Returns the results of each pass of two constructions; a table without rows for other runs.
report::Table pass_table(const Runs& runs) {
  report::Table t{"Passes", {"pass"}};
  for (const char* what : {"stage", "faces", "regions", "caps"})
    for (const std::string& name : runs.names) t.columns.push_back(std::string(what) + ", " + name);
  const std::array<std::vector<trace::PassSummary>, 2> passes = {trace::passes_of(runs.of[0]->trace),
                                                                 trace::passes_of(runs.of[1]->trace)};
  for (std::size_t k = 0; k < std::max(passes[0].size(), passes[1].size()); ++k) {
    t.rows.push_back({std::to_string(k + 1)});
    for (const auto text : {+[](const trace::PassSummary& p) { return std::string(name_of(p.stage)); },
                            +[](const trace::PassSummary& p) { return group_digits(p.faces_after); },
                            +[](const trace::PassSummary& p) { return group_digits(p.regions); },
                            +[](const trace::PassSummary& p) { return group_digits(p.accepted()); }})
      for (const auto& of : passes) t.rows.back().push_back(k < of.size() ? text(of[k]) : "");
  }
  t.note = "Faces: of the front after the pass. Passes that built nothing are counted.";
  return t;
}

/// Returns the number of faces of front or wrapper by event, for both runs.
report::Chart faces_chart(const Runs& runs) {
  const bool built = runs.of[0]->trace.header.construction;
  report::Chart c{built ? "The front by event" : "The wrapper by event", {"event"}, {"faces"}};
  for (std::size_t i = 0; i < 2; ++i) {
    trace::Chart chart = chart_of_faces(runs.of[i]->trace);
    for (trace::Series& s : chart.series)
      if (s.unit == "faces" && std::any_of(s.values.begin(), s.values.end(), [](double v) { return v > 0; }))
        c.series.push_back({runs.names[i], chart.x, std::move(s.values), {report::Line::steps}});
  }
  return c;
}

/// Draws both wrappers after the last event, coloured by region, through the same camera.
render::Image draw_bodies(const Runs& runs, const record::ProgressReport& progress) {
  pictures::Framing framing{{}, {}, rep_of(runs, 0).dim()};
  for (std::size_t i = 0; i < 2; ++i)
    for (const Eigen::Vector3d& x : render::body_points(rep_of(runs, i), runs.of[i]->trace.steps[0].pose_a))
      framing.points.push_back(x);
  std::vector<render::Panel> panels;
  for (std::size_t i = 0; i < 2; ++i) {
    const trace::Trace& trace = runs.of[i]->trace;
    pictures::FrameSpec frame = runs.scenarios[i]->frames;
    frame.colour_by = pictures::FrameSpec::ColourBy::region;
    panels.push_back(panel_after(run::recorded_run_of(*runs.scenarios[i], *runs.of[i]), std::move(frame),
                                 static_cast<trace::EventId>(trace.events.size() - 1), runs.names[i], framing,
                                 progress));
  }
  return in_a_row(panels);
}

constexpr const char* kPicture = "compare.png";
constexpr std::size_t kMaxSteps = 200;

/// Returns the first event of a step that differs.
std::optional<std::string> different_event(const Runs& runs) {
  const trace::Trace &x = runs.of[0]->trace, &y = runs.of[1]->trace;
  for (std::size_t step = 0; step < step_count(runs); ++step) {
    const auto p = x.events_of(step), q = y.events_of(step);
    const std::size_t both = std::min(p.size(), q.size());
    for (std::size_t i = 0; i < both; ++i)
      if (!(p[i] == q[i]))
        return "step " + std::to_string(x.steps[step].index) + ", event " + std::to_string(i) +
               " of the step: \"" + describe(p[i]) + "\" in " + runs.names[0] + ", \"" + describe(q[i]) +
               "\" in " + runs.names[1];
    if (p.size() != q.size())
      return "step " + std::to_string(x.steps[step].index) + ": " + group_digits(p.size()) + " events in " +
             runs.names[0] + ", " + group_digits(q.size()) + " in " + runs.names[1];
  }
  return {};
}

report::Table steps_table(const Runs& runs) {
  report::Table t{"Steps", {"step", "answer"}};
  for (const char* what : {"pairs", "face tests", "box tests"})
    for (const std::string& name : runs.names) t.columns.push_back(std::string(what) + ", " + name);
  for (std::size_t i = 0; i < std::min(step_count(runs), kMaxSteps); ++i) {
    const trace::Step &x = runs.of[0]->trace.steps[i], &y = runs.of[1]->trace.steps[i];
    const bool same = x.result.relation == y.result.relation && x.result.fingerprint == y.result.fingerprint;
    t.rows.push_back({std::to_string(x.index), same ? std::string(to_string(x.result.relation))
                                                    : std::string(to_string(x.result.relation)) + " / " +
                                                          to_string(y.result.relation) +
                                                          ", NOT the same pairs"});
    std::vector<std::string>& row = t.rows.back();
    for (const auto value : {+[](const trace::Step& s) { return s.result.pair_count; },
                             +[](const trace::Step& s) { return s.result.counters.face_tests; },
                             +[](const trace::Step& s) { return s.result.counters.box_tests; }})
      for (const trace::Step* s : {&x, &y}) row.push_back(group_digits(value(*s)));
  }
  if (step_count(runs) > kMaxSteps) t.note = "The first " + std::to_string(kMaxSteps) + " steps.";
  return t;
}

void check_runs(const Runs& runs) {
  const std::size_t one = runs.of[0]->bodies.size(), other = runs.of[1]->bodies.size();
  if (one != other)
    throw InputError(runs.names[one == 1 ? 0 : 1] + ": is a run of one body, and " +
                     runs.names[one == 1 ? 1 : 0] + " of two");
  if (step_count(runs) == 0) throw InputError("there is no step that both runs have");
}

std::optional<std::string> first_difference(const Runs& runs) {
  const std::optional<trace::Divergence> first =
      trace::first_divergence(runs.of[0]->trace, runs.of[1]->trace);
  const std::string cut = cut_words(runs);
  if (!first && cut.empty()) return {};
  if (!first) return "none among the events that were stored. " + cut;
  if (first->step) return first->message();
  const std::optional<std::string> event = different_event(runs);
  return first->message() + (event ? "; " + *event : std::string("; all events are the same"));
}

/// Returns the views of both runs' pages for a page in `folder`; empty if one of them has no page.
std::vector<report::View> views_of(const Runs& runs, const std::string& folder) {
  std::vector<report::View> out;
  for (std::size_t i = 0; i < 2; ++i) {
    std::error_code error;
    const std::filesystem::path page = std::filesystem::absolute(runs.pages[i], error).lexically_normal();
    if (runs.pages[i].empty() || !std::filesystem::is_regular_file(page, error)) return {};
    const std::filesystem::path from = std::filesystem::absolute(folder, error).lexically_normal();
    out.push_back({runs.names[i], io::url_path(page.lexically_relative(from).generic_string())});
  }
  return out;
}

}  // namespace

Difference write_comparison(const Runs& runs, const std::string& command, const std::string& folder,
                            const record::ProgressReport& progress) {
  check_runs(runs);
  reject_folder_of_run(folder);
  const bool alone = of_one_body(runs);
  const std::size_t step = alone ? 0 : busiest_step(runs);
  const render::Image picture = alone ? draw_bodies(runs, progress) : draw(runs, step, progress);
  Difference out{first_difference(runs), {}};
  const std::optional<std::string>& difference = out.first;
  report::Document doc(runs.names[0] + " and " + runs.names[1],
                       alone ? "Two recorded runs of one body each." : "Two recorded runs, step by step.");
  if (const std::string cut = cut_words(runs); !cut.empty()) doc.purpose(cut);
  doc.verdict(difference ? "differ" : "the same").command(command).version(runs.of[0]->trace.header.lrbscope);
  doc.text({"First difference", difference.value_or("None: all events and answers are the same.")});
  doc.views(views_of(runs, folder));
  if (alone) {
    doc.chart(faces_chart(runs)).table(body_table(runs));
    if (const report::Table passes = pass_table(runs); !passes.rows.empty()) doc.table(passes);
    if (const auto regions = compare_regions(runs)) {
      out.regions = "regions: " + regions_sentence(*regions, runs) + "\n";
      doc.text({"Regions", regions_sentence(*regions, runs)});
      if (const report::Table t = region_table(*regions, runs); !t.rows.empty()) doc.table(t);
    } else if (rep_of(runs, 0).region_count() + rep_of(runs, 1).region_count() > 0) {
      out.regions = "regions are not compared: the bodies' own faces differ\n";
      doc.text({"Regions", "Not compared: the bodies' own faces differ."});
    }
    doc.picture(kPicture, picture, "After the last event", "Coloured by region, seen by one camera.");
  } else {
    add_work_charts(doc, runs);
    doc.table(totals_of(runs)).table(steps_table(runs));
    doc.picture(
        kPicture, picture, "Work by face, step " + std::to_string(runs.of[0]->trace.steps[step].index),
        "Both runs on one scale, seen by one camera; and their difference, face by face, where the bodies have the "
        "same faces. Pale: less than a fiftieth of the maximum.");
  }
  doc.write(folder);
  return out;
}

}  // namespace lrb::compare

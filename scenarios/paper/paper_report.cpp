#include "scenarios/paper/paper_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/paper/paper_pictures.hpp"
#include "scenarios/paper/sweep.hpp"
#include "scenarios/paper/tables.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::paper {
namespace {

constexpr double kBinWidth = 250;  // comparisons

/// Figure 3.1: the other object's size (real and pseudo faces, log axis) against comparisons: minimum,
/// average and maximum, measured with the paper's recursion and as published.
report::Chart figure_3_1(std::span<const ObjectRow> rows) {
  constexpr double kBeside = 1.06;  // factor by which published bars are shifted to the right of the measured
                                    // ones
  report::Series measured{"measured: average, minimum, maximum", {}, {}},
      paper{"published", {}, {}, {report::Line::dashed}};
  const auto add = [](report::Series& s, double size, double average, double min, double max) {
    s.x.push_back(size);
    s.y.push_back(average);
    s.low.push_back(min);
    s.high.push_back(max);
  };
  report::Axis sizes{"the other object: its real and pseudo faces", true, 80, 90000};
  for (const ObjectRow& row : rows) {
    const Spread& s = row.recursions[kPaper].comparisons;
    add(measured, row.total_faces, s.average, s.min, s.max);
    if (const PublishedRow* p = published(row.object))
      add(paper, row.total_faces * kBeside, p->average, p->min, p->max);
    sizes.ticks.push_back(
        {static_cast<double>(row.total_faces), row.object + ": " + std::to_string(row.total_faces)});
  }
  return {
      "Figure 3.1", sizes, {"face comparisons in a time step"}, {measured, paper}, "The paper's recursion."};
}

/// Figure 3.2: the number of time steps for each number of comparisons, a line for each object, with the
/// paper's recursion.
report::Chart figure_3_2(std::span<const ObjectRow> rows, std::span<const ContactStep> steps) {
  report::Chart chart{
      "Figure 3.2",
      {"face comparisons in a time step (bins of " + io::fixed_text(kBinWidth) + ")", false, 0, 8000},
      {"time steps"},
      {},
      "The paper's recursion, a line for each object."};
  for (const ObjectRow& row : rows) {
    std::map<std::uint64_t, int> bins;
    for (const ContactStep& s : steps)
      if (s.object == row.object)
        ++bins[static_cast<std::uint64_t>(static_cast<double>(s.counts[kPaper].comparisons) / kBinWidth)];
    report::Series line{
        row.object + ": " + std::to_string(row.total_faces) + " faces", {}, {}, {{}, {}, "none"}};
    const std::uint64_t last = bins.empty() ? 0 : bins.rbegin()->first;
    for (std::uint64_t b = 0; b <= last; ++b) {
      line.x.push_back((static_cast<double>(b) + 0.5) * kBinWidth);
      line.y.push_back(bins[b]);
    }
    chart.series.push_back(std::move(line));
  }
  return chart;
}

const PaperObject& object_called(const PaperReport& r, const std::string& name) {
  return *std::find_if(r.objects.begin(), r.objects.end(),
                       [&](const PaperObject& o) { return o.name == name; });
}

std::string collision_text(const CloseUp& c) {
  return "number " + std::to_string(c.collision) + ", " + render::group_digits(c.comparisons) +
         " face tests in " + std::to_string(c.steps.size()) +
         (c.steps.size() == 1 ? " time step" : " time steps");
}

std::string heat_caption(const PaperPair& pair, const CloseUp& easiest, const CloseUp& hardest,
                         std::uint32_t collisions) {
  return "Face tests of each face of " + pair.a.name + " and of " + pair.x.name +
         " by the paper's recursion, in the easiest of their " + render::group_digits(collisions) +
         " collisions (" + collision_text(easiest) + ") and in the hardest (" + collision_text(hardest) +
         "). Each body is drawn alone, seen from the other one, as its wrapper after the last time step: lids that "
         "were not refined, and bare real faces. One logarithmic scale for all panels.";
}

std::string tree_caption(const PaperPair& pair, const CloseUp& c) {
  const ContactStep& step = c.steps[busiest_step(c)];
  return pair.a.name + " against " + pair.x.name + ", collision " + std::to_string(c.collision) +
         ", time step " + std::to_string(step.step) + " after the first contact, " +
         render::group_digits(step.counts[0].comparisons) +
         " face tests by the paper's recursion. A row is a depth, from the outermost wrapper down; a box is "
         "a "
         "region, under the one that hid it; at the ends, real faces, or all that a closed region hides. A "
         "box is as wide as the faces of the final wrapper in it are many. Open the file and point at a box "
         "to read what it is.";
}

struct CloseUps {
  PaperPair pair;
  CloseUp easiest, hardest;
};

/// Returns nullopt if the experiment does not report them.
std::optional<CloseUps> close_ups_of(const PaperReport& r) {
  if (!r.experiment.reports(PaperPart::heat_maps) && !r.experiment.reports(PaperPart::refinement_tree))
    return std::nullopt;
  const PaperPair pair{r.objects.front(), object_called(r, r.experiment.close_up)};
  const auto [least, most] = easiest_and_hardest(r.steps, pair.x.name);
  return CloseUps{pair, close_up(pair, least, r.experiment.protocol, r.steps),
                  close_up(pair, most, r.experiment.protocol, r.steps)};
}

}  // namespace

void check_records(const PaperReport& r) {
  for (const ContactStep& s : r.steps)
    if (s.collision >= r.experiment.protocol.collisions)
      throw InputError("the records hold collision " + std::to_string(s.collision) + " with " + s.object +
                       ", numbered from 0, but the experiment has " +
                       std::to_string(r.experiment.protocol.collisions) +
                       ": give the options that the records were made with, such as --collisions");
  static_cast<void>(close_ups_of(r));
}

namespace {

constexpr std::array<const char*, 3> kTitles = {"the paper's recursion, each pair of regions once",
                                                "the paper's recursion, each region once (strict)",
                                                "complete"};

/// Returns true if an object of the paper has exactly these numbers of faces.
bool as_published(const PaperObject& o) {
  const auto published = generators::paper_objects();
  return std::any_of(published.begin(), published.end(), [&](const generators::FractalSpec& p) {
    return p.name == o.name && p.real_faces == o.rep.real_face_count() && p.total_faces == o.rep.face_count();
  });
}

bool all_as_published(const PaperReport& r) {
  return std::all_of(r.objects.begin(), r.objects.end(), as_published);
}

report::Table table1(const PaperReport& r) {
  report::Table t{
      "Table 1: object sizes", {"object", "real faces", "total faces", "outermost wrapper"}, {}, {}};
  t.note = all_as_published(r)
               ? "Equal to the paper's, face by face: the generator is given its numbers. The bodies' shapes "
                 "are ours: the paper says only that they are fractal, with a basic non-convex shape."
               : "Not the paper's objects, or not all of them.";
  for (const PaperObject& o : r.objects)
    t.rows.push_back({o.name, render::group_digits(o.rep.real_face_count()),
                      render::group_digits(o.rep.face_count()),
                      render::counted(o.rep.outermost_faces().size(), "face", "faces")});
  return t;
}

report::Table table2(std::span<const ObjectRow> rows, std::size_t recursion) {
  report::Table t{std::string("Table 2, ") + kTitles[recursion],
                  {"A against", "steps", "minimum", "average", "maximum", "published min", "avg", "max",
                   "refinements (avg)", "pairs missed", "n log n", "n²"}};
  if (kRecursions[recursion] == Recursion::complete)
    t.columns.insert(t.columns.begin() + 9, "bound tests (avg)");
  for (const ObjectRow& row : rows) {
    const RecursionRow& x = row.recursions[recursion];
    const PublishedRow* p = published(row.object);
    std::vector<std::string> cells = {row.object, render::group_digits(row.steps), whole(x.comparisons.min),
                                      whole(x.comparisons.average), whole(x.comparisons.max)};
    for (const double n : {p ? p->min : 0, p ? p->average : 0, p ? p->max : 0})
      cells.push_back(p ? whole(n) : "–");
    cells.push_back(fixed(x.refinements.average, 1));
    if (kRecursions[recursion] == Recursion::complete) cells.push_back(whole(x.bound_tests));
    const auto all = static_cast<double>(x.pairs + x.missed);
    cells.push_back(all > 0 ? fixed(100 * static_cast<double>(x.missed) / all, 2) + " %" : "–");
    cells.push_back(whole(row.n_log_n));
    cells.push_back(whole(row.n_squared));
    t.rows.push_back(std::move(cells));
  }
  t.note = kRecursions[recursion] == Recursion::complete
               ? "Comparisons of triangles, exact; what decides before them are the bound tests. Nothing is "
                 "missed."
               : "Comparisons of faces, exact, over the time steps with a contact of real faces.";
  return t;
}

/// Returns the differences to the paper's setup that matter for a comparison.
std::vector<std::string> differences(const PaperReport& r, std::span<const ObjectRow> rows) {
  std::vector<std::string> out;
  if (!all_as_published(r))
    out.push_back("Not all objects are the paper's, so the published numbers are for others.");
  const RecursionRow &first = rows.front().recursions[0], &last = rows.back().recursions[0];
  std::string over;
  for (const ObjectRow& row : rows)
    if (const PublishedRow* p = published(row.object);
        p && row.recursions[0].comparisons.average > p->average)
      over += (over.empty() ? "" : ", ") + row.object;
  out.push_back(
      over.empty()
          ? "The averages of the paper's recursion are at or under the published ones for all objects."
          : "The averages of the paper's recursion are above the published ones for " + over + ".");
  std::string ratios;
  for (const ObjectRow& row : rows)
    if (const PublishedRow* p = published(row.object)) {
      const Spread& s = row.recursions[0].comparisons;
      ratios += (ratios.empty() ? "" : "; ") + row.object + " " + fixed(s.min / p->min, 2) + ", " +
                fixed(s.average / p->average, 2) + ", " + fixed(s.max / p->max, 2);
    }
  if (!ratios.empty() && all_as_published(r))
    out.push_back("Measured over published, minimum, average and maximum: " + ratios +
                  ". Minima and maxima are of single time steps, and differ from seed to seed (--seed).");
  out.push_back(
      "The length of a time step and the number of steps after the first contact are a choice of this "
      "program, because the paper names neither: deeper contact has more comparisons (--step, --steps-after).");
  if (first.comparisons.max > 0 && rows.size() > 1)
    out.push_back("From " + rows.front().object + " to " + rows.back().object + " the average grows " +
                  fixed(last.comparisons.average / first.comparisons.average, 2) +
                  "-fold (published: 2.18), the maximum " +
                  fixed(last.comparisons.max / first.comparisons.max, 2) +
                  "-fold (published: 3.57 to its highest row).");
  std::string missed;
  for (const ObjectRow& row : rows)
    missed += (missed.empty() ? "" : ", ") + row.object + " " +
              render::group_digits(row.recursions[0].missed) + "/" +
              render::group_digits(row.recursions[1].missed);
  out.push_back("Pairs that the paper's recursion misses, in its two readings: " + missed +
                ". The paper does not count misses.");
  out.push_back(
      "The shapes, the approach and the depth of contact are not in the paper; they decide the numbers as "
      "much as the algorithm does. See the protocol.");
  return out;
}

std::string protocol_text(const PaperProtocol& p) {
  return render::group_digits(p.collisions) +
         " collisions per object; random rotations of both bodies, equal diagonals; the "
         "other body comes in along a random line through both centres in steps of " +
         fixed(100 * p.step, 2) +
         " % of the diagonal; every step with a contact of real faces counts, from the first one through " +
         std::to_string(p.steps_after) + " more; seed " + std::to_string(p.seed) + ".";
}

report::Table time_table(const std::vector<std::pair<std::string, double>>& seconds) {
  report::Table t{"Running time", {"part", "seconds"}, {}, "Wall-clock time."};
  double sum = 0;
  for (const auto& [part, took] : seconds) {
    t.rows.push_back({part, fixed(took, 1)});
    sum += took;
  }
  t.rows.push_back({"together", fixed(sum, 1)});
  return t;
}

void add_markdown(std::string& md, const report::Table& t) {
  md += "\n## " + t.title + "\n\n|";
  for (const std::string& c : t.columns) md += " " + c + " |";
  md += "\n|";
  for (std::size_t i = 0; i < t.columns.size(); ++i) md += i == 0 ? " --- |" : " ---: |";
  for (const auto& row : t.rows) {
    md += "\n|";
    for (const std::string& c : row) md += " " + c + " |";
  }
  md += "\n\n" + t.note + "\n";
}

}  // namespace

std::vector<std::string> write_paper_report(const PaperReport& r, const report::Folder& folder) {
  const auto wants = [&](PaperPart part) { return r.experiment.reports(part); };
  const std::vector<ObjectRow> rows =
      r.experiment.collides() ? make_table(r.objects, r.steps) : std::vector<ObjectRow>();
  const std::string purpose =
      r.experiment.name != "paper"
          ? r.experiment.purpose
          : "C. Gonzalez-Ochoa, \"2-Body Collision Detection using LRB-reps\", tables 1 and 2 and figures 3.1 and "
            "3.2, measured beside the published numbers.";
  report::Document doc("The paper's experiment", purpose);
  doc.command(r.command);
  std::string md = "# " + doc.title() + "\n\n" + purpose + "\n\n", figures;
  if (!rows.empty()) {
    const std::string protocol = "Protocol: " + protocol_text(r.experiment.protocol);
    md += protocol + "\n\nMade by `" + r.command + "`.\n\n## Differences from the paper\n\n";
    report::Table remarks{"Differences from the paper", {"remark"}, {}, protocol};
    for (const std::string& s : differences(r, rows)) {
      md += "- " + s + "\n";
      remarks.rows.push_back({s});
    }
    doc.table(remarks);
  }
  const auto figure = [&](const std::string& title, const std::string& file, const std::string& caption) {
    figures += "\n## " + title + "\n\n![" + title + "](" + file + ")\n\n" + caption + "\n";
  };
  const auto chart = [&](const report::Chart& c, const std::string& name, const report::PrintLayout& layout) {
    if (!doc.chart(c).print(name, c.title, report::gnuplot({&c, 1}, layout)).empty())
      figure(c.title, name + ".svg", c.note);
  };
  if (wants(PaperPart::figure_3_1)) chart(figure_3_1(rows), "figure3-1", {1, 135, 85, 8, "top left"});
  if (wants(PaperPart::figure_3_2)) chart(figure_3_2(rows, r.steps), "figure3-2", {});
  std::vector<report::Table> tables;
  if (wants(PaperPart::table1)) tables.push_back(table1(r));
  if (wants(PaperPart::table2))
    for (std::size_t i = 0; i < kRecursions.size(); ++i) tables.push_back(table2(rows, i));
  if (r.series) {
    for (report::Table& t : add_series(*r.series, doc)) tables.push_back(std::move(t));
    if (doc.notes().empty())
      for (const char* name : {"series-comparisons", "series-time"})
        figures += std::string("\n![") + name + "](" + name + ".svg)\n";
  }
  if (!r.seconds.empty()) tables.push_back(time_table(r.seconds));
  for (const report::Table& t : tables) add_markdown(md, t);
  doc.each(tables, &report::Document::table);
  std::vector<std::string> notes = doc.notes();
  if (const std::optional<CloseUps> c = close_ups_of(r)) {
    if (wants(PaperPart::heat_maps)) try {
        const std::string title = "Face tests over the bodies",
                          caption =
                              heat_caption(c->pair, c->easiest, c->hardest, r.experiment.protocol.collisions);
        doc.picture("heat_maps.png", draw_heat_maps(c->pair, c->easiest, c->hardest), title, caption);
        figure(title, "heat_maps.png", caption);
      } catch (const EnvironmentError& e) {
        notes.push_back(std::string("heat maps were not drawn: ") + e.what());
      }
    if (wants(PaperPart::refinement_tree)) {
      const std::string title = "The refinement tree of one collision",
                        caption = tree_caption(c->pair, c->hardest);
      doc.picture("refinement_tree.svg", icicle_svg(c->pair, c->hardest), title, caption, true);
      figure(title, "refinement_tree.svg", caption);
    }
  }
  if (!rows.empty()) doc.file("records.jsonl", to_json_lines(r.steps), "every counted time step");
  doc.file("tables.json", tables_json(r.objects, rows, r.experiment.protocol), "both tables as data");
  doc.file("report.md", md + figures, "this report as Markdown").write(folder);
  return notes;
}

}  // namespace lrb::paper

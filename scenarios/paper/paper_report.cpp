#include "scenarios/paper/paper_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/paper/paper_pictures.hpp"
#include "scenarios/paper/sweep.hpp"
#include "scenarios/paper/tables.hpp"
#include "scenarios/report/document.hpp"
#include "scenarios/run/run_page.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::paper {
namespace {

constexpr double kBinWidth = 250;  // comparisons

// Okabe and Ito's colours, which people with any colour vision tell apart; dash and point types are told
// apart in grey, too.
constexpr const char* kColours[] = {"#0072B2", "#E69F00", "#009E73", "#D55E00",
                                    "#56B4E9", "#CC79A7", "#000000"};

}  // namespace

report::Gnuplot figure_3_1(std::span<const ObjectRow> rows) {
  constexpr double kBeside = 1.06;  // published bars stand to the right of ours by this factor
  const auto bar = [](double size, double average, double min, double max) {
    return io::fixed_text(size) + " " + io::fixed_text(average) + " " + io::fixed_text(min) + " " +
           io::fixed_text(max);
  };
  std::vector<std::string> measured, as_published, names;
  for (const ObjectRow& row : rows) {
    const Spread& s = row.recursions[kPaper].comparisons;
    measured.push_back(bar(row.total_faces, s.average, s.min, s.max));
    double top = s.max;
    if (const PublishedRow* p = published(row.object)) {
      as_published.push_back(bar(row.total_faces * kBeside, p->average, p->min, p->max));
      top = std::max(top, p->max);
    }
    names.push_back(io::fixed_text(row.total_faces) + " " + io::fixed_text(top) + " " +
                    report::gnuplot_data_text(row.object));
  }
  report::Gnuplot g;
  g.add_data("measured", measured);
  g.add_data("published", as_published);
  g.add_data("names", names);
  g.script += R"(set logscale x
set xrange [80:90000]
set yrange [0:*]
set offsets 0, 0, graph 0.05, 0
set xlabel 'size of the object that A meets: real and pseudo faces'
set ylabel 'face comparisons in a time step'
set key top left reverse Left
set grid y lc rgb '#dddddd'
set border 3
set tics nomirror out
plot $measured using 1:2:3:4 with yerrorbars lw 1.5 pt 7 ps 0.6 lc rgb '#0072B2' title 'measured: average, minimum, maximum', \
     $measured using 1:2 with lines lw 1.5 lc rgb '#0072B2' notitle, \
     $published using 1:2:3:4 with yerrorbars lw 1.5 pt 5 ps 0.6 lc rgb '#D55E00' title 'published', \
     $published using 1:2 with lines dt 2 lw 1.5 lc rgb '#D55E00' notitle, \
     $names using 1:2:3 with labels offset 0.3, 0.7 tc rgb '#555555' notitle
)";
  return g;
}

report::Gnuplot figure_3_2(std::span<const ObjectRow> rows, std::span<const ContactStep> steps) {
  report::Gnuplot g;
  std::string plot = "plot ";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::map<std::uint64_t, int> bins;
    for (const ContactStep& s : steps)
      if (s.object == rows[i].object)
        ++bins[static_cast<std::uint64_t>(static_cast<double>(s.counts[kPaper].comparisons) / kBinWidth)];
    std::vector<std::string> points;
    const std::uint64_t last = bins.empty() ? 0 : bins.rbegin()->first;
    for (std::uint64_t b = 0; b <= last; ++b)
      points.push_back(io::fixed_text((static_cast<double>(b) + 0.5) * kBinWidth) + " " +
                       std::to_string(bins[b]));
    g.add_data("object_" + rows[i].object, points);
    plot += (i > 0 ? ", " : "") + std::string("$object_") + rows[i].object +
            " using 1:2 with lines lw 1.5 dt " + std::to_string(i % 5 + 1) + " lc rgb '" +
            kColours[i % std::size(kColours)] + "' title " +
            report::gnuplot_text(rows[i].object + ": " + std::to_string(rows[i].total_faces) + " faces");
  }
  g.script += "set xlabel 'face comparisons in a time step (bins of " + io::fixed_text(kBinWidth) + ")'\n";
  g.script += R"(set ylabel 'time steps'
set xrange [0:8000]
set yrange [0:*]
set key top right
set grid y lc rgb '#dddddd'
set border 3
set tics nomirror out
)" + plot + "\n";
  return g;
}

namespace {

const PaperObject& object_called(const PaperReport& r, const std::string& name) {
  return *std::find_if(r.objects.begin(), r.objects.end(),
                       [&](const PaperObject& o) { return o.name == name; });
}

std::string collision_words(const CloseUp& c) {
  return "number " + std::to_string(c.collision) + ", " + render::group_digits(c.comparisons) +
         " face tests in " + std::to_string(c.steps.size()) +
         (c.steps.size() == 1 ? " time step" : " time steps");
}

std::string heat_caption(const PaperPair& pair, const CloseUp& easiest, const CloseUp& hardest,
                         std::uint32_t collisions) {
  return "Face tests of each face of " + pair.a.name + " and of " + pair.x.name +
         " by the paper's recursion, in the easiest of their " + render::group_digits(collisions) +
         " collisions (" + collision_words(easiest) + ") and in the hardest (" + collision_words(hardest) +
         "). Each body stands alone, seen from where the other one is, as the wrapper that the last time "
         "step "
         "left of it: lids that stayed closed, and bare real faces. One logarithmic scale for all panels.";
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

/// Returns nothing if the experiment does not report them.
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

void draw_close_ups(const PaperReport& r, const std::string& folder, report::Page& page,
                    std::vector<std::string>& notes) {
  const std::optional<CloseUps> c = close_ups_of(r);
  if (!c) return;
  if (r.experiment.reports(PaperPart::heat_maps)) try {
      render::write_png(draw_heat_maps(c->pair, c->easiest, c->hardest), folder + "/heat_maps.png");
      run::add_figure(page, folder, "Face tests over the bodies",
                      heat_caption(c->pair, c->easiest, c->hardest, r.experiment.protocol.collisions),
                      "heat_maps.png");
    } catch (const EnvironmentError& e) {
      notes.push_back(std::string("heat maps were not drawn: ") + e.what());
    }
  if (r.experiment.reports(PaperPart::refinement_tree)) {
    io::write_text(folder + "/refinement_tree.svg", icicle_svg(c->pair, c->hardest));
    run::add_live_figure(page, folder, "The refinement tree of one collision",
                         tree_caption(c->pair, c->hardest), "refinement_tree.svg");
  }
}

namespace {

constexpr std::array<const char*, 3> kTitles = {"the paper's recursion, each pair of regions once",
                                                "the paper's recursion, each region once (strict)",
                                                "complete"};

/// Returns true if an object of the paper has these very numbers of faces.
bool as_published(const PaperObject& o) {
  const auto published = generators::paper_objects();
  return std::any_of(published.begin(), published.end(), [&](const generators::FractalSpec& p) {
    return p.name == o.name && p.real_faces == o.rep.real_face_count() && p.total_faces == o.rep.face_count();
  });
}

bool all_as_published(const PaperReport& r) {
  return std::all_of(r.objects.begin(), r.objects.end(), as_published);
}

report::PageTable table1(const PaperReport& r) {
  report::PageTable t{
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

report::PageTable table2(std::span<const ObjectRow> rows, std::size_t recursion) {
  report::PageTable t;
  t.title = std::string("Table 2, ") + kTitles[recursion];
  t.columns = {"A against", "steps", "minimum",           "average",      "maximum", "published min",
               "avg",       "max",   "refinements (avg)", "pairs missed", "n log n", "n²"};
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

/// Returns what a reader must know before comparing.
std::vector<std::string> differences(const PaperReport& r, std::span<const ObjectRow> rows) {
  std::vector<std::string> out;
  if (!all_as_published(r))
    out.push_back("Not the paper's objects, or not all of them: what is published is of its own.");
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

report::PageTable time_table(const std::vector<std::pair<std::string, double>>& seconds) {
  report::PageTable t{"What it took", {"part", "seconds"}, {}, "Of the clock on the wall."};
  double sum = 0;
  for (const auto& [part, took] : seconds) {
    t.rows.push_back({part, fixed(took, 1)});
    sum += took;
  }
  t.rows.push_back({"together", fixed(sum, 1)});
  return t;
}

void add_markdown(std::string& md, const report::PageTable& t) {
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

report::PageChart sizes_chart(std::span<const ObjectRow> rows) {
  report::PageChart sizes{"Object size against comparisons",
                          "real and pseudo faces of the other object",
                          "comparisons",
                          "Figure 3.1: the paper's recursion, measured and published.",
                          {},
                          report::PageCursor::none,
                          true,
                          false,
                          false,
                          false};
  report::PageSeries measured{"measured average", {}, {}}, most{"measured maximum", {}, {}},
      paper{"published average", {}, {}}, paper_most{"published maximum", {}, {}};
  for (const ObjectRow& row : rows) {
    const double size = row.total_faces;
    measured.x.push_back(size);
    measured.y.push_back(row.recursions[0].comparisons.average);
    most.x.push_back(size);
    most.y.push_back(row.recursions[0].comparisons.max);
    if (const PublishedRow* p = published(row.object)) {
      paper.x.push_back(size);
      paper.y.push_back(p->average);
      paper_most.x.push_back(size);
      paper_most.y.push_back(p->max);
    }
  }
  sizes.series = {measured, paper, most, paper_most};
  return sizes;
}

/// Draws figures 3.1 and 3.2, as far as they are wanted and gnuplot is there.
void draw_charts(const PaperReport& r, std::span<const ObjectRow> rows, const std::string& folder,
                 report::Page& page, std::vector<std::string>& notes) {
  struct Figure {
    PaperPart part;
    const char *name, *title, *caption;
  };
  for (const Figure& f :
       {Figure{PaperPart::figure_3_1, "figure3-1", "Figure 3.1",
               "Size of the object that A meets, real and pseudo faces, against face comparisons in a time "
               "step by the paper's recursion: average, minimum and maximum, measured and published."},
        Figure{PaperPart::figure_3_2, "figure3-2", "Figure 3.2",
               "In how many time steps so many face comparisons were needed by the paper's recursion, a line "
               "for each object."}}) {
    if (!r.experiment.reports(f.part)) continue;
    if (!report::has_gnuplot()) {
      notes.push_back(std::string(f.title) + " was not drawn: gnuplot is missing (Debian: gnuplot-nox)");
      continue;
    }
    const report::Gnuplot chart =
        f.part == PaperPart::figure_3_1 ? figure_3_1(rows) : figure_3_2(rows, r.steps);
    for (const char* ending : {".svg", ".png"}) report::draw(chart, folder + "/" + f.name + ending);
    run::add_figure(page, folder, f.title, f.caption, std::string(f.name) + ".svg");
    page.links.push_back({std::string(f.name) + ".png", std::string(f.name) + ".png", "300 dpi"});
  }
}

}  // namespace

std::vector<std::string> write_paper_report(const PaperReport& r, const std::string& folder) {
  const auto wants = [&](PaperPart part) { return r.experiment.reports(part); };
  const std::vector<ObjectRow> rows =
      r.experiment.collides() ? make_table(r.objects, r.steps) : std::vector<ObjectRow>();
  std::vector<std::string> notes;
  io::write_text(folder + "/tables.json", tables_json(r.objects, rows, r.experiment.protocol));

  report::Page page;
  page.title = "The paper's experiment";
  page.purpose =
      "C. Gonzalez-Ochoa, \"2-Body Collision Detection using LRB-reps\", tables 1 and 2 and figures 3.1 and "
      "3.2, measured beside the published numbers.";
  if (r.experiment.name != "paper") page.purpose = r.experiment.purpose;
  const std::string protocol = protocol_text(r.experiment.protocol);
  std::string md = "# " + page.title + "\n\n" + page.purpose + "\n\n";
  if (!rows.empty()) {
    md += "Protocol: " + protocol + "\n\nMade by `" + r.command + "`.\n\n## What differs\n\n";
    report::PageTable what{"What differs", {"remark"}, {}, "Protocol: " + protocol};
    for (const std::string& s : differences(r, rows)) {
      md += "- " + s + "\n";
      what.rows.push_back({s});
    }
    page.tables.push_back(what);
  }
  const std::size_t said = page.tables.size();
  if (wants(PaperPart::table1)) page.tables.push_back(table1(r));
  if (wants(PaperPart::table2))
    for (std::size_t i = 0; i < kRecursions.size(); ++i) page.tables.push_back(table2(rows, i));
  const std::string series = r.series ? add_series(*r.series, folder, report::has_gnuplot(), page) : "";
  if (!r.seconds.empty()) page.tables.push_back(time_table(r.seconds));
  for (std::size_t i = said; i < page.tables.size(); ++i) add_markdown(md, page.tables[i]);

  if (wants(PaperPart::figure_3_1)) page.charts.push_back(sizes_chart(rows));
  draw_charts(r, rows, folder, page, notes);
  draw_close_ups(r, folder, page, notes);
  for (const report::PageFigure& f : page.figures)
    md += "\n## " + f.title + "\n\n![" + f.title + "](" + f.file + ")\n\n" + f.caption + "\n";
  md += series;
  if (!rows.empty()) {
    io::write_text(folder + "/records.jsonl", to_json_lines(r.steps));
    page.links.push_back({"records.jsonl", "records.jsonl", "every counted time step"});
  }
  page.links.push_back({"tables.json", "tables.json", "both tables as data"});
  page.command = r.command;
  io::write_text(folder + "/report.md", md);
  io::write_text(folder + "/index.html", report::page_html(page));
  return notes;
}

}  // namespace lrb::paper

#include "scenarios/paper/paper_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/paper/paper_pictures.hpp"
#include "scenarios/paper/sweep.hpp"
#include <lrbscope/coherent.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::paper {
namespace {

constexpr double kBinWidth = 250;  // comparisons

/// Figure 3.1: the other object's size (real and pseudo faces, log axis) against comparisons: minimum,
/// average and maximum, measured with the paper's recursion and as published; and the maxima of several
/// seeds.
report::Chart figure_3_1(std::span<const Run> runs) {
  constexpr double kBeside = 1.06;  // factor by which the bars of the next series are shifted to the right
  const std::string seed = std::to_string(runs.front().protocol.seed);
  report::Series measured{
      "measured: average, minimum, maximum" + (runs.size() > 1 ? ", seed " + seed : ""), {}, {}},
      paper{"published", {}, {}, {report::Line::dashed}},
      maxima{"maxima of " + std::to_string(runs.size()) + " seeds: median, lowest, highest",
             {},
             {},
             {report::Line::none}};
  const auto add = [](report::Series& s, double size, double centre, double low, double high) {
    s.x.push_back(size);
    s.y.push_back(centre);
    s.low.push_back(low);
    s.high.push_back(high);
  };
  report::Axis sizes{"the other object, by its number of faces", true, 80, 90000};
  for (std::size_t i = 0; i < runs.front().rows.size(); ++i) {
    const ObjectRow& row = runs.front().rows[i];
    const Spread& s = row.recursions[kPaper].comparisons;
    add(measured, row.total_faces, s.average, s.min, s.max);
    if (const PublishedRow* p = published(row.object))
      add(paper, row.total_faces * kBeside, p->average, p->min, p->max);
    if (runs.size() > 1) {
      std::vector<double> values;
      for (const Run& run : runs) values.push_back(run.rows[i].recursions[kPaper].comparisons.max);
      const Band band = band_of(std::move(values));
      add(maxima, row.total_faces * kBeside * kBeside, band.median, band.low, band.high);
    }
    sizes.ticks.push_back({static_cast<double>(row.total_faces), row.object});
  }
  std::vector<report::Series> series = {measured, paper};
  if (!maxima.x.empty()) series.push_back(maxima);
  return {
      "Figure 3.1: object size and face comparisons",
      sizes,
      {"face comparisons"},
      series,
      "Comparisons in a time step by the paper's recursion, and all faces, real and pseudo. Bars of one object are side by "
      "side."};
}

/// Figure 3.2: the number of time steps for each number of comparisons, a line for each object, with the
/// paper's recursion.
report::Chart figure_3_2(std::span<const ObjectRow> rows, std::span<const ContactStep> steps,
                         bool as_published) {
  constexpr double kPublishedCentre = 2000;
  double highest = 0;
  report::Chart chart{
      "Figure 3.2: distribution of face comparisons",
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
    highest = std::max(highest, *std::max_element(line.y.begin(), line.y.end()));
    chart.series.push_back(std::move(line));
  }
  if (as_published) {
    chart.series.push_back({"published: centre of the major grouping",
                            {kPublishedCentre, kPublishedCentre},
                            {0, highest},
                            {report::Line::dashed, "#808080", "none"}});
    chart.note +=
        " The published curves are a picture, without numbers; the text says that the major grouping "
        "is around the 2000 mark.";
  }
  return chart;
}

const PaperObject& object_called(const PaperReport& r, const std::string& name) {
  return *std::find_if(r.objects.begin(), r.objects.end(),
                       [&](const PaperObject& o) { return o.name == name; });
}

std::vector<ContactStep> of_first_seed(const PaperReport& r) {
  std::vector<ContactStep> out;
  std::copy_if(r.steps.begin(), r.steps.end(), std::back_inserter(out),
               [&](const ContactStep& s) { return s.seed == r.experiment.protocol.seed; });
  return out;
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
  const auto [least, most] = easiest_and_hardest(of_first_seed(r), pair.x.name);
  return CloseUps{pair, close_up(pair, least, r.experiment.protocol),
                  close_up(pair, most, r.experiment.protocol)};
}

report::Table table1(const PaperReport& r) {
  report::Table t{
      "Table 1: object sizes", {"object", "real faces", "total faces", "outermost wrapper"}, {}, {}};
  t.note = as_published(r.objects)
               ? "Equal to the paper's, face by face: the generator is given its numbers. The bodies' shapes "
                 "are ours: the paper says only that they are fractal, with a basic non-convex shape."
               : "Not the paper's objects, or not all of them.";
  for (const PaperObject& o : r.objects)
    t.rows.push_back({o.name, render::group_digits(o.rep.real_face_count()),
                      render::group_digits(o.rep.face_count()),
                      render::counted(o.rep.outermost_faces().size(), "face", "faces")});
  return t;
}

/// Table 2 as in the paper, each number beside the published one.
report::Table table2(std::span<const ObjectRow> rows) {
  report::Table t{
      "Table 2: face comparisons of A with the other objects",
      {"object", "minimum", "published", "average", "published", "maximum", "published", "n log n", "n²"}};
  for (const ObjectRow& row : rows) {
    const PublishedRow* p = published(row.object);
    const auto number = [&](double PublishedRow::*of) { return p ? whole(p->*of) : "–"; };
    const Spread& n = row.recursions[kPaper].comparisons;
    t.rows.push_back({row.object, whole(n.min), number(&PublishedRow::min), whole(n.average),
                      number(&PublishedRow::average), whole(n.max), number(&PublishedRow::max),
                      whole(row.n_log_n), whole(row.n_squared)});
  }
  t.note =
      "By the paper's recursion, each pair of regions once: exact comparisons of faces in a time step with a "
      "contact of real faces.";
  return t;
}

/// All counters of one recursion.
report::Table counters(std::span<const ObjectRow> rows, std::size_t recursion) {
  const bool complete = kRecursions[recursion] == Recursion::complete;
  report::Table t{std::string("Counters, ") + kRecursionTitles[recursion],
                  {"object", "steps", "minimum", "average", "maximum", "refinements (avg)", "pairs missed"}};
  if (complete) t.columns.push_back("bound tests (avg)");
  for (const ObjectRow& row : rows) {
    const RecursionRow& x = row.recursions[recursion];
    t.rows.push_back({row.object, render::group_digits(row.steps), whole(x.comparisons.min),
                      whole(x.comparisons.average), whole(x.comparisons.max), fixed(x.refinements.average, 1),
                      missed_text(x)});
    if (complete) t.rows.back().push_back(whole(x.bound_tests));
  }
  t.note = complete
               ? "Comparisons of triangles, exact; what decides before them are the bound tests. Nothing is "
                 "missed."
               : "Comparisons of faces, exact. The paper does not count missed pairs.";
  return t;
}

std::string text_of(const Band& b) {
  return fixed(b.median, 2) + " (" + fixed(b.low, 2) + " to " + fixed(b.high, 2) + ")";
}

std::string seeds_text(const PaperProtocol& p) {
  return p.seeds == 1 ? "seed " + std::to_string(p.seed)
                      : "seeds " + std::to_string(p.seed) + " to " + std::to_string(p.seed + p.seeds - 1);
}

report::Table ratio_table(std::span<const Run> runs, const PaperProtocol& protocol) {
  report::Table t{"Measured over published", {"object", "minimum", "average", "maximum"}};
  for (const ObjectRow& row : runs.front().rows) {
    const RatioBands b = ratios(runs, row.object);
    t.rows.push_back({row.object});
    for (const Band& band : b)
      t.rows.back().push_back(runs.size() > 1 ? text_of(band) : fixed(band.median, 2));
  }
  t.note = runs.size() > 1
               ? "Median over the " + seeds_text(protocol) + ", and in brackets the lowest and the highest."
               : "Of one seed; --seeds N gives the band over N seeds. Minimum and maximum are of "
                 "single time steps.";
  return t;
}

/// A reading of what table 2 counts.
struct Reading {
  const char* title;
  std::size_t recursion;
  bool at_first_contact, in_triangles;
};
constexpr Reading kReadings[] = {{"each step, faces", kPaper, false, false},
                                 {"each step, triangles", kPaper, false, true},
                                 {"first contact, faces", kPaper, true, false},
                                 {"first contact, triangles", kPaper, true, true},
                                 {"whole wrapper, each step", kWrapper, false, false},
                                 {"whole wrapper, first contact", kWrapper, true, false}};

/// Compares readings of table 2 with the published numbers.
report::Table readings_table(const PaperReport& r, std::span<const ObjectRow> rows) {
  using Numbers = std::array<std::vector<double>, 3>;  // minima, averages and maxima of all objects
  const auto three = [](int digits, const auto& of) {
    return fixed(of(0), digits) + " / " + fixed(of(1), digits) + " / " + fixed(of(2), digits);
  };
  report::Table t{"Readings of table 2", {"minimum / average / maximum", "published"}};
  std::vector<double> sizes;
  Numbers originals;
  for (const ObjectRow& row : rows) {
    sizes.push_back(row.total_faces);
    for (std::size_t k = 0; k < 3; ++k) originals[k].push_back(published(row.object)->*kPublished[k]);
    t.rows.push_back({row.object, three(0, [&](std::size_t k) { return originals[k].back(); })});
  }
  const auto exponents = [&](const Numbers& x) {
    return three(3, [&](std::size_t k) { return resolutions::fit_power(sizes, x[k]).exponent; });
  };
  t.rows.insert(t.rows.end(), {{"off by", "–"},
                               {"off by, all numbers", "–"},
                               {"exponents", exponents(originals)},
                               {"pairs missed", "not counted"}});
  for (const Reading& reading : kReadings) {
    std::vector<ContactStep> counted;
    std::copy_if(r.steps.begin(), r.steps.end(), std::back_inserter(counted),
                 [&](const ContactStep& s) { return !reading.at_first_contact || s.step == 0; });
    std::vector<Run> runs = runs_of_seeds(r.objects, counted, r.experiment.protocol);
    if (reading.recursion == kWrapper) runs.resize(1);  // not measured with other seeds
    Numbers numbers;
    std::vector<double> missed;
    t.columns.emplace_back(reading.title);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        std::vector<double> values;
        for (const Run& run : runs) {
          const RecursionRow& n = run.rows[i].recursions[reading.recursion];
          values.push_back((reading.in_triangles ? n.triangles : n.comparisons).*kMeasured[k]);
        }
        numbers[k].push_back(band_of(std::move(values)).median);
      }
      missed.push_back(missed_percent(runs.front().rows[i].recursions[reading.recursion]));
      t.rows[i].push_back(three(2, [&](std::size_t k) { return numbers[k][i] / originals[k][i]; }));
    }
    // Root mean square of factors, of some of minima, averages and maxima.
    const auto off_by = [&](std::size_t first, std::size_t last) {
      double sum = 0;
      for (std::size_t k = first; k < last; ++k)
        for (std::size_t i = 0; i < rows.size(); ++i)
          sum += std::pow(std::log(numbers[k][i] / originals[k][i]), 2);
      return std::exp(std::sqrt(sum / static_cast<double>((last - first) * rows.size())));
    };
    auto row = t.rows.begin() + static_cast<std::ptrdiff_t>(rows.size());
    row++->push_back(three(2, [&](std::size_t k) { return off_by(k, k + 1); }));
    row++->push_back(fixed(off_by(0, 3), 2));
    row++->push_back(exponents(numbers));
    const Band band = band_of(std::move(missed));
    row->push_back(fixed(band.low, 2) + " to " + fixed(band.high, 2) + " %");
  }
  t.note =
      "Measured over published: medians over the seeds; the whole wrapper with the first seed. \"Off by\": root "
      "mean square of factors. Exponents: of powers of the other object's faces, real and pseudo. Triangles: a "
      "comparison of two faces counts as many as they have pairs of triangles. Whole wrapper: new faces are compared "
      "with the whole current wrapper. Missed pairs are of the objects with the fewest and the most, first seed.";
  return t;
}

report::Table settings_table(std::span<const Run> settings, const PaperProtocol& protocol) {
  report::Table t{"Other time steps and numbers of steps",
                  {"time step, %", "steps after contact", "last step, %", "minimum", "average", "maximum",
                   "growth of the average"}};
  for (const Run& run : settings) {
    const RatioBands b = ratios({&run, 1});
    const double first = run.rows.front().recursions[kPaper].comparisons.average,
                 last = run.rows.back().recursions[kPaper].comparisons.average;
    t.rows.push_back({io::fixed_text(100 * run.protocol.step, 3),
                      render::group_digits(run.protocol.steps_after),
                      io::fixed_text(100 * run.protocol.step * run.protocol.steps_after, 3), text_of(b[0]),
                      text_of(b[1]), text_of(b[2]), first > 0 ? fixed(last / first, 2) : "–"});
  }
  t.note =
      "Measured over published as above, now the median over the objects and the span from the lowest to the "
      "highest object, with seed " +
      std::to_string(protocol.seed) +
      ". Steps are in percent of the diagonal; the last step is how far the bodies moved on after the first "
      "contact. Growth is from " +
      settings.front().rows.front().object + " to " + settings.front().rows.back().object +
      "; the published one is 2.18.";
  return t;
}

std::string protocol_text(const PaperProtocol& p) {
  return render::group_digits(p.collisions) +
         " collisions per object; random rotations of both bodies, equal diagonals; the other body comes in "
         "along a random line through both centres in steps of " +
         fixed(100 * p.step, 2) +
         " % of the diagonal; every step with a contact of real faces counts, from the first one through " +
         std::to_string(p.steps_after) + " more; " + seeds_text(p) + ".";
}

/// Returns the number of comparisons with which every collision begins, if all objects have one outermost
/// region of the same size; otherwise 0.
std::size_t constant_part(std::span<const PaperObject> objects) {
  std::size_t out = 0;
  for (const PaperObject& o : objects) {
    const std::span<const FaceId> outer = o.rep.outermost_faces();
    if (o.rep.is_real(outer[0])) return 0;
    const RegionId region = o.rep.inner_cell(outer[0]).as_region();
    const std::size_t lids = o.rep.lids(region).size(), floor = o.rep.floor(region).size();
    const std::size_t n = lids * lids + floor * floor;
    if (lids != outer.size() || (out != 0 && n != out)) return 0;
    out = n;
  }
  return out;
}

/// Returns the differences to the paper's setup that matter for a comparison.
std::vector<std::string> differences(const PaperReport& r, std::span<const ObjectRow> rows) {
  std::vector<std::string> out = {"Protocol: " + protocol_text(r.experiment.protocol)};
  if (!as_published(r.objects))
    out.push_back("Not all objects are the paper's, so the published numbers are for others.");
  out.push_back(
      "The paper names neither the length of a time step nor the number of steps after the first contact; both "
      "decide how deep bodies meet, and with it the numbers. The defaults, 0.5 % of the diagonal and 5 steps, are "
      "round numbers that this program has had from its first version, with no reason on record. Agreement with "
      "the published numbers at one setting is therefore no evidence for it" +
      std::string(r.settings.empty() ? " (--step, --steps-after)."
                                     : "; the table of other settings shows how much they change."));
  const RecursionRow &first = rows.front().recursions[0], &last = rows.back().recursions[0];
  if (first.comparisons.max > 0 && rows.size() > 1)
    out.push_back("From " + rows.front().object + " to " + rows.back().object + " the average grows " +
                  fixed(last.comparisons.average / first.comparisons.average, 2) +
                  "-fold (published: 2.18), the maximum " +
                  fixed(last.comparisons.max / first.comparisons.max, 2) +
                  "-fold (published: 3.57 to its highest row).");
  if (const PublishedRow* p = published(rows.back().object); p != nullptr && last.comparisons.max > 0) {
    const auto orders = [&](double n) { return fixed(std::log10(rows.back().n_squared / n), 2); };
    out.push_back("\"6 orders of magnitude\" below n²: for " + rows.back().object + " the average is " +
                  orders(last.comparisons.average) + " and the maximum " + orders(last.comparisons.max) +
                  " orders below (published numbers: " + orders(p->average) + " and " + orders(p->max) +
                  "). \"On the average roughly doubled\": see the growth above.");
  }
  if (const std::size_t n = constant_part(r.objects); n > 0)
    out.push_back(
        "Every collision begins with " + render::group_digits(n) +
        " comparisons: all outermost faces of A with those of the other object, and the floors of their only "
        "regions" +
        (std::all_of(rows.begin(), rows.end(),
                     [&](const ObjectRow& row) {
                       return 2 * static_cast<double>(n) >
                              static_cast<double>(row.recursions[0].comparisons.min);
                     })
             ? ": most of each minimum, and the reason that minima do not grow."
             : "."));
  return out;
}

/// A report as a page and as Markdown.
class Pages {
 public:
  Pages(const std::string& title, const std::string& purpose)
      : page(title, purpose), markdown("# " + title + "\n\n" + purpose + "\n") {}

  void table(const report::Table& t) {
    page.table(t);
    markdown += "\n## " + t.title + "\n\n|";
    for (const std::string& c : t.columns) markdown += " " + c + " |";
    markdown += "\n|";
    for (std::size_t i = 0; i < t.columns.size(); ++i) markdown += i == 0 ? " --- |" : " ---: |";
    for (const auto& row : t.rows) {
      markdown += "\n|";
      for (const std::string& c : row) markdown += " " + c + " |";
    }
    markdown += "\n" + (t.note.empty() ? "" : "\n" + t.note + "\n");
  }
  void chart(const report::Chart& c, const std::string& name, const report::PrintLayout& layout) {
    if (!page.chart(c).print(name, c.title, report::gnuplot({&c, 1}, layout)).empty())
      figure(c.title, name + ".svg", c.note);
  }
  /// Adds a picture to the Markdown.
  void figure(const std::string& title, const std::string& file, const std::string& caption) {
    markdown += "\n## " + title + "\n\n![" + title + "](" + file + ")\n" +
                (caption.empty() ? "" : "\n" + caption + "\n");
  }

  report::Document page;
  std::string markdown;
};

}  // namespace

report::Table incremental_table(std::span<const PaperObject> objects, std::span<const ContactStep> contacts) {
  constexpr std::uint32_t kCollisions = 2;
  constexpr int kSteps = 100;
  constexpr double kStep = 2e-4;  // of the diagonal
  report::Table t{"The incremental version: wrappers kept from step to step",
                  {"object", "comparisons from scratch", "on kept wrappers", "share, %", "refinements",
                   "coarsenings", "answers that differ"}};
  t.note = "Averages over " + std::to_string(kSteps) + " steps of " + fixed(100 * kStep, 2) +
           " % of the diagonal into the body, from the first contact of at most " +
           std::to_string(kCollisions) +
           " collisions, by the paper's recursion. The first of the steps is from scratch.";
  const LrbRep& a = objects.front().rep;
  CollideRequest request;
  request.recursion = Recursion::paper;
  Workspace workspace;
  for (const PaperObject& x : objects.subspan(1)) {
    double scratch = 0, kept = 0, refined = 0, coarsened = 0, steps = 0;
    std::uint64_t differ = 0;
    for (const ContactStep& start : contacts) {
      if (start.object != x.name || start.collision >= kCollisions) continue;
      CoherentQuery query(a, x.rep, request);
      const Eigen::Vector3d direction =
          start.pose_a.apply(shapes::box_of(a).center()) - start.pose_x.apply(shapes::box_of(x.rep).center());
      Pose pose = start.pose_x;
      for (int step = 0; step < kSteps; ++step, ++steps) {
        const CollideResult& found = query.collide(start.pose_a, pose);
        const CollideResult expected =
            std::move(collide(a, start.pose_a, x.rep, pose, request, workspace).value());
        differ += found.pairs != expected.pairs;
        kept += static_cast<double>(found.counters.face_tests);
        scratch += static_cast<double>(expected.counters.face_tests);
        refined += static_cast<double>(found.counters.refinements);
        pose.t += kStep * diagonal(a) * direction.normalized();
      }
      coarsened += static_cast<double>(query.statistics().coarsened);
    }
    if (steps == 0) continue;  // no contact was found
    t.rows.push_back({x.name, fixed(scratch / steps, 0), fixed(kept / steps, 0),
                      fixed(100 * kept / scratch, 1), fixed(refined / steps, 2), fixed(coarsened / steps, 2),
                      std::to_string(differ)});
  }
  return t;
}

std::vector<std::string> write_paper_report(const PaperReport& r, const report::Folder& folder) {
  const auto wants = [&](PaperPart part) { return r.experiment.reports(part); };
  const PaperProtocol& protocol = r.experiment.protocol;
  const std::vector<Run> runs = r.experiment.collides() ? runs_of_seeds(r.objects, r.steps, protocol)
                                                        : std::vector<Run>(),
                         settings = r.settings.empty() ? std::vector<Run>()
                                                       : runs_of_settings(r.objects, r.settings, protocol);
  const std::span<const ObjectRow> rows = runs.empty() ? std::span<const ObjectRow>() : runs.front().rows;
  Pages out(
      "The paper's experiment",
      r.experiment.name != "paper"
          ? r.experiment.purpose
          : "C. Gonzalez-Ochoa, \"2-Body Collision Detection using LRB-reps\", tables 1 and 2 and figures 3.1 "
            "and 3.2, measured beside the published numbers.");
  report::Document& doc = out.page;
  doc.command(r.command).tables_as_tex(r.tex);
  // The paper's own tables and figures first; each chart has the whole width, because a table follows it.
  if (wants(PaperPart::table1)) out.table(table1(r));
  if (wants(PaperPart::table2)) out.table(table2(rows));
  if (wants(PaperPart::figure_3_1)) out.chart(figure_3_1(runs), "figure3-1", {1, 135, 85, 8, "top left"});
  const bool published = as_published(r.objects) && !runs.empty();
  if (published) out.table(ratio_table(runs, protocol));
  if (published && wants(PaperPart::table2) && rows.size() > 1 &&
      std::all_of(rows.begin(), rows.end(), [](const ObjectRow& row) { return row.steps > 0; }))
    out.table(readings_table(r, rows));
  if (wants(PaperPart::figure_3_2)) out.chart(figure_3_2(rows, of_first_seed(r), published), "figure3-2", {});
  if (!settings.empty()) out.table(settings_table(settings, protocol));
  if (!rows.empty()) {
    report::Table remarks{"Differences from the paper", {"remark"}};
    for (const std::string& s : differences(r, rows)) remarks.rows.push_back({s});
    out.table(remarks);
  }
  if (wants(PaperPart::table2))
    for (std::size_t i = 0; i < kRecursions.size(); ++i) out.table(counters(rows, i));
  for (const report::Table& t : r.more) out.table(t);
  std::vector<std::string> notes;
  if (const std::optional<CloseUps> c = close_ups_of(r)) {
    if (wants(PaperPart::heat_maps)) try {
        const std::string title = "Face tests over the bodies",
                          caption = heat_caption(c->pair, c->easiest, c->hardest, protocol.collisions);
        doc.picture("heat_maps.png", draw_heat_maps(c->pair, c->easiest, c->hardest), title, caption);
        out.figure(title, "heat_maps.png", caption);
      } catch (const EnvironmentError& e) {
        notes.push_back(std::string("heat maps were not drawn: ") + e.what());
      }
    if (wants(PaperPart::refinement_tree)) {
      const std::string title = "The refinement tree of one collision",
                        caption = tree_caption(c->pair, c->hardest);
      doc.picture("refinement_tree.svg", icicle_svg(c->pair, c->hardest), title, caption, true);
      out.figure(title, "refinement_tree.svg", caption);
    }
  }
  if (r.series) {
    const std::vector<report::Table> tables = add_series(*r.series, doc);
    if (doc.notes().empty())
      for (const char* name : {"series-comparisons", "series-time"})
        out.figure(name, std::string(name) + ".svg", "");
    for (const report::Table& t : tables) out.table(t);
  }
  doc.file("table1.csv", table1_csv(r.objects), "table 1 as CSV");
  if (!rows.empty()) {
    doc.file("table2.csv", table2_csv(runs), "table 2 as CSV, for each seed and recursion");
    doc.file("records.jsonl", to_json_lines(r.steps), "every counted time step");
  }
  if (!settings.empty()) {
    doc.file("settings.csv", table2_csv(settings),
             "table 2 as CSV, for other time steps and numbers of steps");
    doc.file("settings.jsonl", to_json_lines(r.settings), "their time steps");
  }
  doc.file("tables.json", tables_json(r.objects, runs, protocol), "both tables as data");
  doc.file("report.md", out.markdown + "\nMade by `" + r.command + "`.\n", "this report as Markdown")
      .write(folder);
  notes.insert(notes.begin(), doc.notes().begin(), doc.notes().end());
  return notes;
}

}  // namespace lrb::paper

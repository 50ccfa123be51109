#include "scenarios/paper/series.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/trace/json_write.hpp>

namespace lrb::resolutions {

PowerFit fit_power(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x, dy = std::log(y[i]) - mean_y;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  PowerFit fit;
  fit.exponent = xy / xx;
  fit.factor = std::exp(mean_y - fit.exponent * mean_x);
  if (x.size() > 2) fit.error = std::sqrt(std::max(0.0, yy - fit.exponent * xy) / (n - 2) / xx);
  return fit;
}

}  // namespace lrb::resolutions

namespace lrb::paper {
namespace {

namespace fs = std::filesystem;

/// Returns the meshes in a folder, by name; other paths unchanged.
std::vector<std::string> files_of(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code failure;
    if (!fs::is_directory(path, failure)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(path, failure))
      if (has_mesh_extension(entry.path().string())) found.push_back(entry.path().string());
    if (failure) throw InputError(printable_name(path) + ": cannot read the file: " + failure.message());
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// Returns the reason why no series can be made of a mesh; empty if one can.
std::string obstacle(const Mesh& mesh) {
  if (mesh.dim != 3) return "a 2D body";
  const MeshReport report = check_mesh(mesh, false).when_turned();
  return report.buildable() ? "" : "an LRB-rep cannot be built (see `lrbscope inspect`)";
}

}  // namespace

std::string series_name(const SeriesObject& object, SeriesPartner partner) {
  return object.body + "/" + std::to_string(object.rep.real_face_count()) +
         (partner == SeriesPartner::a ? "/A" : "/itself");
}

std::vector<Mesh> own_series_bodies() {
  std::vector<Mesh> bodies = {generators::generate("rock", {{"frequency", 64}}),
                              generators::generate("knot", {{"segments", 1600}, {"sides", 24}})};
  bodies[0].name = "rock";
  bodies[1].name = "knot";
  return bodies;
}

std::vector<Mesh> read_series_bodies(const std::vector<std::string>& paths, std::vector<std::string>& notes) {
  std::vector<Mesh> bodies;
  std::set<std::string> names;
  for (const std::string& file : files_of(paths)) {
    Mesh mesh = read_mesh(file);
    mesh.name = fs::path(file).stem().string();
    if (const std::string why = obstacle(mesh); !why.empty()) {
      notes.push_back(printable_name(file) + ": skipped: " + why);
      continue;
    }
    if (!names.insert(mesh.name).second)
      throw InputError(printable_name(file) + ": another mesh has the name " + printable_name(mesh.name) +
                       "; give each mesh its own name");
    bodies.push_back(std::move(mesh));
  }
  if (bodies.empty())
    throw InputError(
        "--meshes: no mesh from which an LRB-rep can be built; give OBJ, PLY, STL or OFF files of closed "
        "bodies, or folders of them");
  return bodies;
}

std::vector<SeriesObject> make_series(std::span<const Mesh> bodies,
                                      const resolutions::ResolutionOptions& options,
                                      const BuildOptions& building, double diagonal_of_a,
                                      const std::function<void(const LrbRep&)>& progress) {
  std::vector<SeriesObject> objects;
  for (const Mesh& body : bodies) {
    for (const Mesh& mesh : resolutions::resolutions(body, options)) {
      const LrbRep rep = build_lrb(mesh, building);
      objects.push_back({body.name, scaled(rep, diagonal_of_a / diagonal(rep))});
      if (progress) progress(objects.back().rep);
    }
  }
  return objects;
}

std::vector<ContactStep> run_series(const LrbRep& a, std::span<const SeriesObject> objects,
                                    const SweepOptions& options) {
  std::vector<ContactStep> steps;
  SweepOptions scalable = options;
  scalable.scalable_only = true;
  for (const SeriesPartner partner : kSeriesPartners)
    for (const SeriesObject& object : objects) {
      const PaperObject pair[] = {{"", partner == SeriesPartner::a ? a : object.rep},
                                  {series_name(object, partner), object.rep, object.body}};
      for (ContactStep& s : run_sweep(pair, scalable)) steps.push_back(std::move(s));
    }
  return sorted(std::move(steps));
}

std::vector<SeriesRow> series_rows(const LrbRep& a, std::span<const SeriesObject> objects,
                                   std::span<const ContactStep> steps) {
  std::vector<SeriesRow> rows;
  std::map<std::string, std::vector<ContactStep>> by_object;
  for (const ContactStep& s : steps) by_object[s.object].push_back(s);
  for (const SeriesPartner partner : kSeriesPartners) {
    for (const SeriesObject& object : objects) {
      const std::string name = series_name(object, partner);
      const std::vector<ContactStep> own = std::move(by_object[name]);
      by_object.erase(name);
      const PaperObject pair[] = {{"", partner == SeriesPartner::a ? a : object.rep}, {name, object.rep}};
      SeriesRow row{object.body, partner, object.rep.outermost_faces().size(), make_table(pair, own)[0], {}};
      for (const std::size_t i : kScalable) {
        std::vector<double> microseconds;
        for (const ContactStep& s : own)
          microseconds.push_back(static_cast<double>(s.counts[i].nanoseconds) / 1000);
        row.microseconds[i] = band_of(std::move(microseconds)).median;
      }
      rows.push_back(std::move(row));
    }
  }
  if (!by_object.empty())
    throw InputError("the records contain the object " + printable_name(by_object.begin()->first) +
                     ", which is not in the series");
  return rows;
}

namespace {

const char* against(SeriesPartner p) {
  return p == SeriesPartner::a ? "A" : "itself";
}

/// The chart of one recursion against one partner: a series for each body, with its fitted power.
report::Chart chart(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits, SeriesPartner partner,
                    std::size_t recursion, bool time) {
  report::Chart c{std::string(time ? "Time" : "Comparisons") + " against " + against(partner) + ", " +
                      kRecursionTitles[recursion],
                  {"real and pseudo faces", true},
                  {time ? "median of a query, µs" : "face comparisons", true}};
  std::vector<report::Series> powers;
  for (const SeriesFit& fit : fits) {
    if (fit.partner != partner || fit.recursion != recursion) continue;
    const std::optional<resolutions::PowerFit>& power = time ? fit.microseconds : fit.comparisons;
    report::Series s{fit.body + (power ? ": " + power_text(*power) : ""), {}, {}, {report::Line::none}};
    s.style.colour = report::series_colour(c.series.size());
    // Rows begin with the finest resolution, charts with the coarsest.
    for (std::size_t i = rows.size(); i-- > 0;) {
      const SeriesRow& row = rows[i];
      const Spread& n = row.counts.recursions[recursion].comparisons;
      const double y = time ? row.microseconds[recursion] : n.average;
      if (row.body != fit.body || row.partner != partner || !(y > 0)) continue;
      s.x.push_back(row.counts.total_faces);
      s.y.push_back(y);
      if (time) continue;
      s.low.push_back(n.min);
      s.high.push_back(n.max);
    }
    if (s.x.empty()) continue;
    if (power) {
      const auto value = [&](double x) { return power->factor * std::pow(x, power->exponent); };
      powers.push_back({"",
                        {s.x.front(), s.x.back()},
                        {value(s.x.front()), value(s.x.back())},
                        {report::Line::dashed, s.style.colour, "none"}});
    }
    c.series.push_back(std::move(s));
  }
  c.series.insert(c.series.end(), powers.begin(), powers.end());
  return c;
}

/// Reserves space for each panel's key above its points.
report::Gnuplot panels(std::vector<report::Chart> charts) {
  constexpr double kHeight = 40, kKeyLine = 3.4;  // millimetres
  const report::PrintLayout layout{static_cast<int>(std::size(kScalable)), 55, kHeight, 7, "top left"};
  for (report::Chart& c : charts) {
    double lowest = std::numeric_limits<double>::infinity(), highest = 0, lines = 1;
    for (const report::Series& s : c.series) {
      for (const std::vector<double>* values : {&s.y, &s.low, &s.high})
        for (const double y : *values) {
          lowest = std::min(lowest, y);
          highest = std::max(highest, y);
        }
      lines += s.label.empty() ? 0 : 1;
    }
    const double share = std::min(0.8, lines * kKeyLine / kHeight);
    c.y.min = lowest / 1.3;
    c.y.max = 1.2 * highest * std::pow(highest / lowest, share / (1 - share));
  }
  return report::gnuplot(charts, layout);
}

}  // namespace

std::string power_text(const resolutions::PowerFit& fit) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << "n^" << fit.exponent;
  if (fit.error > 0) out << " ± " << fit.error;
  return out.str();
}

namespace {

std::string text_of(const std::optional<resolutions::PowerFit>& fit) {
  return fit ? power_text(*fit) : "–";
}

report::Table table(std::span<const SeriesRow> rows, SeriesPartner partner, std::size_t recursion) {
  report::Table t{std::string("Resolutions against ") + against(partner) + ", " + kRecursionTitles[recursion],
                  {"body", "real faces", "total faces", "outermost", "steps", "minimum", "average", "maximum",
                   "refinements (avg)", "pairs missed", "time (median, µs)"}};
  const bool complete = kRecursions[recursion] == Recursion::complete;
  if (complete) t.columns.insert(t.columns.begin() + 9, "bound tests (avg)");
  for (const SeriesRow& row : rows) {
    if (row.partner != partner) continue;
    const RecursionRow& x = row.counts.recursions[recursion];
    t.rows.push_back({row.body, render::group_digits(row.counts.real_faces),
                      render::group_digits(row.counts.total_faces), render::group_digits(row.outer_faces),
                      render::group_digits(row.counts.steps), whole(x.comparisons.min),
                      whole(x.comparisons.average), whole(x.comparisons.max),
                      fixed(x.refinements.average, 1)});
    if (complete) t.rows.back().push_back(whole(x.bound_tests));
    t.rows.back().push_back(missed_text(x));
    t.rows.back().push_back(fixed(row.microseconds[recursion], 0));
  }
  return t;
}

report::Table fit_table(std::span<const SeriesFit> fits, std::uint32_t jobs) {
  report::Table t{
      "Growth with the resolution",
      {"body", "against", "recursion", "comparisons", "refinements", "time"},
      {},
      "Powers of n, the body's real and pseudo faces, fitted by least squares in both logarithms to the "
      "averages (time: medians) of all resolutions, with the exponent's standard error. Against A one "
      "body grows, against itself both do. For n log n, which the paper sets beside its counts, the power "
      "would be above 1. Times are of one query each, on this machine" +
          (jobs > 1 ? ", while " + std::to_string(jobs) + " threads worked" : std::string()) + "."};
  for (const SeriesFit& f : fits)
    t.rows.push_back({f.body, against(f.partner), kRecursionTitles[f.recursion], text_of(f.comparisons),
                      text_of(f.refinements), text_of(f.microseconds)});
  return t;
}

nlohmann::ordered_json to_json(const std::optional<resolutions::PowerFit>& fit) {
  if (!fit) return nullptr;
  return {{"exponent", fit->exponent}, {"standard_error", fit->error}, {"factor", fit->factor}};
}

std::string series_json(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits) {
  nlohmann::ordered_json j;
  j["rows"] = nlohmann::ordered_json::array();
  for (const SeriesRow& row : rows) {
    nlohmann::ordered_json r = {{"body", row.body},
                                {"against", against(row.partner)},
                                {"real_faces", row.counts.real_faces},
                                {"total_faces", row.counts.total_faces},
                                {"outer_faces", row.outer_faces},
                                {"steps", row.counts.steps}};
    for (const std::size_t i : kScalable) {
      const RecursionRow& x = row.counts.recursions[i];
      r[std::string(trace::name_of(kRecursions[i]))] = {{"comparisons_min", x.comparisons.min},
                                                        {"comparisons_avg", x.comparisons.average},
                                                        {"comparisons_max", x.comparisons.max},
                                                        {"refinements_avg", x.refinements.average},
                                                        {"bound_tests_avg", x.bound_tests},
                                                        {"pairs", x.pairs},
                                                        {"missed", x.missed}};
    }
    j["rows"].push_back(std::move(r));
  }
  j["powers_of_total_faces"] = nlohmann::ordered_json::array();
  for (const SeriesFit& f : fits)
    j["powers_of_total_faces"].push_back({{"body", f.body},
                                          {"against", against(f.partner)},
                                          {"recursion", trace::name_of(kRecursions[f.recursion])},
                                          {"comparisons", to_json(f.comparisons)},
                                          {"refinements", to_json(f.refinements)}});
  return j.dump(2) + "\n";
}

template <class Measure>
std::optional<resolutions::PowerFit> fit(std::span<const SeriesRow> rows, const SeriesFit& of,
                                         Measure measure) {
  std::vector<double> x, y;
  for (const SeriesRow& row : rows) {
    if (row.body != of.body || row.partner != of.partner) continue;
    const double value = measure(row);
    if (!(value > 0)) continue;
    x.push_back(row.counts.total_faces);
    y.push_back(value);
  }
  if (x.size() < 2) return std::nullopt;
  return resolutions::fit_power(x, y);
}

}  // namespace

std::vector<SeriesFit> series_fits(std::span<const SeriesRow> rows) {
  std::vector<SeriesFit> fits;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (r > 0 && rows[r].body == rows[r - 1].body && rows[r].partner == rows[r - 1].partner) continue;
    for (const std::size_t i : kScalable) {
      SeriesFit f{rows[r].body, rows[r].partner, i, {}, {}, {}};
      f.comparisons =
          fit(rows, f, [&](const SeriesRow& x) { return x.counts.recursions[i].comparisons.average; });
      f.refinements =
          fit(rows, f, [&](const SeriesRow& x) { return x.counts.recursions[i].refinements.average; });
      f.microseconds = fit(rows, f, [&](const SeriesRow& x) { return x.microseconds[i]; });
      fits.push_back(std::move(f));
    }
  }
  return fits;
}

std::vector<report::Table> add_series(const SeriesReport& report, report::Document& doc) {
  const std::vector<SeriesRow> rows = series_rows(report.a, report.objects, report.steps);
  const std::vector<SeriesFit> fits = series_fits(rows);
  for (const bool time : {false, true}) {
    std::vector<report::Chart> charts;
    for (const SeriesPartner partner : kSeriesPartners)
      for (const std::size_t i : kScalable) charts.push_back(chart(rows, fits, partner, i, time));
    std::erase_if(charts, [](const report::Chart& c) { return c.series.empty(); });
    doc.each(charts, &report::Document::chart);
    if (!charts.empty())
      doc.print(time ? "series-time" : "series-comparisons", time ? "time by size" : "comparisons by size",
                panels(charts));
  }
  doc.file("series.jsonl", to_json_lines(report.steps), "time steps of the resolutions");
  doc.file("series_times.jsonl", to_json_lines(report.steps, true), "the same with times of the queries");
  doc.file("series.json", series_json(rows, fits), "tables and fitted exponents as data");
  std::vector<report::Table> tables = {fit_table(fits, report.jobs)};
  for (const SeriesPartner partner : kSeriesPartners)
    for (const std::size_t i : kScalable) tables.push_back(table(rows, partner, i));
  return tables;
}

report::Table accelerator_table(std::span<const Mesh> bodies, const PaperProtocol& experiment,
                                const BuildOptions& building,
                                const std::function<void(const Mesh&)>& progress) {
  constexpr std::uint32_t kLids = 12;
  const PaperProtocol protocol = first_contacts(experiment, kAcceleratorCollisions);
  const std::string small = ", " + std::to_string(kLids) + " lids";
  report::Table t{
      "LRB-reps as an accelerator, at first contact",
      {"body", "real faces", "total over real", "total over real" + small, "tests by default", "paper",
       "paper_boxes", "paper_boxes" + small, "paper_wrapper_boxes" + small, "pairs missed" + small}};
  t.note =
      "Each body with itself, averages over " + std::to_string(protocol.collisions) +
      " approaches. Tests are those of boxes and faces; those of recursions are multiples of the default's. \"" +
      std::to_string(kLids) + " lids\": built with --max-lids " + std::to_string(kLids) +
      "; their missed pairs are those of both recursions.";
  Workspace workspace;
  for (const Mesh& body : bodies) {
    const LrbRep usual = build_lrb(body, building);
    BuildOptions small_regions = building;
    small_regions.max_lids = kLids;
    const LrbRep few_lids = build_lrb(body, small_regions);
    struct Query {
      const LrbRep& rep;
      Recursion recursion;
      std::optional<std::size_t> counts = {};  ///< of run_collision(), which asks this query
      double tests = 0;
    } queries[] = {{usual, Recursion::complete, kRecursions.size() - 1},
                   {usual, Recursion::paper, kPaper},
                   {usual, Recursion::paper_boxes},
                   {few_lids, Recursion::paper_boxes},
                   {few_lids, Recursion::paper_wrapper_boxes}};
    std::uint64_t pairs = 0, missed = 0;
    for (std::uint32_t i = 0; i < protocol.collisions; ++i)
      for (const ContactStep& s : run_collision(usual, usual, body.name, i, protocol, workspace, true))
        for (Query& q : queries) {
          if (q.counts) {
            q.tests += static_cast<double>(s.counts[*q.counts].comparisons + s.counts[*q.counts].box_tests);
            continue;
          }
          CollideRequest request;
          request.recursion = q.recursion;
          const CollideResult& found = collide(q.rep, s.pose_a, q.rep, s.pose_x, request, workspace).value();
          q.tests += static_cast<double>(found.counters.face_tests + found.counters.box_tests);
          if (&q.rep != &few_lids) continue;
          pairs += s.counts.back().pairs;
          missed += s.counts.back().pairs - found.pairs.size();
        }
    const auto total_over_real = [](const LrbRep& rep) {
      return fixed(static_cast<double>(rep.face_count()) / rep.real_face_count(), 2);
    };
    t.rows.push_back({body.name, render::group_digits(usual.real_face_count()), total_over_real(usual),
                      total_over_real(few_lids), whole(queries[0].tests / protocol.collisions)});
    for (std::size_t i = 1; i < std::size(queries); ++i)
      t.rows.back().push_back(fixed(queries[i].tests / queries[0].tests, 1));
    t.rows.back().push_back(render::group_digits(missed) + " of " + render::group_digits(pairs));
    if (progress) progress(body);
  }
  return t;
}

}  // namespace lrb::paper

#include "bench/levels/level_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "bench/rivals/triangles.hpp"
#include "bench/workers/child.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/run_page.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::levels {
namespace {

constexpr const char* kDistance = "distance from the body / largest side of its box";

/// A series: distances as shares, faces, and how it is drawn.
struct CurveSeries {
  const char* name;
  const char* title;
  const char* print_style;
  const char* colour;
  std::vector<double> distances, faces;
  void add(double distance, std::uint32_t count) {
    if (!(distance > 0)) return;  // has no place on a logarithmic axis
    distances.push_back(distance);
    faces.push_back(count);
  }
};

std::vector<CurveSeries> series_of(const LevelCurve& c) {
  CurveSeries proved{
      "proved", "wrappers that enclose the body: proved", "linespoints lw 1.5 pt 7 ps 0.35", "#0072b2", {},
      {}};
  CurveSeries measured{"measured", "the same, measured", "points lw 1.2 pt 6 ps 0.9", "#56b4e9", {}, {}};
  CurveSeries both{"both_ways",
                   "free simplification (CGAL), both ways: measured",
                   "linespoints lw 1.5 pt 5 ps 0.6",
                   "#d55e00",
                   {},
                   {}};
  CurveSeries one{
      "one_way", "the same, from it to the body only: measured", "points lw 1.2 pt 4 ps 1", "#e69f00", {},
      {}};
  for (const bodies::LevelFigures& l : c.proved) proved.add(l.bound / c.size, l.faces);
  for (const ShownLevel& l : c.shown) measured.add(l.sampled / c.size, l.figures.faces);
  for (const FreeMesh& m : c.free) {
    both.add(std::max(m.to_body, m.from_body) / c.size, m.faces);
    one.add(m.to_body / c.size, m.faces);
  }
  std::vector<CurveSeries> out;
  for (CurveSeries& s : {std::ref(proved), std::ref(measured), std::ref(both), std::ref(one)})
    if (!s.faces.empty()) out.push_back(std::move(s));
  return out;
}

}  // namespace

std::vector<bodies::LevelFigures> many_levels(const LrbRep& rep, std::span<const double> shares,
                                              unsigned threads) {
  constexpr double kStep = 1.25, kBelow = 2;
  const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
  std::vector<double> row(shares.begin(), shares.end());
  for (double share = *least / kBelow; share < *most; share *= kStep) row.push_back(share);
  std::sort(row.begin(), row.end());
  std::vector<bodies::LevelFigures> levels = bodies::level_figures(rep, row, threads);
  const auto same = [](const auto& a, const auto& b) { return a.bound == b.bound; };
  levels.erase(std::unique(levels.begin(), levels.end(), same), levels.end());
  return levels;
}

report::Gnuplot curve_for_print(const LevelCurve& c) {
  report::Gnuplot g;
  g.width = 130;
  g.height = 95;
  std::string plots;
  double least = 1, most = 0;
  for (const CurveSeries& s : series_of(c)) {
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < s.faces.size(); ++i) {
      rows.push_back(io::number_text(s.distances[i]) + " " + io::number_text(s.faces[i]));
      least = std::min(least, s.distances[i]);
      most = std::max(most, s.distances[i]);
    }
    g.add_data(s.name, rows);
    plots += (plots.empty() ? "plot $" : ", $") + std::string(s.name) + " using 1:2 with " + s.print_style +
             " lc rgb '" + s.colour + "' title " + report::gnuplot_text(s.title);
  }
  constexpr double kRoom = 1.25;
  g.script +=
      "set logscale xy\nset xlabel " + report::gnuplot_text(kDistance) + "\nset ylabel 'faces'\n" +
      "set xrange [" + io::number_text(least / kRoom) + ":" + io::number_text(most * kRoom) + "]\n" +
      "set yrange [10:" + io::number_text(3.0 * c.real_faces) + "]\n" +
      "set key bottom left reverse Left\nset grid lc rgb '#dddddd'\nset border 3\nset tics nomirror out\n" +
      "set format y '%g'\nset format x '%g'\n" + plots + ", " + std::to_string(c.real_faces) +
      " with lines dt 3 lc rgb '#777777' title " +
      report::gnuplot_text("the body: " + std::to_string(c.real_faces) + " faces") + "\n";
  return g;
}

report::PageChart curve_for_page(const LevelCurve& c) {
  report::PageChart chart;
  chart.title = "Faces against distance";
  chart.x_label = kDistance;
  chart.y_label = "faces";
  chart.note =
      "A wrapper is off to one side only, because it encloses the body; a free mesh may cut through it, and "
      "for the same distance needs about half of the faces.";
  chart.log_x = chart.log_y = true;
  for (CurveSeries& s : series_of(c)) {
    // The page wants x ascending.
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < s.faces.size(); ++i) points.emplace_back(s.distances[i], s.faces[i]);
    std::sort(points.begin(), points.end());
    report::PageSeries series;
    series.label = s.title;
    for (const auto& [x, y] : points) {
      series.x.push_back(x);
      series.y.push_back(y);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

namespace {

using Json = nlohmann::ordered_json;

Json report_json(const LrbRep& rep, const LevelCurve& curve) {
  Json j;
  j["name"] = rep.name();
  j["real_faces"] = curve.real_faces;
  j["largest_side"] = curve.size;
  std::vector<bodies::LevelFigures> figures;
  for (const ShownLevel& l : curve.shown) figures.push_back(l.figures);
  j["levels"] = bodies::level_json(figures);
  for (std::size_t i = 0; i < curve.shown.size(); ++i) {
    j["levels"][i]["sampled"] = curve.shown[i].sampled;
    j["levels"][i]["caption"] = caption_of(figures[i], curve.size);
  }
  j["curve"] = bodies::level_json(curve.proved);
  j["free"] = Json::array();
  for (const FreeMesh& m : curve.free)
    j["free"].push_back({{"faces", m.faces}, {"to_body", m.to_body}, {"from_body", m.from_body}});
  return j;
}

report::PageTable level_table(const LevelCurve& c) {
  report::PageTable t;
  t.title = "Wrappers";
  t.columns = {"tolerance", "faces", "proved off", "measured", "proved / measured"};
  if (!c.free.empty()) t.columns.emplace_back("a free mesh of as many faces: measured");
  for (const ShownLevel& l : c.shown) {
    t.rows.push_back({render::short_number(l.figures.share), render::group_digits(l.figures.faces),
                      l.figures.bound > 0 ? upward_text(l.figures.bound / c.size) : "0",
                      render::short_number(l.sampled / c.size),
                      l.sampled > 0 ? render::short_number(l.figures.bound / l.sampled) : "\u2013"});
    if (c.free.empty()) continue;
    const auto free = std::find_if(c.free.begin(), c.free.end(),
                                   [&](const FreeMesh& m) { return m.faces == l.figures.faces; });
    t.rows.back().push_back(free == c.free.end()
                                ? "\u2013"
                                : render::short_number(std::max(free->to_body, free->from_body) / c.size));
  }
  t.note =
      "Distances as shares of the largest side of the body's box. Proved: no point of the wrapper is "
      "further from the body. Measured: the largest distance found at points of the lids, which cannot be "
      "more.";
  return t;
}

report::Page page_of(const LrbRep& rep, const LevelCurve& curve, const std::string& command) {
  report::Page page;
  page.title = rep.name() + ", no finer than a scene needs";
  page.purpose =
      "Wrappers of the body, each with as few faces as its LRB-rep has for a tolerance, and how far they "
      "are off.";
  page.numbers = {
      {"Real faces", render::group_digits(curve.real_faces), ""},
      {"Faces in all", render::group_digits(rep.face_count()),
       render::short_number(static_cast<double>(rep.face_count()) / curve.real_faces) + " per real one"},
      {"Regions", render::group_digits(rep.region_count()),
       "in " + std::to_string(rep.layer_count()) + " layers"},
      {"Largest side of the box", render::short_number(curve.size), "in the mesh's unit"}};
  page.charts = {curve_for_page(curve)};
  page.tables = {level_table(curve)};
  page.command = command;
  page.links = {{"levels.json", "levels.json", "all of these numbers"}};
  page.footer = report::footer();
  return page;
}

/// Draws the curve for print; without gnuplot it is left out.
void write_curve(const LevelCurve& curve, const std::string& folder, report::Page& page,
                 std::vector<std::string>& notes) {
  try {
    const report::Gnuplot chart = curve_for_print(curve);
    for (const char* file : {"curve.svg", "curve.png"}) {
      report::draw(chart, folder + "/" + file);
      page.links.push_back({file, file, "faces against distance, for print"});
    }
  } catch (const EnvironmentError& e) {
    notes.emplace_back(e.what());
  }
}

}  // namespace

void check_drawable(const LrbRep& rep, std::vector<double>& shares) {
  const std::string name = printable_name(rep.name());
  if (!rep.closed())
    throw InputError(name + ": is not closed, so that it has no wrappers to draw; leave out -o");
  if (rep.self_intersecting())
    throw InputError(
        name +
        ": crosses itself; no wrapper of it is proved to be near it, so there is nothing to draw; leave "
        "out -o");
  std::sort(shares.begin(), shares.end());
  shares.erase(std::unique(shares.begin(), shares.end()), shares.end());
  if (shares.empty() || shares.size() > kMostPanels || shares.front() < kLeastShare)
    throw InputError("--at: found " + std::to_string(shares.size()) + " tolerances" +
                     (shares.empty() ? "" : " from " + render::short_number(shares.front()) + " on") +
                     ", expected for pictures 1 to " + std::to_string(kMostPanels) + " of at least 1e-6");
}

std::vector<std::string> write_level_report(const LrbRep& rep, const LevelReportOptions& options,
                                            const std::string& folder) {
  std::vector<std::string> notes;
  const ShownBody shown{&rep, bodies::largest_side(rep), options.view, options.threads};
  LevelCurve curve{
      shown.size, rep.real_face_count(), many_levels(rep, options.shares, options.threads), {}, {}};
  for (const bodies::LevelFigures& l : bodies::level_figures(rep, options.shares, options.threads))
    curve.shown.push_back({l, 0});
  const render::Image wrappers = draw_wrappers(shown, curve.shown);
  const render::Image distances = draw_distances(shown, curve.shown);
  std::vector<std::uint32_t> counts;
  for (const ShownLevel& l : curve.shown)
    if (l.figures.bound > 0 && (counts.empty() || l.figures.faces < counts.back()))
      counts.push_back(l.figures.faces);
  curve.free = simplify_freely(rep, counts);
  if (curve.free.empty() && rep.dim() == 3)
    notes.emplace_back(
        "no free simplification to compare with: it needs libcgal-dev, and the target lrbscope-simplify");

  make_folder(folder);
  const io::FolderLock lock(folder);
  io::refuse_links(folder);
  report::Page page = page_of(rep, curve, options.command);
  render::write_png(wrappers, folder + "/wrappers.png");
  run::add_figure(page, folder, "Wrappers", "What stays of the body at each tolerance.", "wrappers.png");
  render::write_png(distances, folder + "/distances.png");
  run::add_figure(
      page, folder, "Where they are off",
      "Distance from the body over the lids of each wrapper, on one scale. Real faces, which are off by "
      "nothing, are pale.",
      "distances.png");
  write_curve(curve, folder, page, notes);
  io::write_text(folder + "/levels.json", report_json(rep, curve).dump(1) + "\n");
  io::write_text(folder + "/index.html", report::page_html(page));
  return notes;
}

namespace {

/// Returns the real triangles as OFF.
std::string off_text(const LrbRep& rep) {
  constexpr int kAllDigits = 17;
  const Mesh mesh = methods::real_mesh(rep);
  std::ostringstream out;
  out << "OFF\n" << mesh.vertices.size() << " " << rep.real_simplex_count() << " 0\n";
  for (const Eigen::Vector3d& v : mesh.vertices)
    out << io::number_text(v.x(), kAllDigits) << " " << io::number_text(v.y(), kAllDigits) << " "
        << io::number_text(v.z(), kAllDigits) << "\n";
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    for (std::size_t i = 1; i + 1 < mesh.face(f).size(); ++i)
      out << "3 " << mesh.face(f)[0].value() << " " << mesh.face(f)[i].value() << " "
          << mesh.face(f)[i + 1].value() << "\n";
  return out.str();
}

}  // namespace

std::vector<FreeMesh> simplify_freely(const LrbRep& rep, std::span<const std::uint32_t> face_counts) {
  constexpr std::chrono::seconds kLimit(600);
  const std::string program = workers::program_beside("lrbscope-simplify");
  if (program.empty() || rep.dim() != 3) return {};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> mesh(std::tmpfile(), &std::fclose);
  const std::string text = off_text(rep);
  if (!mesh || std::fputs(text.c_str(), mesh.get()) < 0 || std::fflush(mesh.get()) != 0) return {};
  std::vector<std::string> command = {program};
  for (const std::uint32_t n : face_counts) command.push_back(std::to_string(n));
  std::vector<FreeMesh> out;
  for (const std::string& line : workers::lines_of(command, kLimit, fileno(mesh.get()))) {
    FreeMesh m{};
    if (std::istringstream(line) >> m.faces >> m.to_body >> m.from_body) out.push_back(m);
  }
  return out;
}

}  // namespace lrb::levels

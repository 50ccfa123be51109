#include "bench/levels/level_report.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/workers/child.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::levels {
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

report::Chart curve_chart(const LevelCurve& c) {
  constexpr double kRoom = 1.25;
  std::vector<report::Series> all = {
      {"enclosing wrappers: proven", {}, {}, {report::Line::straight, "#0072b2", "circle"}},
      {"the same, measured", {}, {}, {report::Line::none, "#56b4e9", "rectRot"}},
      {"free simplification (CGAL), both ways: measured",
       {},
       {},
       {report::Line::straight, "#d55e00", "rect"}},
      {"the same, from it to the body only: measured", {}, {}, {report::Line::none, "#e69f00", "triangle"}}};
  double least = 1, most = 0;
  const auto add = [&](std::size_t series, double distance, std::uint32_t faces) {
    const double x = distance / c.size;
    if (!(x > 0)) return;  // cannot be on a logarithmic axis
    const auto at = std::upper_bound(all[series].x.begin(), all[series].x.end(), x) - all[series].x.begin();
    all[series].x.insert(all[series].x.begin() + at, x);
    all[series].y.insert(all[series].y.begin() + at, faces);
    least = std::min(least, x);
    most = std::max(most, x);
  };
  for (const bodies::LevelFigures& l : c.proved) add(0, l.bound, l.faces);
  for (const ShownLevel& l : c.shown) add(1, l.sampled, l.figures.faces);
  for (const FreeMesh& m : c.free) {
    add(2, std::max(m.to_body, m.from_body), m.faces);
    add(3, m.to_body, m.faces);
  }
  const double faces = c.real_faces;
  all.push_back({"the body: " + std::to_string(c.real_faces) + " faces",
                 {least / kRoom, most * kRoom},
                 {faces, faces},
                 {report::Line::dashed, "#777777", "none"}});
  std::erase_if(all, [](const report::Series& s) { return s.x.empty(); });
  return {
      "Faces by deviation",
      {"deviation / largest side of the body's box", true, least / kRoom, most * kRoom},
      {"faces", true},
      std::move(all),
      "A wrapper deviates to one side only, because it encloses the body; a free mesh may cut through it, and for the "
      "same deviation needs about half of the faces."};
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

report::Table level_table(const LevelCurve& c) {
  report::Table t{"Wrappers", {"tolerance", "faces", "proven deviation", "measured", "proven / measured"}};
  if (!c.free.empty()) t.columns.emplace_back("free mesh of as many faces: measured");
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
      "Deviations as shares of the largest side of the body's box. Proven: an upper bound for all points of the wrapper. "
      "Measured: the maximum over sampled points of the lids, a lower bound.";
  return t;
}

}  // namespace

void check_drawable(const LrbRep& rep, std::vector<double>& shares) {
  const std::string name = printable_name(rep.name());
  if (!rep.closed())
    throw InputError(name + ": is not closed, so that it has no wrappers to draw; leave out -o");
  if (rep.self_intersecting())
    throw InputError(
        name +
        ": intersects itself, so no wrapper has a proven deviation and there is nothing to draw; leave "
        "out -o");
  std::sort(shares.begin(), shares.end());
  shares.erase(std::unique(shares.begin(), shares.end()), shares.end());
  if (shares.empty() || shares.size() > kMaxPanels || shares.front() < kMinShare)
    throw InputError("--at: found " + std::to_string(shares.size()) + " tolerances" +
                     (shares.empty() ? "" : " from " + render::short_number(shares.front()) + " on") +
                     ", expected for pictures 1 to " + std::to_string(kMaxPanels) + " of at least 1e-6");
}

std::vector<std::string> write_level_report(const LrbRep& rep, const LevelReportOptions& options,
                                            const std::string& folder) {
  std::vector<std::string> notes;
  const ShownBody shown{&rep, bodies::largest_side(rep), options.view, options.threads};
  LevelCurve curve{
      shown.size, rep.real_face_count(), many_levels(rep, options.shares, options.threads), {}, {}};
  for (const bodies::LevelFigures& l : bodies::level_figures(rep, options.shares, options.threads))
    curve.shown.push_back({l, 0});
  const render::Image distances = draw_distances(shown, curve.shown);
  std::vector<std::uint32_t> counts;
  for (const ShownLevel& l : curve.shown)
    if (l.figures.bound > 0 && (counts.empty() || l.figures.faces < counts.back()))
      counts.push_back(l.figures.faces);
  curve.free = simplify_freely(rep, counts);
  if (curve.free.empty() && rep.dim() == 3)
    notes.emplace_back(
        "no free simplification to compare with: it needs libcgal-dev, and the target lrbscope-simplify");

  report::Document doc(
      rep.name() + ", levels of detail",
      "Wrappers of the body, each with as few faces as its LRB-rep has for a tolerance, and their deviation.");
  doc.command(options.command)
      .number({"Real faces", render::group_digits(curve.real_faces)})
      .number(
          {"All faces", render::group_digits(rep.face_count()),
           render::short_number(static_cast<double>(rep.face_count()) / curve.real_faces) + " per real one"})
      .number({"Regions", render::group_digits(rep.region_count()),
               "in " + std::to_string(rep.layer_count()) + " layers"})
      .number({"Largest side of the box", render::short_number(curve.size), "mesh units"});
  const report::Chart chart = curve_chart(curve);
  doc.file("levels.json", report_json(rep, curve).dump(1) + "\n", "all of these numbers").chart(chart);
  doc.table(level_table(curve))
      .picture("wrappers.png", draw_wrappers(shown, curve.shown), "Wrappers",
               "The wrapper at each tolerance.")
      .picture(
          "distances.png", distances, "Deviation",
          "Distance from the body over the lids of each wrapper, on one scale. Real faces, without deviation, are pale.")
      .print("curve", "faces by deviation, for print",
             report::gnuplot({&chart, 1}, {1, 110, 78, 8, "bottom left"}));
  notes.insert(notes.end(), doc.notes().begin(), doc.notes().end());
  doc.write(folder);
  return notes;
}

namespace {

/// Returns the real triangles in OFF format.
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

#include "bench/levels/level_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/workers/workers.hpp"
#include "engine/lrb/thickness.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::levels {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

// Distances of lids from the body, sampled.

/// A piece of a lid, small enough for one colour.
struct LidPiece {
  /// Mesh's frame; 2D: the third is not used.
  std::array<Eigen::Vector3d, 3> x{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double off = 0;  ///< distance of its centroid from the nearest real face; mesh's unit
};

struct MeasuredLids {
  std::vector<LidPiece> pieces;
  /// The largest distance at the pieces' centroids and the lids' corners: at most the true maximum, up to
  /// rounding.
  double largest = 0;
};

/// Splits a triangle at the midpoint of its longest edge until all edges are short. Neighbours split a shared
/// edge at the same points, so there are no cracks.
void cut_triangle(LidPiece triangle, double longest, std::vector<LidPiece>& out) {
  std::vector<LidPiece> left = {triangle};
  while (!left.empty()) {
    const LidPiece t = left.back();
    left.pop_back();
    double length[3];
    for (int i = 0; i < 3; ++i) length[i] = (t.x[(i + 1) % 3] - t.x[i]).norm();
    const int k = static_cast<int>(std::max_element(length, length + 3) - length);
    if (!(length[k] > longest)) {
      out.push_back(t);
      continue;
    }
    const Vector3d a = t.x[k], b = t.x[(k + 1) % 3], c = t.x[(k + 2) % 3], midpoint = (a + b) / 2;
    left.push_back({{a, midpoint, c}, 0});
    left.push_back({{midpoint, b, c}, 0});
  }
}

void cut_segment(const Vector3d& a, const Vector3d& b, double longest, std::vector<LidPiece>& out) {
  const int count = std::max(1, static_cast<int>(std::ceil((b - a).norm() / longest)));
  for (int i = 0; i < count; ++i)
    out.push_back({{a + (b - a) * i / count, a + (b - a) * (i + 1) / count, Vector3d::Zero()}, 0});
}

void cut_lid(const LrbRep& rep, FaceId lid, double longest, std::vector<LidPiece>& out) {
  const auto corners = rep.face(lid);
  const auto x = [&](std::size_t i) { return rep.vertices()[corners[i]]; };
  if (rep.dim() == 2) return cut_segment(x(0), x(1), longest, out);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    cut_triangle({{x(0), x(i), x(i + 1)}, 0}, longest, out);
}

/// Measures distances of points. The nearest face of a point is the first candidate for the next.
class Gauge {
 public:
  Gauge(const LrbRep& rep, const std::vector<RealSimplex>& simplices)
      : unit_(rep.tree().unit()), nearest_(rep, simplices) {}

  double off(const Vector3d& x) {
    const Vector3d p = x / unit_;
    if (last_.simplex != kNull) last_.distance = nearest_.distance(p, last_.simplex);
    last_ = nearest_.find(p, last_);
    return last_.distance * unit_;
  }

 private:
  double unit_;
  NearestFace nearest_;
  NearFace last_;
};

/// Splits lids into pieces with edges of at most `longest` (mesh's unit), and measures each. The result does
/// not depend on the number of threads.
MeasuredLids measure_lids(const LrbRep& rep, std::span<const FaceId> lids, double longest, unsigned threads) {
  constexpr std::size_t kAtOnce = 16;  // lids per task
  const std::vector<RealSimplex> simplices = real_simplices(rep);
  std::vector<MeasuredLids> parts((lids.size() + kAtOnce - 1) / kAtOnce);
  const int corners = rep.dim();
  Workers(threads).for_each(parts.size(), [&](std::size_t i, unsigned) {
    MeasuredLids& part = parts[i];
    Gauge gauge(rep, simplices);
    for (const FaceId lid : lids.subspan(i * kAtOnce, std::min(kAtOnce, lids.size() - i * kAtOnce))) {
      const std::size_t first = part.pieces.size();
      cut_lid(rep, lid, longest, part.pieces);
      for (std::size_t k = first; k < part.pieces.size(); ++k) {
        LidPiece& p = part.pieces[k];
        Vector3d sum = p.x[0] + p.x[1];
        if (corners == 3) sum += p.x[2];
        p.off = gauge.off(sum / corners);
        part.largest = std::max(part.largest, p.off);
      }
      for (const VertexId v : rep.face(lid))
        part.largest = std::max(part.largest, gauge.off(rep.vertices()[v]));
    }
  });
  MeasuredLids out;
  for (MeasuredLids& part : parts) {
    out.pieces.insert(out.pieces.end(), part.pieces.begin(), part.pieces.end());
    out.largest = std::max(out.largest, part.largest);
  }
  return out;
}

// Pictures of the wrappers.

/// The body in the pictures, and its view.
struct ShownBody {
  const LrbRep* rep;
  double size;  ///< largest side of the body's box; distances are fractions of it
  render::ViewDirection view;
  unsigned threads;
};

/// The wrapper of a panel.
struct ShownLevel {
  bodies::LevelFigures figures;
  double sampled = 0;  ///< largest sampled distance of its lids; mesh's unit
};

/// Returns a positive number with three significant digits, rounded up, so that it remains an upper bound.
std::string upward_text(double value) {
  constexpr int kDigits = 3;
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", kDigits, value);
  if (std::strtod(text, nullptr) < value) {
    const double step = std::pow(10.0, std::floor(std::log10(value)) - (kDigits - 1));
    std::snprintf(text, sizeof text, "%.*g", kDigits, std::strtod(text, nullptr) + step);
  }
  return text;
}

/// Returns the caption of a panel.
std::string caption_of(const bodies::LevelFigures& level, double size) {
  return "tolerance " + render::short_number(level.share) + ": " + render::group_digits(level.faces) +
         " faces, " + (level.bound > 0 ? "proved " + upward_text(level.bound / size) : "the body");
}

constexpr int kPanelWidth = 600, kPanelHeight = 480;
constexpr float kCaptionHeight = 24;
constexpr double kPieces = 120;  ///< pieces of lids along the largest side, of about four pixels each

/// Returns the camera that shows the body and the coarsest wrapper.
run::CameraFit camera_for(const ShownBody& shown, std::span<const ShownLevel> levels) {
  const LrbRep& rep = *shown.rep;
  double coarsest = 0;
  for (const ShownLevel& l : levels) coarsest = std::max(coarsest, l.figures.tolerance);
  std::vector<Eigen::Vector3d> points;
  for (const FaceId f : bodies::wrapper_at(rep, coarsest, shown.threads).boundary())
    for (const Eigen::Vector3d& x : run::corners_of(rep, f)) points.push_back(x);
  render::FitOptions fit;
  fit.view = shown.view;
  return run::fit_points(points, rep.dim(), fit);
}

render::Image draw_sheet(const std::vector<run::Panel>& panels, const render::Overlay& overlay) {
  render::Look look;
  look.width = kPanelWidth;
  look.height = kPanelHeight;
  render::MontageOptions options;
  options.columns = 4;
  options.text_height = kCaptionHeight;
  return run::with_overlay(run::draw_sheet(panels, look, options), overlay);
}

render::DrawList wrapper_list(const LrbRep& rep, const Wrapper& wrapper) {
  render::SceneBody body;
  body.rep = &rep;
  body.wrapper = &wrapper;
  return render::build_scene({&body, 1}).list;
}

void add_solid_2d(const LrbRep& rep, render::DrawList& list) {
  render::DrawFill solid;
  solid.colour = render::palette::kPaleFront;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    solid.segments.push_back({rep.vertices()[rep.face(f)[0]], rep.vertices()[rep.face(f)[1]]});
  list.fills.push_back(std::move(solid));
}

void add_pieces(const LrbRep& rep, const MeasuredLids& lids, const render::ScaleBar& scale, double size,
                render::DrawList& list) {
  for (const LidPiece& p : lids.pieces) {
    const render::Rgba colour = render::palette::viridis(render::place_on(scale, p.off / size));
    if (rep.dim() == 2) {
      render::DrawLine line;
      line.points = {p.x[0], p.x[1]};
      line.colour = colour;
      line.width = 4;
      list.lines.push_back(std::move(line));
      continue;
    }
    render::DrawTriangle t;
    t.x = p.x;
    t.colour = colour;
    t.nudge = 1;  // in a region without volume a lid coincides with its floor
    list.triangles.push_back(t);
  }
}

/// Draws the edges of lids, unless there are so many that they would hide the colours.
void add_edges(const LrbRep& rep, const std::vector<FaceId>& boundary, render::DrawList& list) {
  constexpr std::size_t kMax = 2500;
  std::vector<std::pair<VertexId, VertexId>> edges;
  for (const FaceId f : boundary) {
    if (rep.is_real(f)) continue;
    const auto corners = rep.face(f);
    for (std::size_t i = 0; i < corners.size(); ++i)
      edges.push_back(std::minmax(corners[i], corners[(i + 1) % corners.size()]));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  if (edges.size() > kMax) return;
  for (const auto& [a, b] : edges) {
    render::DrawLine line;
    line.points = {rep.vertices()[a], rep.vertices()[b]};
    line.colour = render::with_alpha(render::kWhite, 120);
    line.width = 1.1F;
    line.layer = render::Layer::translucent;
    line.nudge = 2;
    list.lines.push_back(std::move(line));
  }
}

/// Draws a wrapper: lids in the scale's colours, real faces (deviation 0) pale.
render::DrawList distance_list(const LrbRep& rep, const std::vector<FaceId>& boundary,
                               const MeasuredLids& lids, const render::ScaleBar& scale, double size) {
  render::DrawList list;
  if (rep.dim() == 2) add_solid_2d(rep, list);
  for (const FaceId f : boundary) {
    if (!rep.is_real(f)) continue;
    const std::vector<Eigen::Vector3d> corners = run::corners_of(rep, f);
    if (rep.dim() == 3) {
      render::DrawTriangle t;
      t.colour = render::palette::kPaleFront;
      list.add_polygon(corners, t);
    } else {
      render::DrawLine line;
      line.points = corners;
      line.colour = render::palette::kFaint;
      line.width = 1.5F;
      list.lines.push_back(std::move(line));
    }
  }
  add_pieces(rep, lids, scale, size, list);
  if (rep.dim() == 3) add_edges(rep, boundary, list);
  return list;
}

/// Returns a scale for a list of tolerances: from half of the smallest to the largest.
render::ScaleBar scale_for(std::span<const ShownLevel> levels) {
  constexpr double kBelow = 2, kMinRange = 10;
  double low = 1, high = 0;
  for (const ShownLevel& l : levels) {
    low = std::min(low, l.figures.share / kBelow);
    high = std::max(high, l.figures.share);
  }
  return {"deviation from the body / longest side of its box", std::min(low, high / kMinRange), high, true};
}

/// Draws the body and its wrappers side by side, each with its number of faces and its proven maximum
/// deviation.
render::Image draw_wrappers(const ShownBody& shown, std::span<const ShownLevel> levels) {
  const LrbRep& rep = *shown.rep;
  const run::CameraFit camera = camera_for(shown, levels);
  std::vector<run::Panel> panels;
  if (levels.front().figures.bound > 0) {  // no level is the body itself
    Wrapper bare(rep);
    bare.refine_all();
    panels.push_back({wrapper_list(rep, bare), camera,
                      "the body, " + render::group_digits(rep.real_face_count()) + " faces", false});
  }
  for (const ShownLevel& l : levels)
    panels.push_back({wrapper_list(rep, bodies::wrapper_at(rep, l.figures.tolerance, shown.threads)), camera,
                      caption_of(l.figures, shown.size), false});
  render::Overlay overlay;
  overlay.title = rep.name() + ": wrappers at several tolerances";
  overlay.event =
      "Each wrapper encloses the body. Below it: its proven maximum deviation, as a fraction of the longest "
      "side of the box.";
  return draw_sheet(panels, overlay);
}

/// Draws the distance of each wrapper's lids from the body, on a common scale, and stores the largest
/// distance found for each level in `levels`.
render::Image draw_distances(const ShownBody& shown, std::span<ShownLevel> levels) {
  const LrbRep& rep = *shown.rep;
  const run::CameraFit camera = camera_for(shown, levels);
  render::Overlay overlay;
  overlay.title = rep.name() + ": deviation of its wrappers";
  overlay.event = "Colours are measured at points; numbers are proven bounds.";
  overlay.key = {{render::LegendItem::Mark::solid, render::palette::kPaleFront, "real faces, deviation 0"}};
  overlay.scale = scale_for(levels);
  std::vector<run::Panel> panels;
  for (ShownLevel& l : levels) {
    const std::vector<FaceId> boundary =
        bodies::wrapper_at(rep, l.figures.tolerance, shown.threads).boundary();
    std::vector<FaceId> lids;
    for (const FaceId f : boundary)
      if (!rep.is_real(f)) lids.push_back(f);
    const MeasuredLids measured = measure_lids(rep, lids, shown.size / kPieces, shown.threads);
    l.sampled = measured.largest;
    panels.push_back({distance_list(rep, boundary, measured, *overlay.scale, shown.size), camera,
                      caption_of(l.figures, shown.size), false, run::kScaleLighting});
  }
  return draw_sheet(panels, overlay);
}
// Free simplifications, for comparison.

/// A simplification that need not enclose the body, with its distances as measured by CGAL.
struct FreeMesh {
  std::uint32_t faces;
  double to_body, from_body;  ///< one-sided Hausdorff distances, sampled; mesh's unit
};

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

/// Simplifies the real faces to about these numbers of faces (descending) with the program lrbscope-simplify,
/// which exists if CGAL was found at build time. Returns an empty list without it, for a 2D body, or if CGAL
/// rejects the mesh.
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
// Numbers, chart and table.

/// The number of faces that a body needs for each maximum deviation.
struct LevelCurve {
  double size;                               ///< largest side of the body's box
  std::uint32_t real_faces;                  ///< of the body
  std::vector<bodies::LevelFigures> proved;  ///< one wrapper per tolerance, finest first
  std::vector<ShownLevel> shown;             ///< those that were also sampled
  std::vector<FreeMesh> free;                ///< most faces first; may be empty
};

/// Returns wrappers at many tolerances, from half of the smallest share to the largest, without duplicates.
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

/// Returns the chart of faces over deviation, both axes logarithmic.
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
  constexpr std::size_t kMaxPanels = 24;
  constexpr double kMinShare = 1e-6;  // the least that the scale can show
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

}  // namespace lrb::levels

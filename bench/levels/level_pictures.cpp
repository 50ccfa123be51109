#include "bench/levels/level_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "engine/lrb/thickness.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/parallel.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::levels {
namespace {

using Eigen::Vector3d;

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

}  // namespace

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

namespace {

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

}  // namespace

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

std::string caption_of(const bodies::LevelFigures& level, double size) {
  return "tolerance " + render::short_number(level.share) + ": " + render::group_digits(level.faces) +
         " faces, " + (level.bound > 0 ? "proved " + upward_text(level.bound / size) : "the body");
}

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

}  // namespace lrb::levels

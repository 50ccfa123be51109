#include "bench/stability/case_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "bench/methods/triangles.hpp"
#include "bench/stability/case_meshes.hpp"
#include "bench/stability/rational_oracles.hpp"
#include "bench/stability/stability_report.hpp"
#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>

namespace lrb::stability {

using Eigen::AlignedBox3d, Eigen::Vector3d;

render::Rgba colour_of(Mark m) {
  if (m == Mark::missed) return render::palette::kWrong;
  return m == Mark::extra ? render::Rgba{84, 40, 150} : render::palette::kGreen;
}

Verdict compare(std::span<const SimplexPair> expected, const std::optional<Pairs>& answered) {
  Pairs e(expected.begin(), expected.end()), a = answered.value_or(e);
  for (Pairs* list : {&e, &a}) std::sort(list->begin(), list->end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  Verdict out;
  out.listed = answered.has_value();
  std::set_intersection(e.begin(), e.end(), a.begin(), a.end(), std::back_inserter(out.found));
  out.missed = methods::without(e, a);
  out.extra = methods::without(a, e);
  return out;
}

namespace {

/// The two bodies in world coordinates, with the marks of their real simplices.
struct CasePicture {
  /// A face without a marked simplex, or a simplex of another one.
  struct Piece {
    Corners corners;
    Mark mark = Mark::none;
  };
  std::array<std::vector<Piece>, 2> bodies;
  std::array<Eigen::AlignedBox3d, 2> boxes;
  bool flat = false;
  /// Marks all over the bodies would hide one another.
  bool crowded = false;
  /// A mark is on every simplex, as in minimised cases. The bodies then have their own colours, because marks
  /// would not distinguish anything, and the worst pairs have places.
  bool all_marked = false;
  /// The intersections of the worst pairs, or the segments between their closest points; of many pairs the
  /// first.
  std::vector<Corners> places;

  CasePicture(const cases::Case& c, const Verdict& verdict);

 private:
  void add(std::size_t side, Corners corners, Mark mark);
};

CasePicture::CasePicture(const cases::Case& c, const Verdict& verdict) : flat(c.a->dim() == 2) {
  std::size_t marked = 0, all = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const LrbRep& rep = side == 0 ? *c.a : *c.b;
    const Pose& pose = side == 0 ? c.pose_a : c.pose_b;
    std::vector<Mark> marks(rep.real_simplex_count(), Mark::none);
    std::vector<bool> is_whole(rep.real_face_count(), !flat);
    const std::pair<const Pairs*, Mark> kinds[] = {
        {&verdict.found, Mark::found}, {&verdict.extra, Mark::extra}, {&verdict.missed, Mark::missed}};
    for (const auto& [pairs, mark] : kinds)
      for (const SimplexPair& p : *pairs) {
        const SimplexId s = side == 0 ? p.a : p.b;
        if (s >= marks.size())
          throw InputError("simplex " + std::to_string(s) + " of " + (side == 0 ? "A" : "B") +
                           ": expected a number below " + std::to_string(marks.size()));
        marks[s] = mark;
        is_whole[rep.face_of_simplex(s)] = false;
      }
    for (FaceId f = 0; f < is_whole.size(); ++f)
      if (is_whole[f]) add(side, pictures::corners_of(rep, f, pose), Mark::none);
    for (SimplexId s = 0; s < marks.size(); ++s)
      if (!is_whole[rep.face_of_simplex(s)]) add(side, pictures::corners_of(rep, pose, s), marks[s]);
    all += marks.size();
    marked += marks.size() - static_cast<std::size_t>(std::count(marks.begin(), marks.end(), Mark::none));
  }
  crowded = 4 * marked > all;
  all_marked = marked == all;
  constexpr std::size_t kFew = 32;
  if (!all_marked && verdict.mark() == Mark::found) return;
  for (const SimplexPair& p : verdict.worst())
    if (all_marked || places.size() < kFew) places.push_back(PosedPair(c, p).place());
}

void CasePicture::add(std::size_t side, Corners corners, Mark mark) {
  for (const Vector3d& x : corners) {
    if (!x.allFinite())
      throw InputError(std::string("body ") + (side == 0 ? "A" : "B") +
                       ": its world coordinates are not finite, so the case cannot be drawn");
    boxes[side].extend(x);
  }
  bodies[side].push_back({std::move(corners), mark});
}

/// Returns the length of a box's diagonal. Its square may overflow a double.
double diagonal(const AlignedBox3d& box) {
  return box.isEmpty() ? 0 : (box.max() / 4 - box.min() / 4).stableNorm() * 4;
}

/// Maps a box of the world to the cube [-1, 1]^3: its centre to the origin, its longest side to 2. Exactly,
/// because bodies may be of size 1e-120, at 1e16, or 1e60 times larger than the box.
class PictureFrame {
 public:
  explicit PictureFrame(const AlignedBox3d& box) {
    Rational radius = 0, largest = std::numeric_limits<double>::min();
    for (int k = 0; k < 3; ++k) {
      const Rational low = box.min()[k], high = box.max()[k];
      centre_[static_cast<std::size_t>(k)] = (low + high) / 2;
      radius = std::max<Rational>(radius, (high - low) / 2);
      largest = std::max<Rational>(largest, std::max<Rational>(abs(low), abs(high)));
    }
    scale_ = 1 / (radius > 0 ? radius : largest);  // bodies that have collapsed to a point are drawn as one
  }

  /// Returns the part of a segment or polygon in [-reach, reach]^3, or no corners if it is empty (I.
  /// Sutherland, G. Hodgman, "Reentrant Polygon Clipping", 1974).
  Corners cut(const Corners& world, double reach = std::numeric_limits<double>::infinity()) const {
    oracle::RationalPoints points;
    for (const Vector3d& x : world) {
      std::array<Rational, 3>& p = points.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) p[k] = (Rational(x[static_cast<int>(k)]) - centre_[k]) * scale_;
    }
    Corners out = rounded(points);
    if (std::all_of(out.begin(), out.end(),
                    [&](const Vector3d& x) { return x.cwiseAbs().maxCoeff() <= reach; }))
      return out;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int sign : {-1, 1}) {
        oracle::RationalPoints kept;
        for (std::size_t i = 0, n = points.size(); i < n; ++i) {
          const std::array<Rational, 3>&p = points[i], &q = points[(i + 1) % n];
          const Rational dp = sign * p[axis] - reach, dq = sign * q[axis] - reach;
          if (dp <= 0) kept.push_back(p);
          if (!(dp < 0 ? dq > 0 : dp > 0 && dq < 0) || (n == 2 && i == 1))
            continue;  // a segment has one side
          std::array<Rational, 3>& cut = kept.emplace_back();
          for (std::size_t k = 0; k < 3; ++k) cut[k] = p[k] + dp / (dp - dq) * (q[k] - p[k]);
        }
        points = std::move(kept);
      }
    return rounded(points);
  }

 private:
  using Rational = oracle::Rational;

  static Corners rounded(const oracle::RationalPoints& points) {
    Corners out;
    for (const std::array<Rational, 3>& x : points)
      out.emplace_back(x[0].convert_to<double>(), x[1].convert_to<double>(), x[2].convert_to<double>());
    return out;
  }

  std::array<Rational, 3> centre_;
  Rational scale_;
};

render::Rgba body_colour(std::size_t side) {
  return render::palette::body(side == 0 ? Side::a : Side::b);
}

/// Marks smaller than this share of the picture get a dot.
constexpr double kDot = 0.03;
constexpr float kMark = 4;  ///< radius of dots, and width of lines at places of pairs

/// Returns a draw list: bodies translucent, marks in their colours. Geometry outside [-reach, reach]^3 of the
/// frame is cut off.
render::DrawList draw_list(const CasePicture& s, const PictureFrame& frame, double reach, Mark worst) {
  render::DrawList list;
  const auto add_line = [&](const Corners& x, render::Rgba colour, float width, int nudge) {
    render::DrawLine line;
    line.points = x;
    line.closed = x.size() > 2;
    line.colour = colour;
    line.width = width;
    line.nudge = static_cast<std::int8_t>(nudge);
    list.lines.push_back(std::move(line));
  };
  for (std::size_t side = 0; side < 2; ++side) {
    const render::Rgba edge = render::palette::edge_of(body_colour(side));
    const std::uint8_t style = list.edge_style({render::with_alpha(edge, 120), 1, 0.5F});
    render::DrawFill fill;
    fill.colour = render::with_alpha(body_colour(side), 56);
    double largest = 0;
    for (const CasePicture::Piece& piece : s.bodies[side]) {
      const Mark m = piece.mark;
      if (s.flat) {
        const Corners ends = frame.cut(piece.corners);
        fill.segments.push_back({ends[0], ends[1]});
        largest = std::max(largest, ends[0].cwiseAbs().maxCoeff());
      }
      const Corners x = frame.cut(piece.corners, reach);
      if (x.size() < 2) continue;
      const render::Rgba colour = m == Mark::none || s.all_marked ? body_colour(side) : colour_of(m);
      // Of coplanar marks the more severe one is drawn in front.
      const int nudge = m == Mark::none ? 0 : 2 * static_cast<int>(m) + static_cast<int>(side);
      render::DrawTriangle face;
      face.colour = colour;
      face.nudge = static_cast<std::int8_t>(nudge);
      if (m == Mark::none || s.crowded) {
        face.colour = render::with_alpha(colour, m == Mark::none ? 56 : m == Mark::found ? 80 : 165);
        face.layer = render::Layer::translucent;
      }
      face.edges = m == Mark::none ? 7 : 0;
      face.edge_style = style;
      if (!s.flat) list.add_polygon(x, face);
      if (m == Mark::none) {
        if (s.flat) add_line(x, colour, 2, 4);
        continue;
      }
      // Outlines distinguish the bodies, and are the only visible part of needles and faces without area.
      add_line(x, s.flat ? colour : render::mix(colour, edge, 0.6), s.flat ? 4.5F : 1.6F, nudge + 2);
      AlignedBox3d box;
      for (const Vector3d& corner : x) box.extend(corner);
      if (box.diagonal().norm() < kDot) pictures::add_mark(list, box.center(), colour_of(m), kMark);
    }
    constexpr double kLargest = 1e6;  // that is filled in doubles
    if (s.flat && largest < kLargest) list.fills.push_back(std::move(fill));
  }
  for (const Corners& place : s.places) {
    const Corners x = frame.cut(place, reach);
    if (x.size() < 3)
      for (const Vector3d& end : x) pictures::add_mark(list, end, colour_of(worst), kMark);
    if (x.size() > 1) pictures::outline(list, x, colour_of(worst), kMark);
  }
  return list;
}

// Close-ups.

constexpr int kWidth = 1280, kHeight = 720;
/// Marks whose combined size is a smaller fraction of the scene than this get a close-up,
constexpr double kSmallShare = 0.25;
/// and so do widespread marks, if the smallest is smaller than this fraction.
constexpr double kTiny = 0.04;
/// Extent of a close-up, relative to its subject.
constexpr double kContext = 2.4;
/// Bodies are cut off beyond the view of close-ups, at this distance in extents of the close-up.
constexpr double kReach = 6;

struct CloseUp {
  AlignedBox3d box;
  std::string caption;
};

AlignedBox3d box_of(const Corners& corners) {
  AlignedBox3d box;
  for (const Vector3d& x : corners) box.extend(x);
  return box;
}

const AlignedBox3d& smaller_of(const AlignedBox3d& a, const AlignedBox3d& b) {
  return diagonal(a) < diagonal(b) ? a : b;
}

/// Returns a box around the intersection of the boxes of two simplices, or around the smaller one if they are
/// disjoint. With a place, the smallest box around that; if it is a point, as large as the shortest edge.
AlignedBox3d box_of_pair(const PosedPair& pair, const Corners* place) {
  const AlignedBox3d a = box_of(pair.x[0]), b = box_of(pair.x[1]), common = a.intersection(b);
  AlignedBox3d out = place != nullptr ? box_of(*place) : common.isEmpty() ? smaller_of(a, b) : common;
  double half = place != nullptr ? 0 : diagonal(smaller_of(a, b)) / 4;
  if (place != nullptr && !(diagonal(out) > 0))
    for (const Corners& x : pair.x)
      for (std::size_t k = 0; k < x.size(); ++k) {
        const double length = (x[k] - x[(k + 1) % x.size()]).stableNorm();
        if (length > 0 && (half == 0 || length < 2 * half)) half = length / 2;
      }
  const Vector3d centre = out.min() / 2 + out.max() / 2;  // sums of the largest doubles overflow
  return out.extend(Vector3d(centre - Vector3d::Constant(half)))
      .extend(Vector3d(centre + Vector3d::Constant(half)));
}

std::optional<CloseUp> close_up(const cases::Case& c, const CasePicture& s, const Verdict& verdict) {
  const double whole = diagonal(s.boxes[0].merged(s.boxes[1]));
  AlignedBox3d all, smallest = s.boxes[0].merged(s.boxes[1]);
  std::size_t i = 0;
  for (const SimplexPair& p : verdict.worst()) {
    const AlignedBox3d box = box_of_pair(PosedPair(c, p), s.all_marked ? &s.places[i++] : nullptr);
    all.extend(box);
    smallest = smaller_of(box, smallest);
  }
  const char* kinds[] = {"", "expected", "extra", "missed"};
  const std::string kind = kinds[static_cast<std::size_t>(verdict.mark())];
  if (all.isEmpty() && diagonal(smaller_of(s.boxes[0], s.boxes[1])) < kTiny * whole)
    return CloseUp{smaller_of(s.boxes[0], s.boxes[1]), "close-up of the smaller body"};
  if (all.isEmpty()) return std::nullopt;
  if (diagonal(all) < kSmallShare * whole) return CloseUp{all, "close-up, " + kind};
  if (diagonal(smallest) < kTiny * whole) return CloseUp{smallest, "close-up of one pair, " + kind};
  return std::nullopt;
}

/// Returns the direction from which the projected area of the marks is largest, with some preference for the
/// usual one.
render::ViewDirection best_view(const CasePicture& s, const PictureFrame& frame) {
  Corners areas;
  for (const auto& body : s.bodies)
    for (const CasePicture::Piece& piece : body) {
      if (piece.mark == Mark::none) continue;
      const Corners x = frame.cut(piece.corners, 1);
      for (std::size_t k = 2; k < x.size(); ++k) areas.push_back((x[k - 1] - x[0]).cross(x[k] - x[0]));
    }
  const auto area_from = [&](const render::ViewDirection& v) {
    double sum = 0;
    for (const Vector3d& n : areas) sum += std::abs(n.dot(v.from.normalized()));
    return sum;
  };
  render::ViewDirection best;
  double most = 1.3 * area_from(best);
  for (int turn = 0; turn < 8; ++turn)
    for (const double elevation : {0.25, 0.75}) {
      const render::ViewDirection v = render::view_from_angles(turn * std::numbers::pi / 4 + 0.35, elevation);
      if (area_from(v) <= most) continue;
      most = area_from(v);
      best = v;
    }
  return best;
}

render::Overlay overlay_of(const CasePicture& s, const Verdict& verdict, const WorstCaseText& text) {
  using Item = render::LegendItem::Mark;
  render::Overlay o;
  o.title = text.title;
  o.event = text.answer;
  o.event_colour =
      verdict.listed && verdict.mark() != Mark::found ? colour_of(verdict.mark()) : render::kTransparent;
  o.counters = text.counters;
  for (std::size_t side = 0; side < 2; ++side)
    o.key.push_back({Item::translucent, render::with_alpha(body_colour(side), 110), side == 0 ? "A" : "B"});
  const auto add = [&](Mark m, const Pairs& pairs, const char* counter, const char* name) {
    o.counters.push_back({counter, render::group_digits(pairs.size())});
    const auto is_shown = [&](const auto& body) {
      return std::any_of(body.begin(), body.end(), [&](const auto& piece) { return piece.mark == m; });
    };
    if (is_shown(s.bodies[0]) || is_shown(s.bodies[1])) o.key.push_back({Item::solid, colour_of(m), name});
  };
  if (!verdict.listed) add(Mark::found, verdict.found, "intersecting pairs", "expected");
  if (!verdict.listed) return o;
  add(Mark::found, verdict.found, "found", "found: expected and returned");
  add(Mark::missed, verdict.missed, "missed", "missed: expected, not returned");
  add(Mark::extra, verdict.extra, "extra", "extra: returned, not expected");
  if (!s.places.empty() && verdict.mark() != Mark::found)
    o.key.push_back(
        {Item::line, colour_of(verdict.mark()),
         verdict.mark() == Mark::missed ? "where missed pairs meet" : "where extra pairs are closest"});
  return o;
}

}  // namespace

render::Image worst_case_picture(const cases::Case& c, std::span<const SimplexPair> expected,
                                 const std::optional<Pairs>& answered, const WorstCaseText& text,
                                 render::Rasterizer& rasterizer) {
  const Verdict verdict = compare(expected, answered);
  const CasePicture s(c, verdict);
  const std::optional<CloseUp> close = close_up(c, s, verdict);
  const AlignedBox3d box = s.boxes[0].merged(s.boxes[1]);
  const PictureFrame whole(box), near(close ? close->box : box);
  const int dim = s.flat ? 2 : 3;
  render::FitOptions fit;
  fit.view = best_view(s, near);
  Corners points;
  for (const auto& body : s.bodies)
    for (const CasePicture::Piece& piece : body)
      for (const Vector3d& x : whole.cut(piece.corners)) points.push_back(x);
  std::vector<pictures::Panel> panels = {{draw_list(s, whole, 2, verdict.mark()),
                                          pictures::fit_points(points, dim, fit), close ? "whole" : "",
                                          false}};
  if (close) {
    // A frame around the place of the close-up, at a minimum size.
    const Corners ends = whole.cut({close->box.min(), close->box.max()});
    const Vector3d half = ((ends[1] - ends[0]) / 2).cwiseMax(kDot);
    pictures::add_box(
        panels[0].list, (ends[0] + ends[1]) / 2,
        {Vector3d(half.x(), 0, 0), Vector3d(0, half.y(), 0), Vector3d(0, 0, s.flat ? 0 : half.z())},
        {render::palette::kInk, 1.5F, 0, true});
    Corners shown;
    for (int i = 0; i < 8; ++i)
      shown.push_back(near.cut({close->box.corner(static_cast<AlignedBox3d::CornerType>(i))})[0] * kContext /
                      std::numbers::sqrt3);
    const double extent = std::max(diagonal(close->box) * kContext, std::numeric_limits<double>::min());
    const double times = diagonal(box) / extent;
    const std::string scale = std::isfinite(times) ? render::short_number(times) : "over 1e308";
    panels.push_back({draw_list(s, near, kReach, verdict.mark()), pictures::fit_points(shown, dim, fit),
                      close->caption + ", " + scale + " times as large", false});
  }
  const render::Overlay overlay = overlay_of(s, verdict, text);
  pictures::Look look;
  look.width = kWidth;
  look.height = kHeight;
  const render::PixelRect place = render::lay_out(overlay, kWidth, kHeight).picture;
  return render::compose_frame(pictures::draw_row(rasterizer, panels, look, place), place, overlay, kWidth,
                               kHeight);
}

namespace {

WorstCaseText text_of(const Record& r, const std::string& method) {
  WorstCaseText text;
  text.title = r.family + " \u00d7 " + method;
  text.answer = answer_text(r);
  text.counters = {
      {"difficulty", std::to_string(r.difficulty) + " of 0 to " + std::to_string(cases::kDifficulties - 1)},
      {"case", std::to_string(r.case_index)}};
  if (!r.expected_relation.empty()) text.counters.push_back({"relation", r.expected_relation});
  if (!r.relation.empty()) text.counters.push_back({"answered", r.relation});
  return text;
}

}  // namespace

std::vector<std::string> draw_worst_cases(
    const Grid& grid, const std::string& folder, const std::function<Replay(const Record&)>& ask,
    const std::function<void(std::size_t done, std::size_t total)>& progress) {
  namespace fs = std::filesystem;
  std::vector<std::string> pictures(grid.cells.size());
  std::size_t total = 0, done = 0;
  for (const Cell& c : grid.cells) total += c.worst ? 1 : 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder + "/worst", error))
    if (entry.path().extension() == ".png") fs::remove(entry.path(), error);
  if (total == 0) return pictures;
  make_folder(folder + "/worst");
  render::Rasterizer rasterizer;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (!grid.cells[i].worst) continue;
    if (progress) progress(done++, total);
    const Record& r = *grid.cells[i].worst;
    const cases::Family* family = cases::find_family(r.family);
    if (family == nullptr) continue;
    const methods::MethodInfo& method = grid.methods[i % grid.methods.size()];
    const std::string file = "worst/" + r.family + "-" + method.name + ".png";
    const Replay again = ask(r);
    try {
      cases::Case c = cases::make_case(*family, r.seed, r.difficulty, r.case_index);
      if (grid.quantity == Quantity::self_intersections) {  // of the mesh of both bodies
        const Mesh both = methods::joined(*c.a, c.pose_a, *c.b, c.pose_b);
        c = {};
        c.a = c.b = cases::body(both, true);
      }
      const WorstCaseText text = text_of(r, method.title);
      render::PngOptions png;
      png.text = {{"Title", text.title}, {"Description", text.answer}};
      render::write_png(worst_case_picture(c, again.expected, again.answered, text, rasterizer),
                        folder + "/" + file, png);
      pictures[i] = file;
    } catch (const InputError&) {
      // Coordinates that are not finite cannot be drawn; the record contains the parameters of the case.
    }
  }
  return pictures;
}

}  // namespace lrb::stability

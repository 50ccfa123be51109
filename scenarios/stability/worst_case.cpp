#include "scenarios/stability/worst_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "engine/error.hpp"
#include "render/palette.hpp"
#include "render/png.hpp"
#include "render/text.hpp"
#include "scenarios/stability/picture_frame.hpp"

namespace lrb::stability {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kGap = 4;
/// Marks that take up less of the scene than this get a close-up.
constexpr double kSmall = 0.35;
/// So do marks all over the bodies, if each is smaller than this.
constexpr double kTiny = 0.04;
/// What a close-up shows, in units of what it is about.
constexpr double kContext = 1.5;
/// Bodies are cut where close-ups cannot see them any more, in units of what they show.
constexpr double kReach = 6;

enum class Mark : std::uint8_t { none, found, extra, missed };

Rgba colour_of(Mark m) {
  return m == Mark::missed ? missed_colour() : m == Mark::extra ? extra_colour() : found_colour();
}

using Pairs = std::vector<SimplexPair>;

struct Answer {
  Pairs found, missed, extra;
  bool listed = false;

  const Pairs& wrong() const { return !missed.empty() ? missed : !extra.empty() ? extra : found; }
};

Answer compare(std::span<const SimplexPair> expected, const std::optional<Pairs>& answered) {
  Pairs e(expected.begin(), expected.end());
  std::sort(e.begin(), e.end());
  Answer out;
  out.listed = answered.has_value();
  if (!out.listed) {
    out.found = e;
    return out;
  }
  Pairs a = *answered;
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  std::set_intersection(e.begin(), e.end(), a.begin(), a.end(), std::back_inserter(out.found));
  std::set_difference(e.begin(), e.end(), a.begin(), a.end(), std::back_inserter(out.missed));
  std::set_difference(a.begin(), a.end(), e.begin(), e.end(), std::back_inserter(out.extra));
  return out;
}

/// The two bodies in world coordinates, and the mark of every simplex.
struct Subject {
  std::array<PosedBody, 2> bodies;
  std::array<std::vector<Mark>, 2> marks;
  Eigen::AlignedBox3d box;

  Subject(const families::Case& c, const Answer& answer)
      : bodies{PosedBody(*c.a, c.pose_a), PosedBody(*c.b, c.pose_b)} {
    box = bodies[0].box().merged(bodies[1].box());
    for (std::size_t i = 0; i < 2; ++i) marks[i].resize(bodies[i].size(), Mark::none);
    mark(answer.found, Mark::found);
    mark(answer.extra, Mark::extra);
    mark(answer.missed, Mark::missed);
  }

  bool flat() const { return bodies[0].dim() == 2; }

 private:
  void mark(const Pairs& pairs, Mark m) {
    for (const SimplexPair& p : pairs) {
      if (p.a >= marks[0].size() || p.b >= marks[1].size())
        throw InputError("pair (" + std::to_string(p.a) + ", " + std::to_string(p.b) + "): there are only " +
                         std::to_string(marks[0].size()) + " and " + std::to_string(marks[1].size()) +
                         " real simplices");
      marks[0][p.a] = std::max(marks[0][p.a], m);
      marks[1][p.b] = std::max(marks[1][p.b], m);
    }
  }
};

// ---- where to look

/// Around where two simplices meet, or the smaller one if they do not.
Eigen::AlignedBox3d place_of(const Subject& s, const SimplexPair& p) {
  const Eigen::AlignedBox3d a = s.bodies[0].box(p.a), b = s.bodies[1].box(p.b);
  const Eigen::AlignedBox3d& smaller = diagonal(a) < diagonal(b) ? a : b;
  const Eigen::AlignedBox3d common = a.intersection(b);
  const Eigen::Vector3d middle =
      common.isEmpty() ? smaller.center() : Eigen::Vector3d(common.min() / 2 + common.max() / 2);
  const double half = diagonal(smaller) / 4;
  Eigen::AlignedBox3d out(middle - Eigen::Vector3d::Constant(half), middle + Eigen::Vector3d::Constant(half));
  return common.isEmpty() ? out.merged(smaller) : out.merged(common);
}

struct CloseUp {
  Eigen::AlignedBox3d box;
  std::string caption;
};

std::optional<CloseUp> close_up(const Subject& s, const Answer& answer) {
  const double whole = diagonal(s.box);
  const Pairs& pairs = answer.wrong();
  if (pairs.empty()) {
    const Eigen::AlignedBox3d &a = s.bodies[0].box(), &b = s.bodies[1].box();
    const Eigen::AlignedBox3d& smaller = diagonal(a) < diagonal(b) ? a : b;
    if (diagonal(smaller) < kTiny * whole) return CloseUp{smaller, "close-up of the smaller body"};
    return std::nullopt;
  }
  const char* kind = !answer.missed.empty() ? "missed" : !answer.extra.empty() ? "in excess" : "expected";
  Eigen::AlignedBox3d all;
  const Eigen::AlignedBox3d* smallest = nullptr;
  std::vector<Eigen::AlignedBox3d> places;
  for (const SimplexPair& p : pairs) all.extend(places.emplace_back(place_of(s, p)));
  for (const Eigen::AlignedBox3d& b : places)
    if (smallest == nullptr || diagonal(b) < diagonal(*smallest)) smallest = &b;
  if (diagonal(all) < kSmall * whole) return CloseUp{all, std::string("close-up of what is ") + kind};
  if (diagonal(*smallest) < kTiny * whole)
    return CloseUp{*smallest, std::string("close-up of one pair ") + kind};
  return std::nullopt;
}

/// The side from which the marks are seen best: the sum of their areas in the picture, with some preference
/// for the usual one.
ViewDirection best_view(const Subject& s, const PictureFrame& frame) {
  const ViewDirection usual;
  std::vector<Eigen::Vector3d> areas;
  for (std::size_t i = 0; i < 2; ++i)
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      if (s.marks[i][f] == Mark::none) continue;
      const Piece p = frame.cut(s.bodies[i].simplex(f), 1);
      for (std::size_t k = 2; k < p.corners.size(); ++k)
        areas.push_back((p.corners[k - 1] - p.corners[0]).cross(p.corners[k] - p.corners[0]));
    }
  const auto seen = [&](const ViewDirection& v) {
    double sum = 0;
    for (const Eigen::Vector3d& n : areas) sum += std::abs(n.dot(v.from.normalized()));
    return sum;
  };
  ViewDirection best = usual;
  double most = 1.3 * seen(usual);
  for (int turn = 0; turn < 8; ++turn)
    for (const double elevation : {0.25, 0.75}) {
      const ViewDirection v = view_from_angles(turn * std::numbers::pi / 4 + 0.35, elevation);
      if (seen(v) > most) {
        most = seen(v);
        best = v;
      }
    }
  return best;
}

// ---- what to draw

void add_mark(DrawList& list, const Piece& p, Mark m, std::size_t body) {
  const Rgba colour = colour_of(m);
  // What lies in one plane: the worse mark in front.
  const auto nudge = static_cast<std::int8_t>(2 * static_cast<int>(m) + static_cast<int>(body));
  if (p.corners.size() > 2) {
    DrawTriangle like;
    like.colour = colour;
    like.nudge = nudge;
    for (std::size_t k = 2; k < p.corners.size(); ++k) {
      DrawTriangle t = like;
      t.x = {p.corners[0], p.corners[k - 1], p.corners[k]};
      list.triangles.push_back(t);
    }
  }
  // The outline too: needles and faces without area have nothing else.
  for (std::size_t k = 0; k < p.corners.size(); ++k) {
    if (p.corners.size() == 2 && k == 1) break;
    DrawLine line;
    line.points = {p.corners[k], p.corners[(k + 1) % p.corners.size()]};
    line.colour = mix(colour, kBlack, 0.3);
    line.width = p.corners.size() == 2 ? 4.5F : 1.6F;
    if (p.corners.size() == 2) line.colour = colour;
    line.nudge = static_cast<std::int8_t>(nudge + 2);
    list.lines.push_back(std::move(line));
  }
}

void add_body(DrawList& list, const Piece& p, std::size_t body, std::uint8_t style) {
  const Rgba colour = palette::body(body == 0 ? Side::a : Side::b);
  if (p.corners.size() == 2) {
    DrawLine line;
    line.points = p.corners;
    line.colour = colour;
    line.width = 2;
    list.lines.push_back(std::move(line));
    return;
  }
  for (std::size_t k = 2; k < p.corners.size(); ++k) {
    DrawTriangle t;
    t.x = {p.corners[0], p.corners[k - 1], p.corners[k]};
    t.colour = with_alpha(colour, 56);
    t.layer = Layer::translucent;
    t.edge_style = style;
    t.edges = static_cast<std::uint8_t>((k == 2 && p.edges[0] ? 1 : 0) | (p.edges[k - 1] ? 2 : 0) |
                                        (k + 1 == p.corners.size() && p.edges[k] ? 4 : 0));
    list.triangles.push_back(t);
  }
}

DrawList draw_list(const Subject& s, const PictureFrame& frame, double reach) {
  DrawList list;
  for (std::size_t i = 0; i < 2; ++i) {
    const Rgba edge = palette::edge_of(palette::body(i == 0 ? Side::a : Side::b));
    const std::uint8_t style = list.edge_style({with_alpha(edge, 120), 1, 0.5F});
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      const Piece p = frame.cut(s.bodies[i].simplex(f), reach);
      if (p.corners.size() < 2) continue;
      if (s.marks[i][f] == Mark::none)
        add_body(list, p, i, style);
      else
        add_mark(list, p, s.marks[i][f], i);
    }
  }
  return list;
}

/// A mark too small to see in this picture becomes a dot.
void add_dots(DrawList& list, const Subject& s, const PictureFrame& frame, double reach, double least) {
  for (std::size_t i = 0; i < 2; ++i)
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      if (s.marks[i][f] == Mark::none) continue;
      const Piece p = frame.cut(s.bodies[i].simplex(f), reach);
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& x : p.corners) box.extend(x);
      if (p.corners.empty() || diagonal(box) > least) continue;
      DrawPoint dot;
      dot.x = box.center();
      dot.colour = colour_of(s.marks[i][f]);
      dot.radius = 3.5F;
      list.points.push_back(dot);
    }
}

// ---- pictures

struct View {
  PictureFrame frame;
  double reach;
  ViewDirection direction;
};

Camera camera_of(const View& v, std::span<const Eigen::Vector3d> points, const PixelRect& place, bool flat) {
  FitOptions options;
  options.view = v.direction;
  return flat ? fit_top(points, place.width, place.height)
              : fit_camera(points, place.width, place.height, options);
}

Image draw_view(const Subject& s, const View& v, const Camera& camera, const PixelRect& place,
                Rasterizer& rasterizer) {
  RasterOptions options;
  options.width = place.width;
  options.height = place.height;
  DrawList list = draw_list(s, v.frame, v.reach);
  const Projection projection(camera, place.width, place.height, bounds(list));
  add_dots(list, s, v.frame, v.reach, 7 * projection.unit_per_pixel(camera.target));
  return rasterizer.draw(list, camera, options);
}

std::vector<Eigen::Vector3d> corners_of(const PictureFrame& frame, const Eigen::AlignedBox3d& box) {
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < 8; ++i)
    out.push_back(frame(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))));
  return out;
}

std::vector<Eigen::Vector3d> all_points(const Subject& s, const PictureFrame& frame) {
  std::vector<Eigen::Vector3d> out;
  for (const PosedBody& body : s.bodies)
    for (SimplexId f = 0; f < body.size(); ++f)
      for (const Eigen::Vector3d& p : body.simplex(f).corners) out.push_back(frame(p));
  return out;
}

void write_caption(Image& image, const std::string& text) {
  TextStyle style;
  style.height = 17;
  style.colour = palette::kFaint;
  style.halo = kWhite;
  style.halo_width = 2;
  default_font().draw(image, text, 10, 6, style);
}

/// Where the close-up lies in the whole: a frame in ink, never too small to see.
void frame_place(Image& image, const Camera& camera, const std::vector<Eigen::Vector3d>& corners,
                 const Eigen::AlignedBox3d& scene) {
  const Projection projection(camera, image.width(), image.height(), scene);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& c : corners)
    if (const auto p = projection.to_pixel(c)) box.extend(*p);
  if (box.isEmpty()) return;
  constexpr double kLeast = 11;  // half a side, pixels
  const Eigen::Vector2d middle = box.center();
  const Eigen::Vector2d half = (box.sizes() / 2).cwiseMax(kLeast);
  const PixelRect r{static_cast<int>(middle.x() - half.x()), static_cast<int>(middle.y() - half.y()),
                    static_cast<int>(2 * half.x()), static_cast<int>(2 * half.y())};
  image.stroke({r.x - 1, r.y - 1, r.width + 2, r.height + 2}, kWhite, 4);
  image.stroke(r, palette::kInk, 2);
}

Image both_views(const Subject& s, const Answer& answer, int width, int height, Rasterizer& rasterizer) {
  const std::optional<CloseUp> close = close_up(s, answer);
  const PictureFrame whole_frame(s.box);
  std::optional<PictureFrame> near_frame;
  if (close) near_frame.emplace(close->box);
  const ViewDirection direction = best_view(s, close ? *near_frame : whole_frame);

  const int left = close ? (width - kGap) / 2 : width;
  const View whole{whole_frame, 2, direction};
  const std::vector<Eigen::Vector3d> points = all_points(s, whole_frame);
  const Camera camera = camera_of(whole, points, {0, 0, left, height}, s.flat());
  Image image = draw_view(s, whole, camera, {0, 0, left, height}, rasterizer);
  if (!close) return image;

  const std::vector<Eigen::Vector3d> place = corners_of(whole_frame, close->box);
  Eigen::AlignedBox3d scene;
  for (const Eigen::Vector3d& p : points) scene.extend(p);
  frame_place(image, camera, place, scene);
  write_caption(image, "whole");

  const PixelRect right{left + kGap, 0, width - left - kGap, height};
  const View near{*near_frame, kReach, direction};
  std::vector<Eigen::Vector3d> shown = corners_of(*near_frame, close->box);
  for (Eigen::Vector3d& p : shown) p *= kContext / std::numbers::sqrt3;
  Image detail = draw_view(s, near, camera_of(near, shown, right, s.flat()), right, rasterizer);
  write_caption(detail, close->caption + ", " +
                            short_number(diagonal(s.box) / std::max(diagonal(close->box) * kContext,
                                                                    std::numeric_limits<double>::min())) +
                            " times as large");
  Image out(width, height, palette::kRule);
  out.paste(image, 0, 0);
  out.paste(detail, right.x, 0);
  return out;
}

Overlay overlay_of(const Answer& answer, const WorstCaseText& text) {
  Overlay o;
  o.title = text.title;
  o.event = text.answer;
  const Mark worst = !answer.missed.empty()  ? Mark::missed
                     : !answer.extra.empty() ? Mark::extra
                                             : Mark::found;
  o.event_colour = answer.listed && worst != Mark::found ? colour_of(worst) : palette::kInk;
  o.counters = text.counters;
  const auto count = [](const Pairs& p) { return group_digits(p.size()); };
  if (answer.listed) {
    o.counters.push_back({"found", count(answer.found)});
    o.counters.push_back({"missed", count(answer.missed)});
    o.counters.push_back({"extra", count(answer.extra)});
  } else {
    o.counters.push_back({"pairs that meet", count(answer.found)});
  }
  o.key = {{LegendItem::Mark::translucent, with_alpha(palette::body(Side::a), 110), "A"},
           {LegendItem::Mark::translucent, with_alpha(palette::body(Side::b), 110), "B"}};
  const auto add = [&](const Pairs& p, Mark m, const char* name) {
    if (!p.empty()) o.key.push_back({LegendItem::Mark::solid, colour_of(m), name});
  };
  add(answer.found, Mark::found, answer.listed ? "found: expected and answered" : "expected");
  add(answer.missed, Mark::missed, "missed: expected, not answered");
  add(answer.extra, Mark::extra, "extra: answered, not expected");
  return o;
}

}  // namespace

Rgba found_colour() {
  return palette::kGreen;
}
Rgba missed_colour() {
  return palette::kContact;
}
Rgba extra_colour() {
  return {150, 60, 170};
}

Image worst_case_picture(const families::Case& c, std::span<const SimplexPair> expected,
                         const std::optional<Pairs>& answered, const WorstCaseText& text,
                         Rasterizer& rasterizer) {
  const Answer answer = compare(expected, answered);
  const Subject subject(c, answer);
  const Overlay overlay = overlay_of(answer, text);
  const PixelRect place = lay_out(overlay, kWidth, kHeight).picture;
  return compose_frame(both_views(subject, answer, place.width, place.height, rasterizer), place, overlay,
                       kWidth, kHeight);
}

void draw_worst_case(const families::Case& c, std::span<const SimplexPair> expected,
                     const std::optional<Pairs>& answered, const WorstCaseText& text, const std::string& path,
                     Rasterizer& rasterizer) {
  PngOptions png;
  png.text = {{"Title", text.title}, {"Description", text.answer}};
  write_png(worst_case_picture(c, expected, answered, text, rasterizer), path, png);
}

}  // namespace lrb::stability

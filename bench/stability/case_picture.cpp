#include "bench/stability/case_picture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <numbers>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "bench/stability/rational_oracles.hpp"
#include "bench/stability/stability_report.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::stability {

// Marks.

render::Rgba colour_of(Mark m) {
  if (m == Mark::missed) return render::palette::kContact;
  return m == Mark::extra ? render::Rgba{150, 60, 170} : render::palette::kGreen;
}

Verdict compare(std::span<const SimplexPair> expected, const std::optional<Pairs>& answered) {
  Pairs e(expected.begin(), expected.end());
  std::sort(e.begin(), e.end());
  Verdict out;
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

CasePicture::CasePicture(const cases::Case& c, const Verdict& verdict)
    : bodies{PosedBody(*c.a, c.pose_a), PosedBody(*c.b, c.pose_b)} {
  box = bodies[0].box().merged(bodies[1].box());
  for (std::size_t i = 0; i < 2; ++i) marks[i].resize(bodies[i].size(), Mark::none);
  mark(verdict.found, Mark::found);
  mark(verdict.extra, Mark::extra);
  mark(verdict.missed, Mark::missed);
  if (!all_marked()) return;
  worst = !verdict.missed.empty() ? Mark::missed : !verdict.extra.empty() ? Mark::extra : Mark::found;
  for (const SimplexPair& p : verdict.worst()) add_place(p);
}

void CasePicture::add_place(const SimplexPair& pair) {
  const Piece a = bodies[0].simplex(pair.a), b = bodies[1].simplex(pair.b);
  const double *p[3], *q[3];
  for (std::size_t k = 0; k < a.corners.size(); ++k) p[k] = a.corners[k].data(), q[k] = b.corners[k].data();
  const exact::PairContact contact =
      flat() ? exact::contact_of_segments(p, q) : exact::contact_of_triangles(p, q);
  Piece piece;
  for (std::size_t k = 0; k < contact.corner_count; ++k) piece.corners.push_back(contact.corners[k].x);
  if (contact.corner_count == 0) {
    const auto corners = [](const Piece& simplex) {
      oracle::Corners out;
      for (const Eigen::Vector3d& x : simplex.corners) out.push_back({x.x(), x.y(), x.z()});
      return out;
    };
    const oracle::RationalClosest closest = oracle::closest_points(corners(a), corners(b));
    for (const auto& x : {closest.on_f, closest.on_g})
      piece.corners.emplace_back(x[0].convert_to<double>(), x[1].convert_to<double>(),
                                 x[2].convert_to<double>());
  }
  piece.edges.assign(piece.corners.size(), true);
  places.push_back(std::move(piece));
}

bool CasePicture::all_marked() const {
  return std::none_of(marks.begin(), marks.end(), [](const auto& of) {
    return of.empty() || std::find(of.begin(), of.end(), Mark::none) != of.end();
  });
}

bool CasePicture::shows(Mark m) const {
  return std::any_of(marks.begin(), marks.end(),
                     [m](const auto& of) { return std::find(of.begin(), of.end(), m) != of.end(); });
}

bool CasePicture::crowded() const {
  std::size_t marked = 0, all = 0;
  for (const std::vector<Mark>& m : marks) {
    all += m.size();
    marked += m.size() - static_cast<std::size_t>(std::count(m.begin(), m.end(), Mark::none));
  }
  return 4 * marked > all;
}

void CasePicture::mark(const Pairs& pairs, Mark m) {
  for (const SimplexPair& p : pairs) {
    if (p.a >= marks[0].size() || p.b >= marks[1].size())
      throw InputError("pair (" + std::to_string(p.a) + ", " + std::to_string(p.b) +
                       "): expected simplex numbers below " + std::to_string(marks[0].size()) + " and " +
                       std::to_string(marks[1].size()));
    marks[0][p.a] = std::max(marks[0][p.a], m);
    marks[1][p.b] = std::max(marks[1][p.b], m);
  }
}

// Bodies of any size and position.

PosedBody::PosedBody(const LrbRep& rep, const Pose& pose) : rep_(&rep) {
  x_.reserve(rep.vertices().size());
  for (const Eigen::Vector3d& v : rep.vertices()) x_.push_back(pose.apply(v));
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) {
      if (!x_[v].allFinite())
        throw InputError("vertex " + std::to_string(v) +
                         ": its world coordinates are not finite, so the case cannot be drawn");
      box_.extend(x_[v]);
    }
}

Piece PosedBody::simplex(SimplexId s) const {
  VertexId v[3];
  rep_->simplex(s, v);
  if (rep_->dim() == 2) return {{x_[v[0]], x_[v[1]]}, {true, false}};
  const auto corners = rep_->face(rep_->face_of_simplex(s));
  const auto is_side = [&](VertexId a, VertexId b) {
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (corners[i] == a && corners[(i + 1) % corners.size()] == b) return true;
    return false;
  };
  return {{x_[v[0]], x_[v[1]], x_[v[2]]}, {is_side(v[0], v[1]), is_side(v[1], v[2]), is_side(v[2], v[0])}};
}

Eigen::AlignedBox3d PosedBody::box(SimplexId s) const {
  Eigen::AlignedBox3d out;
  for (const Eigen::Vector3d& p : simplex(s).corners) out.extend(p);
  return out;
}

double diagonal(const Eigen::AlignedBox3d& box) {
  return box.isEmpty() ? 0 : (box.max() / 4 - box.min() / 4).stableNorm() * 4;
}

namespace {

// Scales and translates cases of any size and position for drawing, from bodies of size 1e-120 to bodies at
// 1e16.

/// Maps a box of the world to the cube [-1, 1]^3: its centre to the origin, its longest side to 2.
class PictureFrame {
 public:
  explicit PictureFrame(const Eigen::AlignedBox3d& box);

  /// Maps a point. Differences are taken first, which is exact near the centre, even far from the world's
  /// origin.
  Eigen::Vector3d operator()(const Eigen::Vector3d& world) const {
    return (world * before_ - centre_) / radius_;
  }
  /// Returns the part of a piece in [-reach, reach]^3, or no corners if it is empty. A piece may be 1e60
  /// times larger than the cube, so it is clipped with 100 digits.
  Piece cut(const Piece& world, double reach) const;

 private:
  Eigen::Vector3d centre_;
  double before_ = 1;  ///< scale that keeps differences of the largest doubles finite
  double radius_ = 1;
};

using Wide = boost::multiprecision::cpp_bin_float_100;
using WidePoint = std::array<Wide, 3>;

struct WidePiece {
  std::vector<WidePoint> corners;
  std::vector<bool> edges;
};

/// One pass of Sutherland-Hodgman clipping (I. Sutherland, G. Hodgman, "Reentrant Polygon Clipping", 1974):
/// keeps the part with sign * x[axis] <= reach.
WidePiece clip(const WidePiece& in, std::size_t axis, int sign, const Wide& reach) {
  WidePiece out;
  const std::size_t n = in.corners.size();
  const auto beyond = [&](const WidePoint& p) -> Wide { return sign * p[axis] - reach; };
  for (std::size_t i = 0; i < n; ++i) {
    if (n == 2 && i == 1) {  // a segment has no second side
      if (beyond(in.corners[1]) <= 0) out.corners.push_back(in.corners[1]), out.edges.push_back(false);
      break;
    }
    const WidePoint &p = in.corners[i], &q = in.corners[(i + 1) % n];
    const Wide dp = beyond(p), dq = beyond(q);
    if (dp <= 0) out.corners.push_back(p), out.edges.push_back(in.edges[i]);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
      const Wide t = dp / (dp - dq);
      WidePoint cut;
      for (std::size_t k = 0; k < 3; ++k) cut[k] = p[k] + t * (q[k] - p[k]);
      // On leaving, the next side lies on the cube and is not an outline; on entering, it lies on the old
      // side.
      out.corners.push_back(cut), out.edges.push_back(dp > 0 && in.edges[i]);
    }
  }
  return out;
}

bool inside(const Piece& piece, double reach) {
  for (const Eigen::Vector3d& p : piece.corners)
    if (!(p.cwiseAbs().maxCoeff() <= reach)) return false;
  return true;
}

PictureFrame::PictureFrame(const Eigen::AlignedBox3d& box) {
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (largest > 0x1p1000) before_ = 0x1p-2;
  const Eigen::Vector3d low = box.min() * before_, high = box.max() * before_;
  centre_ = low / 2 + high / 2;
  radius_ = (high - low).maxCoeff() / 2;
  // Bodies that have collapsed to a point are drawn as a point, so any size is valid.
  if (!(radius_ > 0)) radius_ = std::max(largest * before_, std::numeric_limits<double>::min());
}

Piece PictureFrame::cut(const Piece& world, double reach) const {
  Piece near = world;
  for (Eigen::Vector3d& p : near.corners) p = (*this)(p);
  if (inside(near, reach)) return near;
  WidePiece wide;
  wide.edges = world.edges;
  for (const Eigen::Vector3d& p : world.corners) {
    WidePoint& q = wide.corners.emplace_back();
    for (int k = 0; k < 3; ++k)
      q[static_cast<std::size_t>(k)] = (Wide(p[k]) * before_ - Wide(centre_[k])) / Wide(radius_);
  }
  for (std::size_t axis = 0; axis < 3 && !wide.corners.empty(); ++axis)
    for (const int sign : {-1, 1}) wide = clip(wide, axis, sign, reach);
  Piece out;
  out.edges = wide.edges;
  for (const WidePoint& q : wide.corners)
    out.corners.emplace_back(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]));
  return out;
}

// Draw lists.

Side side(std::size_t body) {
  return body == 0 ? Side::a : Side::b;
}

/// Outlines distinguish the bodies, and are the only visible part of needles and faces without area.
void add_outline(render::DrawList& list, const Piece& p, render::Rgba colour, float width,
                 std::int8_t nudge) {
  for (std::size_t k = 0; k < p.corners.size(); ++k) {
    if (p.corners.size() == 2 && k == 1) break;
    render::DrawLine line;
    line.points = {p.corners[k], p.corners[(k + 1) % p.corners.size()]};
    line.colour = colour;
    line.width = width;
    line.nudge = nudge;
    list.lines.push_back(std::move(line));
  }
}

/// How marked simplices are filled.
enum class Fill : std::uint8_t { opaque, see_through, in_colour_of_body };

void add_mark(render::DrawList& list, const Piece& p, Mark m, std::size_t body, Fill fill) {
  const render::Rgba colour =
      fill == Fill::in_colour_of_body ? render::palette::body(side(body)) : colour_of(m);
  const bool see_through = fill != Fill::opaque;
  // Of coplanar marks the more severe one is drawn in front.
  const auto nudge = static_cast<std::int8_t>(2 * static_cast<int>(m) + static_cast<int>(body));
  for (std::size_t k = 2; k < p.corners.size(); ++k) {
    render::DrawTriangle t;
    t.x = {p.corners[0], p.corners[k - 1], p.corners[k]};
    t.colour = see_through ? render::with_alpha(colour, m == Mark::found ? 80 : 165) : colour;
    t.layer = see_through ? render::Layer::translucent : render::Layer::opaque;
    t.nudge = nudge;
    list.triangles.push_back(t);
  }
  constexpr float kSegment = 4.5F, kOutline = 1.6F;
  const bool flat = p.corners.size() == 2;
  add_outline(
      list, p,
      flat ? colour : render::mix(colour, render::palette::edge_of(render::palette::body(side(body))), 0.6),
      flat ? kSegment : kOutline, static_cast<std::int8_t>(nudge + 2));
}

void add_body(render::DrawList& list, const Piece& p, std::size_t body, std::uint8_t style) {
  const render::Rgba colour = render::palette::body(side(body));
  if (p.corners.size() == 2) {
    render::DrawLine line;
    line.points = p.corners;
    line.colour = colour;
    line.width = 2;
    list.lines.push_back(std::move(line));
    return;
  }
  for (std::size_t k = 2; k < p.corners.size(); ++k) {
    render::DrawTriangle t;
    t.x = {p.corners[0], p.corners[k - 1], p.corners[k]};
    t.colour = render::with_alpha(colour, 56);
    t.layer = render::Layer::translucent;
    t.edge_style = style;
    t.edges = static_cast<std::uint8_t>((k == 2 && p.edges[0] ? 1 : 0) | (p.edges[k - 1] ? 2 : 0) |
                                        (k + 1 == p.corners.size() && p.edges[k] ? 4 : 0));
    list.triangles.push_back(t);
  }
}

/// Fills a 2D body, unless it is too large to be filled in doubles.
void add_fill(render::DrawList& list, const PosedBody& body, std::size_t i, const PictureFrame& frame) {
  constexpr double kLargest = 1e6;
  render::DrawFill fill;
  fill.colour = render::with_alpha(render::palette::body(side(i)), 56);
  for (SimplexId f = 0; f < body.size(); ++f) {
    const Piece p = body.simplex(f);
    fill.segments.push_back({frame(p.corners[0]), frame(p.corners[1])});
    if (!(fill.segments.back()[0].cwiseAbs().maxCoeff() < kLargest)) return;
  }
  list.fills.push_back(std::move(fill));
}

/// Returns a draw list: bodies translucent, marks in their colours. Geometry outside [-reach, reach]^3 of the
/// frame is clipped.
render::DrawList draw_list(const CasePicture& s, const PictureFrame& frame, double reach) {
  render::DrawList list;
  const Fill fill = s.all_marked() ? Fill::in_colour_of_body : s.crowded() ? Fill::see_through : Fill::opaque;
  for (std::size_t i = 0; i < 2; ++i) {
    if (s.flat()) add_fill(list, s.bodies[i], i, frame);
    const render::Rgba edge = render::palette::edge_of(render::palette::body(side(i)));
    const std::uint8_t style = list.edge_style({render::with_alpha(edge, 120), 1, 0.5F});
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      const Piece p = frame.cut(s.bodies[i].simplex(f), reach);
      if (p.corners.size() < 2) continue;
      if (s.marks[i][f] == Mark::none)
        add_body(list, p, i, style);
      else
        add_mark(list, p, s.marks[i][f], i, fill);
    }
  }
  for (const Piece& whole : s.places) {
    const Piece p = frame.cut(whole, reach);
    constexpr std::int8_t kInFront = 12;
    constexpr float kWidth = 4;
    if (p.corners.size() > 1) add_outline(list, p, colour_of(s.worst), kWidth, kInFront);
    for (std::size_t k = 0; k < p.corners.size() && p.corners.size() < 3; ++k) {
      render::DrawPoint dot;
      dot.x = p.corners[k];
      dot.colour = colour_of(s.worst);
      dot.radius = 4;
      list.points.push_back(dot);
    }
  }
  return list;
}

/// Adds a dot for each mark smaller than `least`, in units of the frame.
void add_dots(render::DrawList& list, const CasePicture& s, const PictureFrame& frame, double reach,
              double least) {
  for (std::size_t i = 0; i < 2; ++i)
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      if (s.marks[i][f] == Mark::none) continue;
      const Piece p = frame.cut(s.bodies[i].simplex(f), reach);
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& x : p.corners) box.extend(x);
      if (p.corners.empty() || diagonal(box) > least) continue;
      render::DrawPoint dot;
      dot.x = box.center();
      dot.colour = colour_of(s.marks[i][f]);
      dot.radius = 3.5F;
      list.points.push_back(dot);
    }
}

// Pictures.

constexpr int kWidth = 1280, kHeight = 720, kBetweenViews = 4;
/// Marks whose combined size is a smaller fraction of the scene than this get a close-up,
constexpr double kSmallShare = 0.25;
/// and so do widespread marks, if the smallest is smaller than this fraction.
constexpr double kTiny = 0.04;
/// Extent of a close-up, relative to its subject.
constexpr double kContext = 2.4;
/// Bodies are clipped beyond the view of close-ups, at this distance in extents of the close-up.
constexpr double kReach = 6;

// ---- Regions of interest

/// Halves first: sums of the largest doubles overflow.
Eigen::Vector3d centre_of(const Eigen::AlignedBox3d& box) {
  return box.min() / 2 + box.max() / 2;
}

/// Returns a box around the intersection of two simplices, or around the smaller one if their boxes are
/// disjoint.
Eigen::AlignedBox3d place_of(const CasePicture& s, const SimplexPair& p) {
  const Eigen::AlignedBox3d a = s.bodies[0].box(p.a), b = s.bodies[1].box(p.b);
  const Eigen::AlignedBox3d& smaller = diagonal(a) < diagonal(b) ? a : b;
  const Eigen::AlignedBox3d common = a.intersection(b);
  const Eigen::Vector3d centre = centre_of(common.isEmpty() ? smaller : common);
  const double half = diagonal(smaller) / 4;
  Eigen::AlignedBox3d out(centre - Eigen::Vector3d::Constant(half), centre + Eigen::Vector3d::Constant(half));
  return common.isEmpty() ? out.merged(smaller) : out.merged(common);
}

struct CloseUp {
  Eigen::AlignedBox3d box;
  std::string caption;
};

/// Returns the smallest box around the place of a pair: its extent, or if it is a point the shortest edge of
/// the two simplices.
CloseUp close_up_of_place(const CasePicture& s, const Piece& place, const SimplexPair& pair,
                          const char* kind) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : place.corners) box.extend(x);
  double size = diagonal(box);
  if (!(size > 0)) {
    for (const Piece& p : {s.bodies[0].simplex(pair.a), s.bodies[1].simplex(pair.b)})
      for (std::size_t k = 0; k < p.corners.size(); ++k) {
        const double length = (p.corners[k] - p.corners[(k + 1) % p.corners.size()]).stableNorm();
        if (length > 0 && (!(size > 0) || length < size)) size = length;
      }
  }
  const Eigen::Vector3d centre = centre_of(box), half = Eigen::Vector3d::Constant(size / 2);
  return {Eigen::AlignedBox3d(centre - half, centre + half), std::string("close-up, ") + kind};
}

std::optional<CloseUp> close_up(const CasePicture& s, const Verdict& verdict) {
  const double whole = diagonal(s.box);
  const Pairs& pairs = verdict.worst();
  if (pairs.empty()) {
    const Eigen::AlignedBox3d &a = s.bodies[0].box(), &b = s.bodies[1].box();
    const Eigen::AlignedBox3d& smaller = diagonal(a) < diagonal(b) ? a : b;
    if (diagonal(smaller) < kTiny * whole) return CloseUp{smaller, "close-up of the smaller body"};
    return std::nullopt;
  }
  const char* kind = !verdict.missed.empty() ? "missed" : !verdict.extra.empty() ? "extra" : "expected";
  if (!s.places.empty()) {
    CloseUp close = close_up_of_place(s, s.places.front(), pairs.front(), kind);
    if (diagonal(close.box) < kSmallShare * whole) return close;
    return std::nullopt;
  }
  Eigen::AlignedBox3d all;
  const Eigen::AlignedBox3d* smallest = nullptr;
  std::vector<Eigen::AlignedBox3d> places;
  for (const SimplexPair& p : pairs) all.extend(places.emplace_back(place_of(s, p)));
  for (const Eigen::AlignedBox3d& b : places)
    if (smallest == nullptr || diagonal(b) < diagonal(*smallest)) smallest = &b;
  if (diagonal(all) < kSmallShare * whole) return CloseUp{all, std::string("close-up, ") + kind};
  if (diagonal(*smallest) < kTiny * whole)
    return CloseUp{*smallest, std::string("close-up of one pair, ") + kind};
  return std::nullopt;
}

/// Returns the direction from which the projected area of the marks is largest, with some preference for the
/// usual one.
render::ViewDirection best_view(const CasePicture& s, const PictureFrame& frame) {
  const render::ViewDirection usual;
  std::vector<Eigen::Vector3d> areas;
  for (std::size_t i = 0; i < 2; ++i)
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      if (s.marks[i][f] == Mark::none) continue;
      const Piece p = frame.cut(s.bodies[i].simplex(f), 1);
      for (std::size_t k = 2; k < p.corners.size(); ++k)
        areas.push_back((p.corners[k - 1] - p.corners[0]).cross(p.corners[k] - p.corners[0]));
    }
  const auto seen = [&](const render::ViewDirection& v) {
    double sum = 0;
    for (const Eigen::Vector3d& n : areas) sum += std::abs(n.dot(v.from.normalized()));
    return sum;
  };
  render::ViewDirection best = usual;
  double most = 1.3 * seen(usual);
  for (int turn = 0; turn < 8; ++turn)
    for (const double elevation : {0.25, 0.75}) {
      const render::ViewDirection v = render::view_from_angles(turn * std::numbers::pi / 4 + 0.35, elevation);
      if (seen(v) > most) {
        most = seen(v);
        best = v;
      }
    }
  return best;
}

// ---- Pictures

struct View {
  PictureFrame frame;
  double reach;
  render::ViewDirection direction;
};

run::CameraFit camera_of(const View& v, const std::vector<Eigen::Vector3d>& points, const CasePicture& s) {
  render::FitOptions options;
  options.view = v.direction;
  return run::fit_points(points, s.flat() ? 2 : 3, options);
}

render::Image draw_view(const CasePicture& s, const View& v, const run::CameraFit& fit, int width, int height,
                        render::Rasterizer& rasterizer) {
  const render::Camera camera = fit(width, height);
  render::DrawList list = draw_list(s, v.frame, v.reach);
  const render::Projection projection(camera, width, height, render::bounds(list));
  add_dots(list, s, v.frame, v.reach, 7 * projection.unit_per_pixel(camera.target));
  return run::draw_panel(rasterizer, {list, fit, "", false}, {}, width, height);
}

std::vector<Eigen::Vector3d> corners_of(const PictureFrame& frame, const Eigen::AlignedBox3d& box) {
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < 8; ++i)
    out.push_back(frame(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))));
  return out;
}

std::vector<Eigen::Vector3d> all_points(const CasePicture& s, const PictureFrame& frame) {
  std::vector<Eigen::Vector3d> out;
  for (const PosedBody& body : s.bodies)
    for (SimplexId f = 0; f < body.size(); ++f)
      for (const Eigen::Vector3d& p : body.simplex(f).corners) out.push_back(frame(p));
  return out;
}

void write_caption(render::Image& image, const std::string& text) {
  render::TextStyle style;
  style.height = 17;
  style.colour = render::palette::kInk;
  const render::TextSize size = render::default_font().measure(text, style);
  const render::PixelRect back{0, 0, std::min(image.width(), size.width + 20), size.height + 12};
  for (int y = 0; y < back.height; ++y)
    for (int x = 0; x < back.width; ++x) image.blend(x, y, render::with_alpha(render::kWhite, 225));
  render::default_font().draw(image, text, 10, 6, style);
}

/// Frames the location of the close-up in the view of the whole, at a minimum size.
void frame_place(render::Image& image, const render::Camera& camera,
                 const std::vector<Eigen::Vector3d>& corners, const Eigen::AlignedBox3d& scene) {
  const render::Projection projection(camera, image.width(), image.height(), scene);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& c : corners)
    if (const auto p = projection.to_pixel(c)) box.extend(*p);
  if (box.isEmpty()) return;
  constexpr double kLeast = 11;  // half a side, pixels
  const Eigen::Vector2d centre = box.center();
  const Eigen::Vector2d half = (box.sizes() / 2).cwiseMax(kLeast);
  const render::PixelRect r{static_cast<int>(centre.x() - half.x()), static_cast<int>(centre.y() - half.y()),
                            static_cast<int>(2 * half.x()), static_cast<int>(2 * half.y())};
  image.stroke({r.x - 1, r.y - 1, r.width + 2, r.height + 2}, render::kWhite, 4);
  image.stroke(r, render::palette::kInk, 2);
}

render::Image both_views(const CasePicture& s, const Verdict& verdict, int width, int height,
                         render::Rasterizer& rasterizer) {
  const std::optional<CloseUp> close = close_up(s, verdict);
  const PictureFrame whole_frame(s.box);
  std::optional<PictureFrame> near_frame;
  if (close) near_frame.emplace(close->box);
  const render::ViewDirection direction = best_view(s, close ? *near_frame : whole_frame);
  const int left = close ? (width - kBetweenViews) / 2 : width;
  const View whole{whole_frame, 2, direction};
  const std::vector<Eigen::Vector3d> points = all_points(s, whole_frame);
  const run::CameraFit fit = camera_of(whole, points, s);
  render::Image image = draw_view(s, whole, fit, left, height, rasterizer);
  if (!close) return image;

  frame_place(image, fit(left, height), corners_of(whole_frame, close->box), render::bounds(points));
  write_caption(image, "whole");
  const View near{*near_frame, kReach, direction};
  std::vector<Eigen::Vector3d> shown = corners_of(*near_frame, close->box);
  for (Eigen::Vector3d& p : shown) p *= kContext / std::numbers::sqrt3;
  render::Image detail =
      draw_view(s, near, camera_of(near, shown, s), width - left - kBetweenViews, height, rasterizer);
  write_caption(detail,
                close->caption + ", " +
                    render::short_number(diagonal(s.box) / std::max(diagonal(close->box) * kContext,
                                                                    std::numeric_limits<double>::min())) +
                    " times as large");
  render::Image out(width, height, render::palette::kRule);
  out.paste(image, 0, 0);
  out.paste(detail, left + kBetweenViews, 0);
  return out;
}

render::Overlay overlay_of(const CasePicture& s, const Verdict& verdict, const WorstCaseText& text) {
  render::Overlay o;
  o.title = text.title;
  o.event = text.answer;
  const Mark worst = !verdict.missed.empty()  ? Mark::missed
                     : !verdict.extra.empty() ? Mark::extra
                                              : Mark::found;
  o.event_colour = verdict.listed && worst != Mark::found ? colour_of(worst) : render::kTransparent;
  o.counters = text.counters;
  const auto count = [](const Pairs& p) { return render::group_digits(p.size()); };
  if (verdict.listed) {
    o.counters.push_back({"found", count(verdict.found)});
    o.counters.push_back({"missed", count(verdict.missed)});
    o.counters.push_back({"extra", count(verdict.extra)});
  } else {
    o.counters.push_back({"intersecting pairs", count(verdict.found)});
  }
  o.key = {
      {render::LegendItem::Mark::translucent, render::with_alpha(render::palette::body(Side::a), 110), "A"},
      {render::LegendItem::Mark::translucent, render::with_alpha(render::palette::body(Side::b), 110), "B"}};
  const auto add = [&](Mark m, const char* name) {
    if (s.shows(m)) o.key.push_back({render::LegendItem::Mark::solid, colour_of(m), name});
  };
  add(Mark::found, verdict.listed ? "found: expected and returned" : "expected");
  add(Mark::missed, "missed: expected, not returned");
  add(Mark::extra, "extra: returned, not expected");
  return o;
}

}  // namespace

render::Image worst_case_picture(const cases::Case& c, std::span<const SimplexPair> expected,
                                 const std::optional<Pairs>& answered, const WorstCaseText& text,
                                 render::Rasterizer& rasterizer) {
  const Verdict verdict = compare(expected, answered);
  const CasePicture subject(c, verdict);
  const render::Overlay overlay = overlay_of(subject, verdict, text);
  const render::PixelRect place = render::lay_out(overlay, kWidth, kHeight).picture;
  return render::compose_frame(both_views(subject, verdict, place.width, place.height, rasterizer), place,
                               overlay, kWidth, kHeight);
}

namespace {

constexpr const char* kFolder = "worst";

void remove_old_pictures(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".png") std::filesystem::remove(entry.path(), error);
}

/// Returns the case to which a list of self-intersections refers: the mesh of both bodies, twice.
cases::Case twice_joined(const cases::Case& c) {
  Mesh joined;
  joined.dim = c.a->dim();
  for (const auto& [rep, pose] : {std::pair{c.a, c.pose_a}, std::pair{c.b, c.pose_b}}) {
    const auto first = static_cast<std::uint32_t>(joined.vertices.size());
    for (const Eigen::Vector3d& v : rep->vertices()) joined.vertices.push_back(pose.apply(v));
    for (SimplexId s = 0; s < rep->real_simplex_count(); ++s) {
      VertexId v[3] = {};
      rep->simplex(s, v);
      for (VertexId& corner : v) corner = VertexId(first + corner);
      joined.add_face({v, static_cast<std::size_t>(joined.dim)});
    }
  }
  cases::Case out;
  out.a = out.b = cases::body(joined, true);
  return out;
}

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
  std::vector<std::string> pictures(grid.cells.size());
  std::size_t total = 0, done = 0;
  for (const Cell& c : grid.cells) total += c.worst ? 1 : 0;
  remove_old_pictures(folder + "/" + kFolder);
  if (total == 0) return pictures;
  make_folder(folder + "/" + kFolder);
  render::Rasterizer rasterizer;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (!grid.cells[i].worst) continue;
    if (progress) progress(done++, total);
    const Record& r = *grid.cells[i].worst;
    const cases::Family* family = cases::find_family(r.family);
    if (family == nullptr) continue;
    const workers::MethodColumn& method = grid.methods[i % grid.methods.size()];
    const std::string file = std::string(kFolder) + "/" + r.family + "-" + method.name + ".png";
    const Replay again = ask(r);
    try {
      const cases::Case c = cases::make_case(*family, r.seed, r.difficulty, r.case_index);
      const WorstCaseText text = text_of(r, method.title);
      render::PngOptions png;
      png.text = {{"Title", text.title}, {"Description", text.answer}};
      render::write_png(
          worst_case_picture(grid.quantity == Quantity::self_intersections ? twice_joined(c) : c,
                             again.expected, again.answered, text, rasterizer),
          folder + "/" + file, png);
      pictures[i] = file;
    } catch (const InputError&) {
      // Coordinates that are not finite cannot be drawn; the record contains the parameters of the case.
    }
  }
  return pictures;
}

}  // namespace lrb::stability

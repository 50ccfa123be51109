#include "bench/stability/case_picture.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <string>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "bench/stability/rational_oracles.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::stability {
namespace {

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

}  // namespace

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

namespace {

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

}  // namespace

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
  const FaceId f = rep_->face_of_simplex(s);
  const std::uint32_t i = s - rep_->first_simplex(f);
  return {{x_[v[0]], x_[v[1]], x_[v[2]]}, {i == 0, true, i + 3 == rep_->face(f).size()}};
}

Eigen::AlignedBox3d PosedBody::box(SimplexId s) const {
  Eigen::AlignedBox3d out;
  for (const Eigen::Vector3d& p : simplex(s).corners) out.extend(p);
  return out;
}

double diagonal(const Eigen::AlignedBox3d& box) {
  return box.isEmpty() ? 0 : (box.max() / 4 - box.min() / 4).stableNorm() * 4;
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

}  // namespace lrb::stability

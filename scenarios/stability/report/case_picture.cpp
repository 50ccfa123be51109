#include "scenarios/stability/report/case_picture.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include "engine/core/error.hpp"
#include "render/palette.hpp"
#include "scenarios/stability/report/worst_case.hpp"

namespace lrb::stability {
namespace {

Side side(std::size_t body) {
  return body == 0 ? Side::a : Side::b;
}

/// Outlines tell the bodies apart, and needles and faces without area show nothing else.
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

void add_mark(render::DrawList& list, const Piece& p, Mark m, std::size_t body, bool see_through) {
  const render::Rgba colour = colour_of(m);
  // Where marks lie in one plane, the worse one is drawn in front.
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

/// Draws the inside of a 2D body, unless it is too large to be filled in doubles.
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

render::Rgba found_colour() {
  return render::palette::kGreen;
}
render::Rgba missed_colour() {
  return render::palette::kContact;
}
render::Rgba extra_colour() {
  return {150, 60, 170};
}

render::Rgba colour_of(Mark m) {
  return m == Mark::missed ? missed_colour() : m == Mark::extra ? extra_colour() : found_colour();
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
      throw InputError("pair (" + std::to_string(p.a) + ", " + std::to_string(p.b) + "): there are only " +
                       std::to_string(marks[0].size()) + " and " + std::to_string(marks[1].size()) +
                       " real simplices");
    marks[0][p.a] = std::max(marks[0][p.a], m);
    marks[1][p.b] = std::max(marks[1][p.b], m);
  }
}

render::DrawList draw_list(const CasePicture& s, const PictureFrame& frame, double reach) {
  render::DrawList list;
  const bool see_through = s.crowded();
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
        add_mark(list, p, s.marks[i][f], i, see_through);
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

}  // namespace lrb::stability

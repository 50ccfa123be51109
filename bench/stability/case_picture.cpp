#include "bench/stability/case_picture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <numbers>

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
  worst = verdict.worst_mark();
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
  const FaceId f = rep_->face_of_simplex(s);
  const std::uint32_t i = s - rep_->first_simplex(f);
  return {{x_[v[0]], x_[v[1]], x_[v[2]]}, {i == 0, true, i + 3 == rep_->face(f).size()}};
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
  Piece operator()(Piece world) const {
    for (Eigen::Vector3d& p : world.corners) p = (*this)(p);
    return world;
  }

 private:
  Eigen::Vector3d centre_;
  double before_ = 1;  ///< scale that keeps differences of the largest doubles finite
  double radius_ = 1;
};

PictureFrame::PictureFrame(const Eigen::AlignedBox3d& box) {
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (largest > 0x1p1000) before_ = 0x1p-2;
  const Eigen::Vector3d low = box.min() * before_, high = box.max() * before_;
  centre_ = low / 2 + high / 2;
  radius_ = (high - low).maxCoeff() / 2;
  // Bodies that have collapsed to a point are drawn as a point, so any size is valid.
  if (!(radius_ > 0)) radius_ = std::max(largest * before_, std::numeric_limits<double>::min());
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

void add_fill(render::DrawList& list, const PosedBody& body, std::size_t i, const PictureFrame& frame) {
  render::DrawFill fill;
  fill.colour = render::with_alpha(render::palette::body(side(i)), 56);
  for (SimplexId f = 0; f < body.size(); ++f) {
    const Piece p = frame(body.simplex(f));
    fill.segments.push_back({p.corners[0], p.corners[1]});
  }
  list.fills.push_back(std::move(fill));
}

/// Returns a draw list: bodies translucent, marks in their colours.
render::DrawList draw_list(const CasePicture& s, const PictureFrame& frame) {
  render::DrawList list;
  const Fill fill = s.all_marked() ? Fill::in_colour_of_body : s.crowded() ? Fill::see_through : Fill::opaque;
  for (std::size_t i = 0; i < 2; ++i) {
    if (s.flat()) add_fill(list, s.bodies[i], i, frame);
    const render::Rgba edge = render::palette::edge_of(render::palette::body(side(i)));
    const std::uint8_t style = list.edge_style({render::with_alpha(edge, 120), 1, 0.5F});
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      const Piece p = frame(s.bodies[i].simplex(f));
      if (s.marks[i][f] == Mark::none)
        add_body(list, p, i, style);
      else
        add_mark(list, p, s.marks[i][f], i, fill);
    }
  }
  for (const Piece& whole : s.places) {
    const Piece p = frame(whole);
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
void add_dots(render::DrawList& list, const CasePicture& s, const PictureFrame& frame, double least) {
  for (std::size_t i = 0; i < 2; ++i)
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      if (s.marks[i][f] == Mark::none) continue;
      const Piece p = frame(s.bodies[i].simplex(f));
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& x : p.corners) box.extend(x);
      if (diagonal(box) > least) continue;
      render::DrawPoint dot;
      dot.x = box.center();
      dot.colour = colour_of(s.marks[i][f]);
      dot.radius = 3.5F;
      list.points.push_back(dot);
    }
}

// Pictures.

constexpr int kWidth = 1280, kHeight = 720;

/// Returns the direction from which the projected area of the marks is largest, with some preference for the
/// usual one.
render::ViewDirection best_view(const CasePicture& s, const PictureFrame& frame) {
  const render::ViewDirection usual;
  std::vector<Eigen::Vector3d> areas;
  for (std::size_t i = 0; i < 2; ++i)
    for (SimplexId f = 0; f < s.marks[i].size(); ++f) {
      if (s.marks[i][f] == Mark::none) continue;
      const Piece p = frame(s.bodies[i].simplex(f));
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

render::Image draw(const CasePicture& s, int width, int height, render::Rasterizer& rasterizer) {
  const PictureFrame frame(s.box);
  std::vector<Eigen::Vector3d> points;
  for (const PosedBody& body : s.bodies)
    for (SimplexId f = 0; f < body.size(); ++f)
      for (const Eigen::Vector3d& p : body.simplex(f).corners) points.push_back(frame(p));
  render::FitOptions options;
  options.view = best_view(s, frame);
  const run::CameraFit fit = run::fit_points(points, s.flat() ? 2 : 3, options);
  const render::Camera camera = fit(width, height);
  render::DrawList list = draw_list(s, frame);
  const render::Projection projection(camera, width, height, render::bounds(list));
  add_dots(list, s, frame, 7 * projection.unit_per_pixel(camera.target));
  return run::draw_panel(rasterizer, {list, fit, "", false}, {}, width, height);
}

render::Overlay overlay_of(const CasePicture& s, const Verdict& verdict, const WorstCaseText& text) {
  render::Overlay o;
  o.title = text.title;
  o.event = text.answer;
  o.event_colour = verdict.listed && verdict.worst_mark() != Mark::found ? colour_of(verdict.worst_mark())
                                                                         : render::kTransparent;
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
  return render::compose_frame(draw(subject, place.width, place.height, rasterizer), place, overlay, kWidth,
                               kHeight);
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

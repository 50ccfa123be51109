#include "bench/stability/worst_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>

#include "bench/stability/case_picture.hpp"
#include "bench/stability/stability_report.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::stability {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kGap = 4;
/// Marks whose combined size is a smaller fraction of the scene than this get a close-up,
constexpr double kSmallShare = 0.25;
/// and so do widespread marks, if the smallest is smaller than this fraction.
constexpr double kTiny = 0.04;
/// Extent of a close-up, relative to its subject.
constexpr double kContext = 2.4;
/// A close-up of fewer times than this shows little more than the whole.
constexpr double kLeastCloseUp = 4;
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

/// A wrong pair without the rest of the bodies.
struct LonePair {
  cases::Case bodies;  ///< the picture refers to them
  CasePicture picture;
  std::string caption;
};

/// Returns the pair whose smaller simplex is largest.
SimplexPair best_visible(const CasePicture& s, const Pairs& pairs) {
  const auto size = [&](const SimplexPair& p) {
    return std::min(diagonal(s.bodies[0].box(p.a)), diagonal(s.bodies[1].box(p.b)));
  };
  return *std::max_element(pairs.begin(), pairs.end(),
                           [&](const SimplexPair& p, const SimplexPair& q) { return size(p) < size(q); });
}

/// Returns a wrong pair, if marks are all over the bodies and show no place.
std::optional<LonePair> lone_pair(const CasePicture& s, const Verdict& verdict) {
  const Pairs& wrong = !verdict.missed.empty() ? verdict.missed : verdict.extra;
  if (wrong.empty() || !s.crowded() || s.all_marked()) return std::nullopt;
  const SimplexPair pair = best_visible(s, wrong);
  const auto alone = [&](std::size_t side, SimplexId simplex) {
    Mesh mesh;
    mesh.dim = s.bodies[side].dim();
    mesh.vertices = s.bodies[side].simplex(simplex).corners;
    std::vector<VertexId> corners;
    for (std::uint32_t k = 0; k < mesh.vertices.size(); ++k) corners.emplace_back(k);
    mesh.add_face(corners);
    return std::make_shared<LrbRep>(LrbRep::without_regions(mesh, false, false));
  };
  cases::Case c;
  c.a = alone(0, pair.a);
  c.b = alone(1, pair.b);
  Verdict one;
  one.listed = true;
  (verdict.missed.empty() ? one.extra : one.missed).push_back({SimplexId(0), SimplexId(0)});
  const char* what = s.flat() ? "segments " : "triangles ";
  return LonePair{c, CasePicture(c, one),
                  std::string("one pair, ") + (verdict.missed.empty() ? "extra: " : "missed: ") + what +
                      std::to_string(pair.a) + " and " + std::to_string(pair.b)};
}

render::Image draw_lone_pair(const LonePair& pair, int width, int height, render::Rasterizer& rasterizer) {
  const CasePicture& s = pair.picture;
  const PictureFrame frame(s.box);
  const View view{frame, 2, best_view(s, frame)};
  render::Image image =
      draw_view(s, view, camera_of(view, all_points(s, frame), s), width, height, rasterizer);
  write_caption(image, pair.caption);
  return image;
}

render::Image side_by_side(const render::Image& left, const render::Image& right, int width, int height) {
  render::Image out(width, height, render::palette::kRule);
  out.paste(left, 0, 0);
  out.paste(right, left.width() + kGap, 0);
  return out;
}

render::Image both_views(const CasePicture& s, const Verdict& verdict, int width, int height,
                         render::Rasterizer& rasterizer) {
  std::optional<CloseUp> close = close_up(s, verdict);
  const bool shows_little = !close || kContext * diagonal(close->box) > diagonal(s.box) / kLeastCloseUp;
  const std::optional<LonePair> pair = shows_little ? lone_pair(s, verdict) : std::nullopt;
  if (pair) close.reset();
  const PictureFrame whole_frame(s.box);
  std::optional<PictureFrame> near_frame;
  if (close) near_frame.emplace(close->box);
  const render::ViewDirection direction = best_view(s, close ? *near_frame : whole_frame);

  const int left = close || pair ? (width - kGap) / 2 : width;
  const View whole{whole_frame, 2, direction};
  const std::vector<Eigen::Vector3d> points = all_points(s, whole_frame);
  const run::CameraFit fit = camera_of(whole, points, s);
  render::Image image = draw_view(s, whole, fit, left, height, rasterizer);
  if (pair) {
    write_caption(image, "whole");
    return side_by_side(image, draw_lone_pair(*pair, width - left - kGap, height, rasterizer), width, height);
  }
  if (!close) return image;

  frame_place(image, fit(left, height), corners_of(whole_frame, close->box), render::bounds(points));
  write_caption(image, "whole");

  const View near{*near_frame, kReach, direction};
  std::vector<Eigen::Vector3d> shown = corners_of(*near_frame, close->box);
  for (Eigen::Vector3d& p : shown) p *= kContext / std::numbers::sqrt3;
  render::Image detail =
      draw_view(s, near, camera_of(near, shown, s), width - left - kGap, height, rasterizer);
  write_caption(detail,
                close->caption + ", " +
                    render::short_number(diagonal(s.box) / std::max(diagonal(close->box) * kContext,
                                                                    std::numeric_limits<double>::min())) +
                    " times as large");
  return side_by_side(image, detail, width, height);
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

void draw_worst_case(const cases::Case& c, std::span<const SimplexPair> expected,
                     const std::optional<Pairs>& answered, const WorstCaseText& text, const std::string& path,
                     render::Rasterizer& rasterizer) {
  render::PngOptions png;
  png.text = {{"Title", text.title}, {"Description", text.answer}};
  render::write_png(worst_case_picture(c, expected, answered, text, rasterizer), path, png);
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
    const Grid& grid, const std::string& folder, const std::function<AnsweredPairs(const Record&)>& ask,
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
    const AnsweredPairs pairs = ask(r);
    try {
      const cases::Case c = cases::make_case(*family, r.seed, r.difficulty, r.case_index);
      draw_worst_case(grid.quantity == Quantity::self_intersections ? twice_joined(c) : c, pairs.expected,
                      pairs.answered, text_of(r, method.title), folder + "/" + file, rasterizer);
      pictures[i] = file;
    } catch (const InputError&) {
      // Coordinates that are not finite cannot be drawn; the record contains the parameters of the case.
    }
  }
  return pictures;
}

}  // namespace lrb::stability

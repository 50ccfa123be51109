#include "scenarios/run/answer_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "render/page_palette.hpp"
#include "scenarios/run/explanations.hpp"
#include "scenarios/run/scene_json.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::run {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
using render::counted;
using render::group_digits;
using render::short_number;
using Segment = std::array<Vector3d, 2>;

constexpr std::size_t kMaxFaces = 500'000;  // of a view

/// Answers about one body, as the page's view takes them.
struct Answers {
  const LrbRep& body;
  std::string what, group;  ///< names of an answer, and of those that belong together; group may be empty
  bool has_points = false;  ///< an answer is a point, the first end of its segment
  std::vector<render::LegendItem> kinds;
  std::vector<std::uint32_t> numbers, kind = {}, groups = {};
  std::vector<std::array<FaceId, 2>> faces = {};
  std::vector<std::vector<Segment>> segments = {};
};

std::string vector_text(const Vector3d& v, int dim) {
  std::string out;
  for (int i = 0; i < dim; ++i) out += (i == 0 ? "" : ", ") + short_number(v[i]);
  return out;
}

/// Returns the answers for the view, with coordinates relative to the body's centre and in units of its size.
std::string view_json(const Answers& answers) {
  using report::packed;
  SceneFrame frame{body_centre(answers.body), 1};
  const double size = box_of(answers.body).diagonal().norm();
  if (size > 0 && std::isfinite(size)) frame.unit = std::exp2(std::floor(std::log2(size)));
  json kinds = json::array();
  for (const render::LegendItem& kind : answers.kinds)
    kinds.push_back({{"name", kind.text}, {"colour", render::css(kind.colour)}});
  std::vector<std::uint32_t> faces, first = {0};
  std::vector<float> ends;
  for (const auto& pair : answers.faces)
    for (const FaceId face : pair) faces.push_back(face.value());
  for (const std::vector<Segment>& segments : answers.segments) {
    for (const Segment& s : segments)
      for (const Vector3d& x : s) frame.add_point(ends, x);
    first.push_back(static_cast<std::uint32_t>(ends.size() / 6));
  }
  return json{{"dim", answers.body.dim()},
              {"origin", {frame.origin.x(), frame.origin.y(), frame.origin.z()}},
              {"unit", frame.unit},
              {"colours", scene_colours()},
              {"body", real_body_json(answers.body, frame)},
              {"what", answers.what},
              {"group", answers.group},
              {"hasPoints", answers.has_points},
              {"kinds", std::move(kinds)},
              {"numbers", packed(answers.numbers)},
              {"kind", packed(answers.kind)},
              {"groups", packed(answers.groups)},
              {"faces", packed(faces)},
              {"first", packed(first)},
              {"ends", packed(ends)}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

void add_view(report::Document& doc, const Answers& answers) {
  if (answers.body.real_face_count() <= kMaxFaces)
    doc.answers_view(view_json(answers));
  else
    doc.purpose("No view: it is limited to " + group_digits(kMaxFaces) + " faces.");
}

std::string name_of_body(const LrbRep& body) {
  return std::filesystem::path(body.name()).stem().string();
}

std::string length_text(const std::vector<Segment>& segments) {
  double length = 0;
  for (const Segment& s : segments) length += (s[1] - s[0]).norm();
  return short_number(length);
}

}  // namespace

void write_page(const report::Folder& folder, const LrbRep& body, const ShownPoints& points,
                const std::string& command) {
  Answers answers{body, "point", "", true, {}, {}};
  for (const auto& where : kEnumNames<Where>) answers.kinds.push_back(key_of_points(where.value));
  answers.kinds.push_back(key_of_points({}));

  report::Table table{"Points", {"point", "side", "distance", "place", "closest point", "face", "feature"}};
  constexpr const char* kFeatures[] = {"vertex", "edge", "face"};
  for (const ShownPoints::Shown& p : points.shown()) {
    const PointDistance& d = p.distance;
    answers.numbers.push_back(static_cast<std::uint32_t>(p.number));
    answers.kind.push_back(static_cast<std::uint32_t>(ShownPoints::index(d.side)));
    answers.faces.push_back({d.closest.face, kNull});
    answers.segments.push_back({{p.point, d.closest.point}});
    const std::string number = std::to_string(p.number);
    table.rows.push_back({number, d.side ? std::string(name_of(*d.side)) : "",
                          interval_text(d.signed_lower(), d.signed_upper()), vector_text(p.point, body.dim()),
                          vector_text(d.closest.point, body.dim()), std::to_string(d.closest.face.value()),
                          kFeatures[d.closest.corner_count - 1]});
    table.targets.push_back("item " + number);
  }
  table.note = "Distances are negative inside. All digits: the lines that the command prints.";
  const std::string all = points.all() ? "" : ", evenly chosen from " + group_digits(points.total());
  report::Document doc("Points beside " + name_of_body(body),
                       "Signed distances of points to a body, as proven intervals: " +
                           counted(points.shown().size(), "point", "points") + all + ".");
  if (!body.closed()) doc.purpose("The body is not closed: it has no inside, and distances have no sign.");
  doc.command(command);
  if (body.closed())
    for (const auto& [where, label] : {std::pair(Where::inside, "Inside"),
                                       {Where::outside, "Outside"},
                                       {Where::on_surface, "On the surface"}})
      doc.number(
          {label, group_digits(points.count(where)), "of " + counted(points.total(), "point", "points")});
  for (const auto& [label, p] :
       {std::pair("Smallest distance", &points.smallest()), std::pair("Largest distance", &points.largest())})
    doc.number({label, interval_text(p->distance.signed_lower(), p->distance.signed_upper()),
                "point " + std::to_string(p->number)});
  add_view(doc, answers);
  doc.table(table).write(folder);
}

void write_page(const report::Folder& folder, const LrbRep& body, const SelfIntersections& found,
                const std::string& command) {
  Answers answers{body, "pair", "curve", false, {}, {}};
  for (const auto& kind : kEnumNames<SelfContact>) answers.kinds.push_back(key_of(kind.value));

  struct Curve {
    std::uint64_t pairs = 0;
    std::vector<Segment> segments;
    std::array<std::uint64_t, kEnumNames<SelfContact>.size()> kinds{};
  };
  std::vector<Curve> curves(found.curves);
  Curve all;
  report::Table table{"Pairs of faces",
                      {"pair", "faces", "kind", "curve", "corners shared", "segments", "length"}};
  for (std::size_t i = 0; i < found.pairs.size(); ++i) {
    const SelfIntersection& pair = found.pairs[i];
    const auto from = found.segments.begin() + pair.first_segment;
    const std::vector<Segment> segments(from, from + pair.segments);
    for (Curve* curve : {&curves[pair.curve], &all}) {
      ++curve->pairs;
      ++curve->kinds[static_cast<std::size_t>(pair.kind)];
      if (curve != &all) curve->segments.insert(curve->segments.end(), segments.begin(), segments.end());
    }
    if (i >= kMaxPairsOfPage) continue;
    answers.numbers.push_back(static_cast<std::uint32_t>(i));
    answers.kind.push_back(static_cast<std::uint32_t>(pair.kind));
    answers.groups.push_back(pair.curve);
    answers.faces.push_back({pair.a, pair.b});
    table.rows.push_back({std::to_string(i),
                          std::to_string(pair.a.value()) + ", " + std::to_string(pair.b.value()),
                          std::string(name_of(pair.kind)), std::to_string(pair.curve),
                          std::to_string(pair.shared), std::to_string(pair.segments), length_text(segments)});
    table.targets.push_back("item " + table.rows.back()[0]);
    answers.segments.push_back(segments);
  }
  const bool is_cut = found.pairs.size() > kMaxPairsOfPage;
  if (is_cut)
    table.note = "The first " + group_digits(kMaxPairsOfPage) + " of " + group_digits(found.pairs.size()) +
                 "; the command prints all.";

  constexpr std::size_t kMaxCurves = 500;
  report::Table of_curves{"Curves", {"curve", "pairs", "kinds", "segments", "length"}};
  for (std::size_t i = 0; i < std::min(curves.size(), kMaxCurves); ++i) {
    std::string kinds;
    for (std::size_t k = 0; k < curves[i].kinds.size(); ++k)
      if (curves[i].kinds[k] > 0)
        kinds += (kinds.empty() ? "" : ", ") + std::string(kEnumNames<SelfContact>[k].name);
    of_curves.rows.push_back({std::to_string(i), group_digits(curves[i].pairs), kinds,
                              group_digits(curves[i].segments.size()), length_text(curves[i].segments)});
    of_curves.targets.push_back("group " + of_curves.rows.back()[0]);
  }
  of_curves.note =
      "Connected components of all segments in which faces intersect. Segments of several pairs count for each.";
  if (curves.size() > kMaxCurves) of_curves.note += " The first " + std::to_string(kMaxCurves) + ".";

  report::Document doc(
      "Self-intersections of " + name_of_body(body),
      "Pairs of faces that share a point beyond the corners and edges that they have in common, exactly.");
  if (is_cut) doc.purpose("The view has the first " + group_digits(kMaxPairsOfPage) + " pairs.");
  doc.verdict(found.pairs.empty() ? "none" : counted(found.pairs.size(), "pair", "pairs"),
              found.pairs.empty())
      .command(command)
      .number({"Pairs of faces", group_digits(found.pairs.size()),
               "of " + counted(body.real_face_count(), "face", "faces")})
      .number({"Curves", group_digits(found.curves), "connected components"});
  constexpr const char* kLabels[] = {"Touch", "Cross", "Overlap"};
  for (std::size_t k = 0; k < all.kinds.size(); ++k)
    if (all.kinds[k] > 0) doc.number({kLabels[k], group_digits(all.kinds[k]), "pairs"});
  add_view(doc, answers);
  if (!curves.empty()) doc.table(of_curves).table(table);
  doc.write(folder);
}

}  // namespace lrb::run

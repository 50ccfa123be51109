#include "scenarios/exchange/model.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include <Eigen/LU>

#include "scenarios/frames/face_colours.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/trace/counters.hpp>
namespace lrb::exchange {
void Part::add_cell(std::span<const std::uint32_t> at, render::Rgba colour, std::span<const double> row) {
  corners.insert(corners.end(), at.begin(), at.end());
  offsets.push_back(static_cast<std::uint32_t>(corners.size()));
  colours.push_back(colour);
  values.resize(row.size());
  for (std::size_t i = 0; i < row.size(); ++i) values[i].push_back(row[i]);
}

std::size_t Model::column(std::string_view name) const {
  const auto at =
      std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  if (at == columns.end()) throw std::logic_error("a model without the column " + std::string(name));
  return static_cast<std::size_t>(at - columns.begin());
}

namespace {

/// Returns the ending of a file's name, in lower case. Throws InputError unless it is one of a format.
std::string format_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (ending != ".ply" && ending != ".vtp" && ending != ".glb")
    throw InputError(printable_name(path) + ": expected a name that ends in .ply, .vtp or .glb");
  return ending;
}

}  // namespace

void save_model(const Model& model, const std::string& path, int up) {
  const std::string format = format_of(path);
  io::write_text(path, format == ".ply"   ? ply_bytes(model)
                       : format == ".vtp" ? vtp_bytes(model)
                                          : glb_bytes(model, up));
}

void check_model_file(const std::string& path) {
  format_of(path);
}

namespace {

using ColourBy = pictures::FrameSpec::ColourBy;
using render::Rgba;

constexpr double kNone = -1;
enum Kind : std::uint8_t { kPseudo, kReal, kContact };

/// As in the pictures: whitish and translucent.
Rgba lid_colour(Side side) {
  return render::with_alpha(render::mix(render::palette::body(side), render::kWhite, 0.70), 124);
}

bool has_values(const Moment& m) {
  return m.colour_by >= ColourBy::face_tests;
}

std::vector<Column> columns_of(const Moment& m, const Wanted& wanted) {
  std::vector<Column> out = {{"side"},  {"kind"},  {"face"},           {"region"},
                             {"layer"}, {"level"}, {"distance", false}};
  if (m.events)
    for (const char* name : {"tests", "hits", "misses", "refinements", "contacts"}) out.push_back({name});
  if (has_values(m)) out.push_back({"value", false});
  if (wanted.contacts)
    out.insert(out.end(), {{"contact"}, {"length", false}, {"area", false}, {"depth_estimate", false}});
  return out;
}

double distance_of(const LrbRep& rep, FaceId f, std::span<const double> needed) {
  if (rep.is_real(f)) return 0;
  const CellId behind = rep.inner_cell(f);
  if (!is_region(behind) || needed.empty()) return kNone;
  const double bound = needed[behind.as_region()];
  return std::isfinite(bound) ? bound : kNone;
}

double or_none(std::uint32_t number) {
  return number == kNull ? kNone : number;
}

/// Makes the parts of one body.
class BodyParts {
 public:
  BodyParts(const Model& model, const Moment& moment, Side side)
      : model_(model),
        moment_(moment),
        body_(moment.bodies[static_cast<std::size_t>(side)]),
        rep_(*body_.rep),
        side_(side),
        mirrored_(body_.pose.r.determinant() < 0) {
    if (rep_.region_count() > 0) needed_ = rep_.levels(0).needed();
    if (moment.events) counts_ = trace::count_faces(rep_, side, *moment.events);
    if (has_values(moment) && moment.events)
      values_ = frames::grouped(frames::face_values(moment.colour_by, rep_, side, *moment.events, body_.tree),
                                moment.colour_per, rep_);
  }

  const std::vector<double>& values() const { return values_; }

  Part part(const std::string& name, const std::vector<FaceId>& faces, std::span<const Rgba> colours) const {
    Part out;
    out.name = name;
    out.shape = rep_.dim() == 2 ? Shape::lines : Shape::polygons;
    out.values.resize(model_.columns.size());
    const std::vector<std::uint32_t> number = add_vertices(faces, out);
    std::vector<std::uint32_t> corners;
    for (const FaceId f : faces) {
      corners.clear();
      for (const VertexId v : rep_.face(f)) corners.push_back(number[v]);
      if (mirrored_ != faces_inward(f)) std::reverse(corners.begin(), corners.end());
      out.add_cell(corners, colours[f], row_of(f));
    }
    return out;
  }

 private:
  /// Adds the vertices that faces use, in the LRB-rep's order, and returns their numbers.
  std::vector<std::uint32_t> add_vertices(const std::vector<FaceId>& faces, Part& out) const {
    std::vector<std::uint8_t> used(rep_.vertices().size());
    for (const FaceId f : faces)
      for (const VertexId v : rep_.face(f)) used[v] = 1;
    std::vector<std::uint32_t> number(used.size());
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (used[v] == 0) continue;
      number[v] = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.push_back(body_.pose.apply(rep_.vertices()[v]));
    }
    return number;
  }

  /// Returns true for a face of the wrapper with the wrapper in front of it: the lid of a refined region
  /// under an included one.
  bool faces_inward(FaceId f) const {
    return body_.wrapper != nullptr && body_.wrapper->included(rep_.outer_cell(f)) &&
           !body_.wrapper->included(rep_.inner_cell(f));
  }

  std::vector<double> row_of(FaceId f) const {
    const std::uint32_t region = frames::region_of(rep_, f);
    std::vector<double> row = {static_cast<double>(side_),
                               static_cast<double>(rep_.is_real(f) ? kReal : kPseudo),
                               static_cast<double>(f.value()),
                               or_none(region),
                               region == kNull ? kNone : rep_.layer(RegionId(region)),
                               static_cast<double>(frames::level_of(rep_, f)),
                               distance_of(rep_, f, needed_)};
    if (moment_.events)
      for (const auto* of :
           {&counts_.tests, &counts_.hits, &counts_.misses, &counts_.refinements, &counts_.contacts})
        row.push_back((*of)[f]);
    if (has_values(moment_)) row.push_back(values_.empty() ? kNone : values_[f]);
    row.resize(model_.columns.size(), kNone);
    return row;
  }

  const Model& model_;
  const Moment& moment_;
  const BodyMoment& body_;
  const LrbRep& rep_;
  Side side_;
  bool mirrored_;
  std::span<const double> needed_;
  trace::FaceCounts counts_;
  std::vector<double> values_;
};

render::SceneOptions scene_options(const Moment& moment) {
  render::SceneOptions out;
  switch (moment.colour_by) {
    case ColourBy::kind:
      break;
    case ColourBy::layer:
      out.colour_by = render::ColourBy::layer;
      break;
    case ColourBy::region:
      out.colour_by = render::ColourBy::region;
      break;
    default:
      out.colour_by = render::ColourBy::value;
      break;
  }
  return out;
}

/// Returns the colours of all faces of the bodies as in the pictures; empty for 2D bodies.
std::vector<std::vector<Rgba>> face_colours(const Moment& moment, std::span<const BodyParts> parts) {
  std::vector<render::SceneBody> bodies;
  std::vector<std::vector<Rgba>> out;
  for (std::size_t i = 0; i < moment.bodies.size(); ++i) {
    const BodyMoment& body = moment.bodies[i];
    bodies.push_back({body.rep, body.wrapper, body.pose, parts[i].values(), {}, {}, {}});
    const Side side = static_cast<Side>(i);
    std::vector<Rgba>& colours = out.emplace_back(body.rep->face_count(), lid_colour(side));
    std::fill_n(colours.begin(), body.rep->real_face_count(), render::palette::body(side));
  }
  std::vector<std::vector<std::uint8_t>> found;
  for (const std::vector<Rgba>& colours : out) found.emplace_back(colours.size());
  const render::Scene scene = render::build_scene(bodies, {}, scene_options(moment));
  for (const render::DrawTriangle& t : scene.list.triangles) {
    const std::size_t side = t.id >> 31;
    const std::uint32_t face = t.id & ~(1U << 31);
    if (side >= out.size() || face >= out[side].size() || found[side][face] != 0) continue;
    found[side][face] = 1;
    out[side][face] = t.colour;
  }
  return out;
}

std::vector<FaceId> real_faces(const LrbRep& rep) {
  std::vector<FaceId> out(rep.real_face_count());
  std::iota(out.begin(), out.end(), FaceId{0});
  return out;
}

/// Adds the curves or the single points of contact regions.
void add_contacts(Model& model, const Moment& moment, Shape shape) {
  Part out;
  out.name = shape == Shape::lines ? "contact_curves" : "contact_points";
  out.shape = shape;
  out.values.resize(model.columns.size());
  for (std::size_t i = 0; i < moment.contacts.size(); ++i) {
    const ContactRegion& region = moment.contacts[i];
    std::vector<double> row(model.columns.size(), kNone);
    row[model.column("kind")] = kContact;
    row[model.column("contact")] = static_cast<double>(i);
    row[model.column("length")] = region.length;
    row[model.column("area")] = region.area;
    row[model.column("depth_estimate")] = region.depth_estimate;
    for (const ContactLoop& loop : region.loops) {
      if (loop.points.empty() || (loop.points.size() > 1) != (shape == Shape::lines)) continue;
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.insert(out.vertices.end(), loop.points.begin(), loop.points.end());
      std::vector<std::uint32_t> at(loop.points.size());
      std::iota(at.begin(), at.end(), first);
      if (loop.closed) at.push_back(first);
      out.add_cell(at, render::palette::kContact, row);
    }
  }
  if (out.cell_count() > 0) model.parts.push_back(std::move(out));
}

}  // namespace

Model make_model(const Moment& moment, const Wanted& wanted) {
  Model model;
  model.title = moment.title;
  model.columns = columns_of(moment, wanted);
  model.quality = has_values(moment) ? "value" : moment.events ? "tests" : "distance";
  std::vector<BodyParts> bodies;
  for (std::size_t i = 0; i < moment.bodies.size(); ++i)
    bodies.emplace_back(model, moment, static_cast<Side>(i));
  const std::vector<std::vector<Rgba>> colours = face_colours(moment, bodies);
  for (std::size_t i = 0; i < moment.bodies.size(); ++i) {
    if (!wanted.side[i]) continue;
    const BodyMoment& body = moment.bodies[i];
    const std::string name = i == 0 ? "A" : "B";
    if (wanted.body) model.parts.push_back(bodies[i].part(name, real_faces(*body.rep), colours[i]));
    if (wanted.wrapper && body.wrapper != nullptr)
      model.parts.push_back(bodies[i].part(name + "_wrapper", body.wrapper->boundary(), colours[i]));
  }
  if (wanted.contacts)
    for (const Shape shape : {Shape::lines, Shape::points}) add_contacts(model, moment, shape);
  return model;
}

Wrapper wrapper_of_layers(const LrbRep& rep, std::uint32_t layers) {
  Wrapper wrapper(rep);
  for (RegionId r = 0; r < rep.region_count(); ++r)
    if (rep.layer(r) >= layers) wrapper.refine(r);
  return wrapper;
}

}  // namespace lrb::exchange

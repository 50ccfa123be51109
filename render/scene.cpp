#include <algorithm>
#include <iterator>
#include <map>

#include "render/scene_parts.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/scene.hpp>
namespace lrb::render {
namespace scene {

std::string Context::name() const {
  return body.name.empty() ? (side == Side::a ? "A" : "B") : body.name;
}

Rgba Context::colour() const {
  return body.colour.value_or(style().body(side));
}

bool Context::isolating() const {
  return !options.isolate[0].empty() || !options.isolate[1].empty();
}

bool Context::isolated(RegionId r) const {
  return std::find(isolated().begin(), isolated().end(), r) != isolated().end();
}

bool Context::refining(RegionId r) const {
  return std::find(refining().begin(), refining().end(), r) != refining().end();
}

bool Context::built(RegionId r) const {
  return building() && std::binary_search(highlight.built->begin(), highlight.built->end(), r);
}

Rgba Context::built_colour(RegionId r) const {
  return options.colour_by == ColourBy::kind ? style().refining : region_colour(r);
}

std::vector<Eigen::Vector3d> Context::corners(FaceId f, const Eigen::Vector3d& moved) const {
  std::vector<Eigen::Vector3d> at = corners_of(*body.rep, f, body.pose);
  for (Eigen::Vector3d& x : at) x += moved;
  return at;
}

std::vector<FaceId> Context::pseudo_in_contact() const {
  std::vector<FaceId> faces;
  for (FaceId f(body.rep->real_face_count()); f < body.rep->face_count(); ++f)
    if (in_contact(f)) faces.push_back(f);
  return faces;
}

Rgba Context::region_colour(RegionId r) const {
  switch (options.colour_by) {
    case ColourBy::layer:
      return style().value(layers > 1 ? static_cast<double>(body.rep->layer(r)) / (layers - 1) : 1.0);
    case ColourBy::region:
      return palette::category(r);
    default:
      return colour();
  }
}

Rgba Context::colour_of(FaceId f, CellId cell) const {
  // Faces without a value are pale; the others are on the scale.
  if (options.colour_by == ColourBy::value) {
    if (!has_value(f)) return style().pale(colour(), palette::kNoValuePale);
    const double range = value_high - value_low;
    return style().value(range > 0 ? (body.face_values[f] - value_low) / range : 0);
  }
  if (is_region(cell)) return region_colour(cell.as_region());
  return options.colour_by == ColourBy::kind ? colour() : style().pale(colour(), palette::kGroundPale);
}

void Context::add_key(LegendItem::Mark mark, Rgba colour, const std::string& text,
                      const std::optional<LegendItem::Swatch>& swatch) const {
  const auto same = [&](const LegendItem& i) { return i.text == text; };
  if (std::none_of(out.key.begin(), out.key.end(), same)) out.key.push_back({mark, colour, text, swatch});
}

std::vector<Chain> chains(const std::vector<std::array<VertexId, 2>>& segments) {
  std::multimap<VertexId, std::size_t> from;
  std::map<VertexId, int>
      balance;  // number of segments that end here minus number that start here: an open chain starts at -1
  // Index the segments by their start, and find where open chains begin.
  for (std::size_t i = 0; i < segments.size(); ++i) {
    from.emplace(segments[i][0], i);
    --balance[segments[i][0]];
    ++balance[segments[i][1]];
  }
  std::vector<Chain> out;
  // Follow and consume segments until the chain closes or ends.
  const auto follow = [&](VertexId v) {
    Chain chain{{v}, false};
    for (auto next = from.find(v); next != from.end(); next = from.find(v)) {
      v = segments[next->second][1];
      from.erase(next);
      if (v == chain.vertices.front()) {
        chain.closed = true;
        break;
      }
      chain.vertices.push_back(v);
    }
    out.push_back(std::move(chain));
  };
  // Open chains first: starting a closed one inside them would cut them in two.
  for (const auto& [v, surplus] : balance) {
    for (int i = surplus; i < 0; ++i) {
      if (from.contains(v)) follow(v);
    }
  }
  // Only loops are left.
  while (!from.empty()) follow(from.begin()->first);
  return out;
}

}  // namespace scene

namespace {

using Mark = LegendItem::Mark;

/// A contact smaller than this share of the scene gets a dot, so that it is noticeable.
constexpr double kTinyContact = 0.01;

void check(std::span<const SceneBody> bodies, const SceneHighlight& highlight, const SceneOptions& options) {
  if (bodies.empty()) throw InputError("scene: expected at least one body, found none");
  if (bodies.size() > 2 &&
      (highlight.under_test || !highlight.refining[0].empty() || !highlight.refining[1].empty() ||
       !options.isolate[0].empty() || !options.isolate[1].empty()))
    throw InputError("scene: expected at most two bodies for highlighted regions and pairs");
  for (std::size_t i = 0; i < 2; ++i) {
    static const std::vector<RegionId> kNone;
    const std::vector<RegionId>& built = i == 0 && highlight.built ? *highlight.built : kNone;
    // Validate all indices once, so that drawing need not.
    for (const auto* regions : {&highlight.refining[i], &options.isolate[i], &built}) {
      for (const RegionId r : *regions) {
        if (i < bodies.size() && r < bodies[i].rep->region_count()) continue;
        throw InputError("body " + std::string(i == 0 ? "A" : "B") + " has no region " + std::to_string(r) +
                         "");
      }
    }
    if (!highlight.under_test) continue;
    if (i >= bodies.size() || (*highlight.under_test)[i] >= bodies[i].rep->simplex_count()) {
      throw InputError("the tested pair: no simplex " + std::to_string((*highlight.under_test)[i]) +
                       " in the body");
    }
  }
  for (const SceneBody& b : bodies) {
    if (b.rep->dim() != bodies[0].rep->dim())
      throw InputError("scene: expected bodies of the same dimension, found 2D and 3D bodies");
  }
}

struct ValueRange {
  double low = 0, high = 0;  ///< at the ends of the scale
  double most = 0;           ///< the maximum, which `high` may be below
};

/// Returns the range of values: as requested, else from zero to what 99 of 100 positive values do not exceed,
/// since few outliers would leave all others pale.
ValueRange value_range(std::span<const SceneBody> bodies, const SceneOptions& options) {
  std::vector<double> values;
  for (const SceneBody& b : bodies)
    std::copy_if(b.face_values.begin(), b.face_values.end(), std::back_inserter(values),
                 [](double v) { return v > 0; });
  std::sort(values.begin(), values.end());
  ValueRange out;
  if (!values.empty()) out = {0, values[(99 * values.size() + 99) / 100 - 1], values.back()};
  if (options.value_range) out.low = (*options.value_range)[0], out.high = (*options.value_range)[1];
  return out;
}

void add_pair_under_test(std::span<const SceneBody> bodies, const SceneHighlight& highlight,
                         const SceneOptions& options, Scene& out) {
  const Style& style = style_of(options.style);
  for (std::size_t i = 0; i < 2; ++i) {
    const SceneBody& body = bodies[i];
    const SimplexId simplex = (*highlight.under_test)[i];
    std::array<VertexId, 3> ids{};
    body.rep->simplex(simplex, ids.data());
    const Eigen::Vector3d moved =
        exploded_way(*body.rep, body.pose, body.rep->face_of_simplex(simplex), options.explode);
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return body.pose.apply(body.rep->vertices()[ids[static_cast<std::size_t>(k)]]) + moved;
    };
    // The outline with a halo marks the simplex even if it is tiny on the screen.
    DrawLine outline;
    const int n = body.rep->simplex_size();
    for (int k = 0; k < n; ++k) outline.points.push_back(corner(k));
    outline.closed = n == 3;
    outline.colour = style.edge_of(style.body(static_cast<Side>(i)));
    outline.width = 2.4F * options.scale;
    outline.halo = style.under_test;
    outline.halo_width = (n == 2 ? 3.0F : 1.4F) * options.scale;
    outline.layer = Layer::on_top;
    out.list.lines.push_back(outline);
    if (n != 3) continue;
    DrawTriangle t;
    t.x = {corner(0), corner(1), corner(2)};
    t.colour = with_alpha(style.under_test, 200);
    t.layer = Layer::on_top;
    t.lit = false;
    t.nudge = 2;
    out.list.triangles.push_back(t);
  }
  out.key.push_back({Mark::solid, style.under_test, "pair under test"});
}

void add_contacts(const SceneHighlight& highlight, const SceneOptions& options, double size, bool flat,
                  Scene& out) {
  const Style& style = style_of(options.style);
  DrawPoint dot;
  dot.colour = style.contact;
  dot.radius = 4.5F * options.scale;
  dot.halo = style.paper;
  dot.halo_width = 1.6F * options.scale;
  dot.layer = Layer::on_top;
  bool lines = false;
  for (const ContactRegion& region : highlight.contacts) {
    if (region.loops.empty()) {  // a contact at a single point has no curve
      dot.x = region.centroid;
      out.list.points.push_back(dot);
    }
    // The intersection curves, whose extent decides whether a dot is needed.
    Eigen::AlignedBox3d curves;
    for (const ContactLoop& loop : region.loops) {
      if (loop.points.size() == 1) {
        dot.x = loop.points[0];
        out.list.points.push_back(dot);
        continue;
      }
      for (const auto& x : loop.points) curves.extend(x);
      DrawLine line;
      line.points = loop.points;
      line.closed = loop.closed;
      line.colour = style.contact;
      line.width = 3 * options.scale;
      line.halo = style.paper;
      line.halo_width = 1.5F * options.scale;
      line.layer = Layer::on_top;
      out.list.lines.push_back(line);
      lines = true;
    }
    if (!curves.isEmpty() && curves.diagonal().norm() < kTinyContact * size) {
      dot.x = curves.center();
      out.list.points.push_back(dot);
    }
  }
  if (highlight.contacts.empty()) return;
  out.key.push_back({lines ? Mark::line : Mark::point, style.contact, "contact"});
  if (lines && !flat) out.key.push_back({Mark::dashed, style.contact, "contact, hidden"});
}

}  // namespace

Scene build_scene(std::span<const SceneBody> bodies, const SceneHighlight& highlight,
                  const SceneOptions& options) {
  check(bodies, highlight, options);
  // Values and layers are common to all bodies, so that colours are comparable.
  const ValueRange range = value_range(bodies, options);
  const bool flat = bodies[0].rep->dim() == 2;
  std::uint32_t layers = 1;
  for (const SceneBody& b : bodies) layers = std::max(layers, b.rep->layer_count());
  Scene out;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const scene::Context context{
        bodies[i], i == 0 ? Side::a : Side::b, highlight, options, range.low, range.high, layers, out};
    flat ? scene::add_body_2d(context) : scene::add_body_3d(context);
  }
  if (!highlight.refining[0].empty() || !highlight.refining[1].empty()) {
    const Style& style = style_of(options.style);
    out.key.push_back(
        flat ? LegendItem{Mark::solid, style.pale(style.refining, scene::kRefining2d), "region being refined"}
             : LegendItem{Mark::translucent, style.refining, "region being refined"});
  }
  // The size of the bodies, before markers are added.
  const double size = bounds(out.list).isEmpty() ? 0 : bounds(out.list).diagonal().norm();
  if (highlight.under_test) add_pair_under_test(bodies, highlight, options, out);
  add_contacts(highlight, options, size, flat, out);
  if (options.colour_by == ColourBy::value) {
    const auto most = static_cast<std::uint64_t>(range.most + 0.5);
    out.scale =
        ScaleBar{options.value_name + (range.most > range.high ? ", at most " + group_digits(most) : ""),
                 range.low, range.high};
  }
  if (options.colour_by == ColourBy::layer) {
    out.scale = ScaleBar{"layer (0: innermost)", 0, static_cast<double>(layers - 1)};
  }
  return out;
}

std::vector<Eigen::Vector3d> corners_of(const LrbRep& rep, FaceId face, const Pose& pose) {
  std::vector<Eigen::Vector3d> out;
  for (const VertexId v : rep.face(face)) out.push_back(pose.apply(rep.vertices()[v]));
  return out;
}

std::vector<Eigen::Vector3d> body_points(const LrbRep& rep, const Pose& pose) {
  std::vector<Eigen::Vector3d> out;
  for (const auto& x : rep.vertices()) out.push_back(pose.apply(x));
  return out;
}

namespace {

/// Returns the mean of the faces' corners, posed.
Eigen::Vector3d centroid(const LrbRep& rep, const Pose& pose, std::span<const FaceId> faces) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const FaceId f : faces) {
    for (const Eigen::Vector3d& x : render::corners_of(rep, f, pose)) sum += x;
    count += rep.face(f).size();
  }
  return count > 0 ? Eigen::Vector3d(sum / static_cast<double>(count)) : sum;
}

}  // namespace

Eigen::Vector3d exploded_way(const LrbRep& rep, const Pose& pose, RegionId r, double explode) {
  constexpr double kSpread = 1.1;  // way of the outermost layer, as a share of the wrapper's radius
  // The outermost layer rises first, and the others follow, one after the other.
  const double layers = rep.layer_count(), rise = explode * layers - (layers - 1 - rep.layer(r));
  if (!(rise > 0) || rep.lids(r).empty()) return Eigen::Vector3d::Zero();  // a filled void has none
  // A region moves where its lids look.
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (const FaceId f : rep.lids(r)) {
    const std::vector<Eigen::Vector3d> x = corners_of(rep, f, pose);
    if (rep.dim() == 2) out += (x[1] - x[0]).cross(Eigen::Vector3d::UnitZ());
    for (std::size_t i = 1; i + 1 < x.size(); ++i) out += (x[i] - x[0]).cross(x[i + 1] - x[0]);
  }
  const Eigen::Vector3d centre = centroid(rep, pose, rep.outermost_faces());
  if (out.isZero(0)) out = centroid(rep, pose, rep.lids(r)) - centre;
  double radius = 0;
  for (const FaceId f : rep.outermost_faces())
    for (const Eigen::Vector3d& x : corners_of(rep, f, pose)) radius = std::max(radius, (x - centre).norm());
  return out.stableNormalized() * (kSpread * radius * rise / layers);
}

Eigen::Vector3d exploded_way(const LrbRep& rep, const Pose& pose, FaceId f, double explode) {
  const CellId behind = rep.inner_cell(f);
  if (!(explode > 0) || !is_region(behind)) return Eigen::Vector3d::Zero();
  return exploded_way(rep, pose, behind.as_region(), explode);
}

std::vector<Eigen::Vector3d> contact_points(std::span<const ContactRegion> contacts) {
  std::vector<Eigen::Vector3d> out;
  for (const ContactRegion& r : contacts) {
    for (const ContactLoop& loop : r.loops) out.insert(out.end(), loop.points.begin(), loop.points.end());
    if (r.loops.empty()) out.push_back(r.centroid);
  }
  return out;
}

}  // namespace lrb::render

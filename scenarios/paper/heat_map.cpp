#include <algorithm>
#include <cmath>

#include "scenarios/paper/paper_pictures.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/replay.hpp>

namespace lrb::paper {
namespace {

constexpr int kPanelWidth = 560, kPanelHeight = 500;
constexpr double kAside = 0.45;  ///< how far the viewer stands aside from the other body's place, over the
                                 ///< distance

/// Lighting in which the shape is seen and colours stay those of the scale.
const render::Lighting kSoft{.ambient = 0.78, .head = 0.1, .key = 0.16, .fill = 0.05};

/// What one panel shows.
struct PanelView {
  Side side;
  const CloseUp* collision;
  const CollideResult* contact;  ///< of its last time step
  const char* which;             ///< easiest or hardest
  bool near;                     ///< where the bodies meet, else the whole body
};

std::vector<double> tests_of(const PaperPair& pair, const PanelView& view) {
  const trace::FaceCounts counts =
      trace::count_faces(pair.rep(view.side), view.side, view.collision->trace.events);
  return {counts.tests.begin(), counts.tests.end()};
}

Pose pose_of(const PanelView& view) {
  const ContactStep& last = view.collision->steps.back();
  return view.side == Side::a ? last.pose_a : last.pose_x;
}

Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : render::body_points(rep, pose)) box.extend(p);
  return box;
}

/// Returns the direction from the place of the other body, a little aside, onto the faces that it met.
render::ViewDirection view_of(const PaperPair& pair, const PanelView& view) {
  const ContactStep& last = view.collision->steps.back();
  const Eigen::Vector3d way =
      box_of(pair.x.rep, last.pose_x).center() - box_of(pair.a.rep, last.pose_a).center();
  const Eigen::Vector3d from = (view.side == Side::a ? way : -way).normalized();
  int flat = 0;  // the axis that is most nearly perpendicular to the direction
  from.cwiseAbs().minCoeff(&flat);
  const Eigen::Vector3d up = Eigen::Vector3d::Unit(flat), aside = from.cross(up).normalized();
  return {from + kAside * (aside + 0.7 * up), up};
}

/// Asks where the bodies meet in the last time step.
CollideResult contact_of(const PaperPair& pair, const CloseUp& c) {
  CollideRequest request;
  request.contacts = true;
  return collide(pair.a.rep, c.steps.back().pose_a, pair.x.rep, c.steps.back().pose_x, request);
}

/// Returns the points of the contact region with most pairs of faces.
std::vector<Eigen::Vector3d> largest_contact(const CollideResult& contact) {
  const auto less = [](const ContactRegion& p, const ContactRegion& q) {
    return p.pairs.size() < q.pairs.size();
  };
  const auto largest = std::max_element(contact.regions.begin(), contact.regions.end(), less);
  return render::contact_points(std::span(&*largest, 1));
}

render::Camera camera_of(const PaperPair& pair, const PanelView& view) {
  const LrbRep& rep = pair.rep(view.side);
  render::FitOptions fit;
  fit.view = view_of(pair, view);
  constexpr double kAround = 1.2, kLeast = 0.12;  // as shares of the contact's size and of the body's
  return view.near
             ? render::fit_contact(largest_contact(*view.contact), box_of(rep, pose_of(view)), kPanelWidth,
                                   kPanelHeight, fit, kAround, kLeast)
             : render::fit_camera(render::body_points(rep, pose_of(view)), kPanelWidth, kPanelHeight, fit);
}

/// Returns the place of a count on the scale, which is logarithmic because a few faces get most of the tests:
/// 0 for none, 1 for the largest of all.
double share(double tests, double most) {
  return most > 0 ? std::log1p(tests) / std::log1p(most) : 0;
}

/// Draws the wrapper as the last time step left it, without anything translucent, so that colours are those
/// of the scale; and where the bodies meet.
render::DrawList wrapper_list(const PaperPair& pair, const PanelView& view, double most) {
  const LrbRep& rep = pair.rep(view.side);
  const std::vector<double> tests = tests_of(pair, view);
  trace::Cursor cursor(view.collision->trace, pair.a.rep, pair.x.rep);
  cursor.seek(static_cast<trace::EventId>(view.collision->trace.events.size() - 1));
  render::DrawList list;
  list.edge_styles[0] = {render::with_alpha(render::kWhite, 110), 0.8F};
  for (const FaceId f : cursor.wrapper(view.side).boundary()) {
    render::DrawTriangle t;
    t.colour = tests[f] > 0 ? render::palette::viridis(share(tests[f], most)) : render::palette::kPaleFront;
    t.edges = 7;
    std::vector<Eigen::Vector3d> corners;
    for (const VertexId v : rep.face(f)) corners.push_back(pose_of(view).apply(rep.vertices()[v]));
    list.add_polygon(corners, t);
  }
  for (const ContactRegion& region : view.contact->regions)
    for (const ContactLoop& loop : region.loops) {
      render::DrawLine line;
      line.points = loop.points;
      line.closed = loop.closed;
      line.colour = render::palette::kContact;
      line.width = 3;
      line.halo = render::kWhite;
      line.halo_width = 1;
      line.layer = render::Layer::on_top;
      list.lines.push_back(line);
    }
  return list;
}

render::Panel draw_panel(render::Rasterizer& rasterizer, const PaperPair& pair, const PanelView& view,
                         double most) {
  render::RasterOptions raster;
  raster.width = kPanelWidth;
  raster.height = kPanelHeight;
  raster.lighting = kSoft;
  const std::string what = view.near ? ", close up"
                                     : ", " + std::string(view.which) + ": " +
                                           render::group_digits(view.collision->comparisons) + " face tests";
  return {rasterizer.draw(wrapper_list(pair, view, most), camera_of(pair, view), raster),
          pair.name(view.side) + what};
}

}  // namespace

render::Image draw_heat_maps(const PaperPair& pair, const CloseUp& easiest, const CloseUp& hardest) {
  const CollideResult contacts[2] = {contact_of(pair, easiest), contact_of(pair, hardest)};
  std::vector<PanelView> views;
  for (const bool hard : {false, true})
    for (const Side side : {Side::a, Side::b})
      for (const bool near : {false, true})
        views.push_back(
            {side, hard ? &hardest : &easiest, &contacts[hard ? 1 : 0], hard ? "hardest" : "easiest", near});
  double most = 0;
  for (const PanelView& view : views) {
    const std::vector<double> tests = tests_of(pair, view);
    most = std::max(most, *std::max_element(tests.begin(), tests.end()));
  }
  render::Rasterizer rasterizer;
  std::vector<render::Panel> panels;
  for (const PanelView& view : views) panels.push_back(draw_panel(rasterizer, pair, view, most));
  render::MontageOptions options;
  options.columns = 4;
  options.text_height = 28;
  const render::Image all = render::montage(panels, options);

  render::Overlay overlay;
  overlay.key = {{render::LegendItem::Mark::line, render::palette::kContact, "contact at the last step"},
                 {render::LegendItem::Mark::dashed, render::palette::kContact, "contact, hidden"}};
  overlay.scale = render::ScaleBar{"face tests per face (log scale)", 0, most};
  constexpr int kRoom = 400;  // more than the legend needs; what it does not need is cut off
  const render::OverlayLayout tentative = render::lay_out(overlay, all.width(), all.height() + kRoom);
  const int height = all.height() + (all.height() + kRoom - tentative.picture.height);
  return render::compose_frame(all, all.rect(), overlay, all.width(), height);
}

}  // namespace lrb::paper

#include <algorithm>
#include <cmath>

#include "render/pictures/panel.hpp"
#include "scenarios/paper/paper_pictures.hpp"
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/replay.hpp>

namespace lrb::paper {
namespace {

constexpr int kPanelWidth = 560, kPanelHeight = 500;
constexpr double kAside = 0.45;  ///< lateral offset of the viewer from the direction of the other body

/// The subject of a panel.
struct PanelView {
  Side side;
  const CloseUp* collision;
  const CollideResult* contact;  ///< of its last time step
  const char* which;             ///< easiest or hardest
  bool near;                     ///< close-up of the contact, else the whole body
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

/// Returns the bounding box of everything that a body can show.
Eigen::AlignedBox3d whole_box(const LrbRep& rep, const Pose& pose) {
  return render::bounds(render::body_points(rep, pose));
}

/// Returns the direction from the other body, at an angle, towards the faces that it intersects.
render::ViewDirection view_of(const PaperPair& pair, const PanelView& view) {
  const ContactStep& last = view.collision->steps.back();
  const Eigen::Vector3d way =
      whole_box(pair.x.rep, last.pose_x).center() - whole_box(pair.a.rep, last.pose_a).center();
  const Eigen::Vector3d from = (view.side == Side::a ? way : -way).normalized();
  int flat = 0;  // the axis that is most nearly perpendicular to the direction
  from.cwiseAbs().minCoeff(&flat);
  const Eigen::Vector3d up = Eigen::Vector3d::Unit(flat), aside = from.cross(up).normalized();
  return {from + kAside * (aside + 0.7 * up), up};
}

/// Computes the contacts of the last time step.
CollideResult contact_of(const PaperPair& pair, const CloseUp& c) {
  CollideRequest request;
  request.contacts = true;
  return collide(pair.a.rep, c.steps.back().pose_a, pair.x.rep, c.steps.back().pose_x, request);
}

/// Returns the points of the contact region with the most pairs of faces.
std::vector<Eigen::Vector3d> largest_contact(const CollideResult& contact) {
  const auto less = [](const ContactRegion& p, const ContactRegion& q) {
    return p.pairs.size() < q.pairs.size();
  };
  const auto largest = std::max_element(contact.regions.begin(), contact.regions.end(), less);
  return render::contact_points(std::span(&*largest, 1));
}

run::CameraFit camera_of(const PaperPair& pair, const PanelView& view) {
  const LrbRep& rep = pair.rep(view.side);
  render::FitOptions fit;
  fit.view = view_of(pair, view);
  if (!view.near) return run::fit_points(render::body_points(rep, pose_of(view)), 3, fit);
  return [points = largest_contact(*view.contact), box = whole_box(rep, pose_of(view)), fit](double width,
                                                                                             double height) {
    constexpr double kAround = 1.2, kLeast = 0.12;  // as shares of the contact's size and of the body's
    return render::fit_contact(points, box, width, height, fit, kAround, kLeast);
  };
}

/// Returns the position of a count on the scale, from 0 for no test to 1 for the maximum. The scale is
/// logarithmic because a few faces get most of the tests.
double share(double tests, double most) {
  return most > 0 ? std::log1p(tests) / std::log1p(most) : 0;
}

/// Draws the wrapper at the end of the last time step, opaque, so that its colours match the scale; and the
/// contact curves.
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
    list.add_polygon(run::corners_of(rep, f, pose_of(view)), t);
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

run::Panel panel_of(const PaperPair& pair, const PanelView& view, double most) {
  const std::string what = view.near ? ", close up"
                                     : ", " + std::string(view.which) + ": " +
                                           render::group_digits(view.collision->comparisons) + " face tests";
  return {wrapper_list(pair, view, most), camera_of(pair, view), pair.name(view.side) + what, false,
          run::kScaleLighting};
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
  std::vector<run::Panel> panels;
  for (const PanelView& view : views) panels.push_back(panel_of(pair, view, most));
  render::Look look;
  look.width = kPanelWidth;
  look.height = kPanelHeight;
  render::MontageOptions options;
  options.columns = 4;
  options.text_height = 28;
  render::Overlay overlay;
  overlay.key = {{render::LegendItem::Mark::line, render::palette::kContact, "contact at the last step"},
                 {render::LegendItem::Mark::dashed, render::palette::kContact, "contact, hidden"}};
  overlay.scale = render::ScaleBar{"face tests per face (log scale)", 0, most};
  return run::with_overlay(run::draw_sheet(panels, look, options), overlay);
}

}  // namespace lrb::paper

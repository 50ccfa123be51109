#include "scenarios/paper/paper_pictures.hpp"

#include <algorithm>
#include <numeric>

#include "render/canvas.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/record/moments.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/render/svg.hpp>
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
  const Eigen::Vector3d direction =
      whole_box(pair.x.rep, last.pose_x).center() - whole_box(pair.a.rep, last.pose_a).center();
  const Eigen::Vector3d from = (view.side == Side::a ? direction : -direction).normalized();
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

pictures::CameraFit camera_of(const PaperPair& pair, const PanelView& view) {
  const LrbRep& rep = pair.rep(view.side);
  render::FitOptions fit;
  fit.view = view_of(pair, view);
  if (!view.near) return pictures::fit_points(render::body_points(rep, pose_of(view)), 3, fit);
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
    t.colour = tests[f] > 0 ? render::palette::heat(share(tests[f], most)) : render::palette::kPaleFront;
    t.edges = 7;
    list.add_polygon(pictures::corners_of(rep, f, pose_of(view)), t, {}, pictures::corners_of(rep, f));
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

pictures::Panel panel_of(const PaperPair& pair, const PanelView& view, double most) {
  const std::string what = view.near ? ", close up"
                                     : ", " + std::string(view.which) + ": " +
                                           render::group_digits(view.collision->comparisons) + " face tests";
  return {wrapper_list(pair, view, most), camera_of(pair, view), pair.name(view.side) + what, false,
          pictures::kScaleLighting};
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
  std::vector<pictures::Panel> panels;
  for (const PanelView& view : views) panels.push_back(panel_of(pair, view, most));
  pictures::Look look;
  look.width = kPanelWidth;
  look.height = kPanelHeight;
  render::MontageOptions options;
  options.columns = 4;
  options.text_height = 28;
  render::Overlay overlay;
  overlay.key = {{render::LegendItem::Mark::line, render::palette::kContact, "contact at the last step"},
                 {render::LegendItem::Mark::dashed, render::palette::kContact, "contact, hidden"}};
  overlay.scale = render::ScaleBar{"face tests per face (log scale)", 0, most};
  return pictures::with_overlay(pictures::draw_sheet(panels, look, options), overlay);
}

namespace {

using namespace render::svg_text;

constexpr double kWidth = 1200, kMargin = 16, kRow = 24, kText = 15, kName = 13.5, kTitle = 18,
                 kGap = 34;                      // pixels
constexpr double kRule = 0.7, kRuleShare = 0.2;  ///< white space between boxes: pixels, and maximum share of
                                                 ///< the box
constexpr double kRoomForText = 2.5;  ///< minimum width of a box with a number, as a multiple of the text
                                      ///< height

enum class State : std::uint8_t { refined, tested, real_tested, untouched };  // in the order of the boxes

render::Rgba colour_of(State s) {
  switch (s) {
    case State::refined:
      return render::palette::kGreen;
    case State::tested:
      return render::palette::kOrange;
    case State::real_tested:
      return render::palette::kSkyBlue;
    case State::untouched:
      break;
  }
  return render::palette::kRule;
}

/// A region, or its real faces of one state.
struct Node {
  State state = State::untouched;
  double width = 0;  ///< number of faces
  std::string name, what;
  std::vector<Node> inside;
};

/// The nodes of one body after one step.
class Tree {
 public:
  Tree(const LrbRep& rep, const Wrapper& wrapper, const std::vector<std::uint32_t>& tests)
      : rep_(rep), wrapper_(wrapper), tests_(tests), inside_(rep.region_count() + std::size_t{1}) {
    for (RegionId r = 0; r < rep.region_count(); ++r) inside_[slot(rep.parent(r))].push_back(r);
  }

  Node root(const std::string& name) const {
    Node n = open(kOutside);
    n.state = State::refined;
    n.name = name + ": outermost wrapper, " + std::to_string(rep_.outermost_faces().size()) + " faces";
    n.what = n.name;
    return n;
  }

 private:
  std::size_t slot(CellId cell) const { return is_region(cell) ? cell.value() : rep_.region_count(); }

  /// Adds the contents of a refined region, or of the outside.
  Node open(CellId cell) const {
    Node n;
    for (const RegionId r : inside_[slot(cell)]) n.inside.push_back(node(r));
    const auto floor = is_region(cell) ? rep_.floor(cell.as_region()) : rep_.outermost_faces();
    for (const State state : {State::real_tested, State::untouched}) {
      const auto count = std::count_if(floor.begin(), floor.end(), [&](FaceId f) {
        return rep_.is_real(f) && (tests_[f] > 0) == (state == State::real_tested);
      });
      if (count == 0) continue;
      Node faces;
      faces.state = state;
      faces.width = static_cast<double>(count);
      faces.what = std::to_string(count) + " real face" + (count == 1 ? "" : "s") +
                   (state == State::real_tested ? ", tested" : ", not tested");
      n.inside.push_back(std::move(faces));
    }
    std::stable_sort(n.inside.begin(), n.inside.end(),
                     [](const Node& p, const Node& q) { return p.state < q.state; });
    for (const Node& child : n.inside) n.width += child.width;
    return n;
  }

  Node node(RegionId r) const {
    const auto lids = rep_.lids(r);
    const auto tests = std::accumulate(lids.begin(), lids.end(), std::uint64_t{0},
                                       [&](std::uint64_t sum, FaceId f) { return sum + tests_[f]; });
    Node n;
    const bool refined = !wrapper_.included(r);
    if (refined) n = open(r);
    if (!refined) n.width = static_cast<double>(lids.size());
    n.state = refined ? State::refined : tests > 0 ? State::tested : State::untouched;
    n.name = std::to_string(r);
    n.what = "region " + n.name + (refined ? ", refined: " : ": ") + std::to_string(rep_.floor(r).size()) +
             " faces exposed, " + std::to_string(tests) + " face tests of its lids";
    if (n.state == State::tested) n.inside.push_back(hidden(r, n.width));
    return n;
  }

  /// Adds everything below an unrefined lid, as one box.
  Node hidden(RegionId r, double width) const {
    std::uint64_t regions = 0, faces = 0;
    std::vector<RegionId> left = {r};
    while (!left.empty()) {
      const RegionId at = left.back();
      left.pop_back();
      for (const FaceId f : rep_.floor(at)) faces += rep_.is_real(f);
      regions += inside_[at].size();
      left.insert(left.end(), inside_[at].begin(), inside_[at].end());
    }
    Node n;
    n.width = width;
    n.what = "not visited, under region " + std::to_string(r) + ": " + std::to_string(regions) +
             " regions, " + std::to_string(faces) + " real faces";
    return n;
  }

  const LrbRep& rep_;
  const Wrapper& wrapper_;
  const std::vector<std::uint32_t>& tests_;
  std::vector<std::vector<RegionId>> inside_;  ///< by parent; the last entry is for the outside
};

int depth_of(const Node& n) {
  int deepest = 0;
  for (const Node& child : n.inside) deepest = std::max(deepest, depth_of(child));
  return 1 + deepest;
}

std::string text(double x, double y, double height, const std::string& words, const char* anchor,
                 render::Rgba colour, bool bold = false) {
  return "<text" + attribute("x", number(x)) + attribute("y", number(y)) + font(height) +
         attribute("text-anchor", anchor) + attribute("dominant-baseline", "central") +
         paint("fill", colour) + (bold ? attribute("font-weight", "bold") : "") + ">" +
         render::escape_markup(words) + "</text>\n";
}

class Writer {
 public:
  /// Returns the height of the drawing.
  double tree(const Node& root, double y) {
    unit_ = (kWidth - 2 * kMargin) / root.width;
    box(root, kMargin, y);
    return depth_of(root) * kRow;
  }
  void heading(const std::string& words, double y) {
    out += text(kMargin, y, kTitle, words, "start", render::palette::kInk, true);
  }
  void legend(double y) {
    double x = kMargin;
    for (const auto& [state, words] : {std::pair{State::refined, "refined"},
                                       {State::tested, "tested, not refined"},
                                       {State::real_tested, "real faces, tested"},
                                       {State::untouched, "untouched"}}) {
      out += rect(x, y - kText / 2, kText, kText, colour_of(state)) + "/>\n";
      out += text(x + 1.5 * kText, y, kText, words, "start", render::palette::kInk);
      x += 1.5 * kText + 0.55 * kText * static_cast<double>(std::string_view(words).size()) + 2 * kText;
    }
    out += text(kWidth - kMargin, y, kText, "widths: faces of the final wrapper", "end",
                render::palette::kFaint);
  }

  std::string out;

 private:
  static std::string rect(double x, double y, double width, double height, render::Rgba colour) {
    return "<rect" + attribute("x", number(x)) + attribute("y", number(y)) +
           attribute("width", number(width)) + attribute("height", number(height)) + paint("fill", colour);
  }

  void box(const Node& n, double x, double y) {
    const double width = n.width * unit_, rule = std::min(kRule, kRuleShare * width);
    out += rect(x, y, width - rule, kRow - kRule, colour_of(n.state)) + "><title>" +
           render::escape_markup(n.what) + "</title></rect>\n";
    if (width > kRoomForText * kText && !n.name.empty())
      out += text(x + width / 2, y + kRow / 2, kName, n.name, "middle", render::palette::kInk);
    for (const Node& child : n.inside) {
      box(child, x, y + kRow);
      x += child.width * unit_;
    }
  }

  double unit_ = 1;
};

}  // namespace

std::size_t busiest_step(const CloseUp& c) {
  const auto most = std::max_element(c.steps.begin(), c.steps.end(), [](const auto& p, const auto& q) {
    return p.counts[0].comparisons < q.counts[0].comparisons;
  });
  return static_cast<std::size_t>(most - c.steps.begin());
}

std::string icicle_svg(const PaperPair& pair, const CloseUp& collision) {
  const std::size_t step = busiest_step(collision);
  const trace::Trace& t = collision.trace;
  trace::Cursor cursor(t, pair.a.rep, pair.x.rep);
  const trace::EventId first = t.steps[step].first_event, last = record::last_event(t, step);
  cursor.seek(last);
  const std::span events(t.events.data() + first, last - first + std::size_t{1});
  Writer writer;
  double y = kMargin + kTitle / 2;
  for (const Side side : {Side::a, Side::b}) {
    const LrbRep& rep = pair.rep(side);
    const std::vector<std::uint32_t> tests = trace::count_faces(rep, side, events).tests;
    const trace::Totals totals = trace::count_events(events);
    const std::string& name = pair.name(side);
    writer.heading(name + ": " + render::group_digits(totals.refinements[static_cast<std::size_t>(side)]) +
                       " of " + render::group_digits(rep.region_count()) + " regions refined, wrapper of " +
                       render::group_digits(cursor.boundary_size(side)) + " faces",
                   y);
    y += kTitle;
    y += writer.tree(Tree(rep, cursor.wrapper(side), tests).root(name), y) + kGap;
  }
  writer.legend(y - kGap / 3);
  const double height = y + kMargin;
  return svg_open(kWidth, height) + "<title>The refinement tree of one collision</title>\n<rect" +
         attribute("width", number(kWidth)) + attribute("height", number(height)) +
         paint("fill", render::kWhite) + "/>\n" + writer.out + "</svg>\n";
}

}  // namespace lrb::paper

#include "scenarios/crowd/crowd_frames.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "render/pictures/panel.hpp"
#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/render/frame_writer.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/world_box.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::crowd {
namespace {

using Mark = render::LegendItem::Mark;

/// With more kinds than this, some share a colour.
constexpr std::uint32_t kColours = 24;

}  // namespace

render::Rgba kind_colour(std::uint32_t kind) {
  // The first ones are distinguishable from the contacts' red and from each other, also with colour vision
  // deficiency.
  constexpr render::Rgba kFirst[] = {{86, 150, 205}, {222, 172, 76},  {92, 172, 140},
                                     {190, 178, 92}, {150, 140, 190}, {150, 150, 150}};
  kind %= kColours;
  return kind < std::size(kFirst) ? kFirst[kind] : render::palette::category(kind);
}

namespace {

class FrameState {
 public:
  FrameState(const spec::Crowd& crowd, const CrowdRun& run, const render::FrameSpec& spec)
      : crowd_(crowd), run_(run), spec_(spec) {}

  /// Returns the picture of a step. `wrappers`: includes the lids of the refined wrappers.
  render::DrawList list(const CrowdMoment& m, bool wrappers) const {
    std::vector<render::SceneBody> bodies;
    std::vector<std::unique_ptr<Wrapper>> states;
    for (std::uint32_t i = 0; i < run_.motion.body_count(); ++i) {
      render::SceneBody body;
      body.rep = &run_.rep(i);
      body.pose = run_.motion.pose(i, m.step);
      body.colour = kind_colour(run_.motion.kind(i));
      body.in_contact = m.in_contact[i];
      if (wrappers) {
        states.push_back(std::make_unique<Wrapper>(*body.rep, crowd_.request.wrapper));
        for (const RegionId r : m.opened[i]) states.back()->refine(r);
        body.wrapper = states.back().get();
      }
      bodies.push_back(std::move(body));
    }
    render::SceneHighlight highlight;
    highlight.contacts = m.contacts;
    render::SceneOptions options;
    options.scale = static_cast<float>(spec_.scale());
    options.style = spec_.style;
    options.real_edges = false;  // with thousands of small faces, only their edges would be visible
    render::Scene scene = render::build_scene(bodies, highlight, options);
    for (render::DrawLine& line : scene.list.lines)
      if (line.colour == style().contact) thin(line);
    add_room(scene.list);
    return std::move(scene.list);
  }

  render::Overlay overlay(const CrowdMoment& m) const {
    const CrowdStep& step = run_.steps[m.step];
    render::Overlay o;
    o.title = crowd_.name + "  ·  step " + std::to_string(m.step);
    o.event = render::counted(count(step, Relation::crossing), "crossing pair of bodies",
                              "crossing pairs of bodies");
    o.style = spec_.style;
    o.event_colour = style().contact;
    const Counters c = sum(step);
    const std::uint64_t n = run_.motion.body_count();
    o.counters = {{"bodies in contact",
                   render::group_digits(bodies_in_contact(step, n)) + " of " + render::group_digits(n)},
                  {"boxes overlap", render::group_digits(step.queries.size()) + " of " +
                                        render::group_digits(n * (n - 1) / 2) + " pairs"},
                  {"face tests", render::group_digits(c.face_tests)},
                  {"refined", render::group_digits(c.refinements)}};
    for (std::uint32_t k = 0; k < crowd_.kinds.size(); ++k)
      o.key.push_back({Mark::solid, kind_colour(k),
                       std::to_string(crowd_.kinds[k].count) + " x " + crowd_.kinds[k].name});
    o.key.push_back({Mark::solid, style().contact, "faces in contact"});
    if (shows_wrappers()) o.key.push_back({Mark::translucent, style().faint, "pseudo faces"});
    return o;
  }

  /// Returns the points that cameras are fitted to: the corners of all boxes at the steps drawn.
  run::Framing framing() const {
    run::Framing f;
    f.dim = run_.rep(0).dim();
    for (const CrowdMoment& m : run_.moments) {
      for (std::uint32_t i = 0; i < run_.motion.body_count(); ++i) {
        const Eigen::AlignedBox3d box = world_box(run_.rep(i), run_.motion.pose(i, m.step));
        for (int corner = 0; corner < 8; ++corner)
          f.points.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
      }
      const auto contacts = render::contact_points(m.contacts);
      f.contacts.insert(f.contacts.end(), contacts.begin(), contacts.end());
    }
    for (const auto& edge : room()) f.points.insert(f.points.end(), edge.begin(), edge.end());
    return f;
  }

 private:
  const render::Style& style() const { return style_of(spec_.style); }
  bool shows_wrappers() const {
    return spec_.views.empty() || std::any_of(spec_.views.begin(), spec_.views.end(),
                                              [](const render::FrameSpec::View& v) { return v.wrapper; });
  }

  /// Makes a contact's curve thin, and hidden by objects in front of it: in a crowd, curves visible through
  /// bodies would hide the bodies.
  void thin(render::DrawLine& line) const {
    line.layer = render::Layer::opaque;
    line.width = static_cast<float>(1.6 * spec_.scale());
    line.halo_width = 0;
  }

  /// Returns the edges of the arena.
  std::vector<std::array<Eigen::Vector3d, 2>> room() const {
    std::vector<std::array<Eigen::Vector3d, 2>> edges;
    if (crowd_.room.isZero()) return edges;
    const Eigen::Vector3d half = crowd_.room / 2;
    const int axes = run_.rep(0).dim();
    for (int axis = 0; axis < axes; ++axis) {
      for (int corner = 0; corner < (axes == 2 ? 2 : 4); ++corner) {
        Eigen::Vector3d p(0, 0, 0);
        p[(axis + 1) % axes] = half[(axis + 1) % axes] * (corner % 2 == 0 ? -1 : 1);
        if (axes == 3) p[(axis + 2) % 3] = half[(axis + 2) % 3] * (corner / 2 == 0 ? -1 : 1);
        Eigen::Vector3d q = p;
        p[axis] = -half[axis];
        q[axis] = half[axis];
        edges.push_back({p, q});
      }
    }
    return edges;
  }

  void add_room(render::DrawList& list) const {
    for (const auto& [p, q] : room()) {
      render::DrawLine line;
      line.points = {p, q};
      line.colour = style().rule;
      line.width = static_cast<float>(1.2 * spec_.scale());
      list.lines.push_back(std::move(line));
    }
  }

  const spec::Crowd& crowd_;
  const CrowdRun& run_;
  const render::FrameSpec& spec_;
};

}  // namespace

std::string crowd_caption(const CrowdRun& run, std::uint32_t step) {
  const CrowdStep& s = run.steps[step];
  const std::size_t crossing = count(s, Relation::crossing), touching = count(s, Relation::touching),
                    inside = count(s, Relation::a_inside_b) + count(s, Relation::b_inside_a);
  std::string out =
      "Step " + std::to_string(step) + ": " +
      render::counted(s.queries.size(), "overlapping pair of boxes", "overlapping pairs of boxes") + ", " +
      render::counted(crossing, "crossing pair of bodies", "crossing pairs of bodies");
  if (touching > 0) out += ", " + render::group_digits(touching) + " touching";
  if (inside > 0) out += ", " + render::group_digits(inside) + " with one body inside the other";
  return out + ".";
}

namespace {

/// Calls `take(i, image, cameras)` with the picture of each moment of a run.
template <class Take>
void each_picture(const spec::Crowd& crowd, const CrowdRun& run, const run::ProgressReport& progress,
                  Take take) {
  render::FrameSpec spec = crowd.frames;
  run::to_pixels(spec);
  const FrameState state(crowd, run, spec);
  std::vector<render::Overlay> overlays;
  for (const CrowdMoment& m : run.moments) overlays.push_back(state.overlay(m));
  run::FrameSequence sequence(spec, std::move(overlays), state.framing());
  for (std::size_t i = 0; i < run.moments.size(); ++i) {
    progress("draw", i, run.moments.size());
    const auto list_of = [&](const render::Look::View& v) { return state.list(run.moments[i], v.wrapper); };
    take(i, sequence.frame(i, list_of), sequence.cameras(i));
  }
}

}  // namespace

std::vector<run::PaintedFrame> paint_crowd(const spec::Crowd& crowd, const CrowdRun& run,
                                           const run::ProgressReport& progress) {
  std::vector<run::PaintedFrame> out;
  if (run.moments.empty()) return out;
  each_picture(crowd, run, progress,
               [&](std::size_t i, render::Image image, std::vector<render::Camera> cameras) {
                 const std::uint32_t step = run.moments[i].step;
                 out.push_back({std::move(image), crowd_caption(run, step), step, std::move(cameras)});
               });
  return out;
}

run::DrawnFrames draw_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                            const std::vector<std::pair<std::string, std::string>>& text,
                            const run::ProgressReport& progress) {
  make_folder(folder + "/frames");
  run::remove_old_frames(folder);
  run::DrawnFrames out;
  if (run.moments.empty()) {
    std::error_code not_empty;  // it then has files of the user
    std::filesystem::remove(folder + "/frames", not_empty);
    return out;
  }
  render::FrameWriter writer;
  each_picture(crowd, run, progress, [&](std::size_t i, render::Image image, const auto&) {
    const std::uint32_t step = run.moments[i].step;
    render::PngOptions png{text, crowd.frames.dpi};
    png.text.emplace_back("lrbscope:step", std::to_string(step));
    writer.push(folder + "/" + run::frame_file(i), std::move(image), png);
    out.frames.push_back({run::frame_file(i), crowd_caption(run, step), step, step});
  });
  writer.finish();
  return out;
}

}  // namespace lrb::crowd

#include "scenarios/crowd/crowd_frames.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "render/page_palette.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/run_charts.hpp"
#include "scenarios/run/scene_json.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/render/frame_writer.hpp>
#include <lrbscope/render/overlay.hpp>
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

namespace {

using nlohmann::json;
using report::packed;
using Numbers = std::vector<std::uint32_t>;

class SceneWriter {
 public:
  SceneWriter(const spec::Crowd& crowd, const CrowdRun& run, const CrowdSceneLimits& limits)
      : crowd_(crowd), run_(run), limits_(limits), bodies_(run.motion.body_count()) {
    choose_frame();
    choose_steps();
  }

  json write(const std::string& pair_command) const {
    const std::string too_large = too_large_text();
    json out = {{"dim", run_.rep(0).dim()},
                {"origin", {frame_.origin.x(), frame_.origin.y(), frame_.origin.z()}},
                {"unit", frame_.unit},
                {"view", view()},
                {"tooLarge", too_large},
                {"thinned", thinned_text()},
                {"colours", run::scene_colours()},
                {"kinds", kinds(too_large.empty())},
                {"room", room()},
                {"command", pair_command},
                {"costs", costs()},
                {"steps", steps()},
                {"queries", queries()}};
    return out;
  }

 private:
  /// The page's unit is the size of the crowd at its first step, rounded to a power of two.
  void choose_frame() {
    Eigen::AlignedBox3d all;
    for (std::uint32_t i = 0; i < bodies_; ++i) all.extend(world_box(run_.rep(i), run_.motion.pose(i, 0)));
    if (!crowd_.room.isZero()) all.extend(Eigen::AlignedBox3d(-crowd_.room / 2, crowd_.room / 2));
    if (all.isEmpty() || !std::isfinite(all.diagonal().norm())) return;
    frame_.origin = all.center();
    if (const double size = all.diagonal().norm(); size > 0)
      frame_.unit = std::exp2(std::floor(std::log2(size)));
  }

  bool moved(std::uint32_t body, std::uint32_t from, std::uint32_t to) const {
    return !trace::equal(run_.motion.pose(body, from), run_.motion.pose(body, to));
  }

  /// Returns the number of poses and of queries that these steps take.
  std::array<std::size_t, 2> size_of(const Numbers& steps) const {
    std::array<std::size_t, 2> size = {0, 0};
    for (std::size_t k = 0; k < steps.size(); ++k) {
      size[1] += run_.steps[steps[k]].queries.size();
      for (std::uint32_t i = 0; i < bodies_; ++i)
        size[0] += static_cast<std::size_t>(k == 0 || moved(i, steps[k - 1], steps[k]));
    }
    return size;
  }

  /// Chooses all steps, or as many evenly spaced ones as the limits allow, at least one.
  void choose_steps() {
    std::size_t count = run_.steps.size();
    while (true) {
      steps_.clear();
      for (const std::size_t i : run::evenly(run_.steps.size(), count))
        steps_.push_back(static_cast<std::uint32_t>(i));
      const auto [poses, queries] = size_of(steps_);
      const double over = std::max(static_cast<double>(poses) / static_cast<double>(limits_.poses),
                                   static_cast<double>(queries) / static_cast<double>(limits_.queries));
      if (over <= 1 || count <= 1) return;
      count =
          std::clamp<std::size_t>(static_cast<std::size_t>(static_cast<double>(count) / over), 1, count - 1);
    }
  }

  std::string too_large_text() const {
    std::size_t faces = 0, drawn = 0;
    for (const bodies::LoadedBody& kind : run_.kinds) faces += kind.rep.real_face_count();
    for (std::uint32_t i = 0; i < bodies_; ++i) drawn += run_.rep(i).real_face_count();
    const auto text = [](std::size_t found, const char* of, std::size_t limit) {
      return "No 3D view: " + std::string(of) + " have " + render::group_digits(found) +
             " faces, and the limit for a page is " + render::group_digits(limit) +
             ". Draw them with lrbscope render.";
    };
    if (faces > limits_.faces) return text(faces, "the kinds of bodies", limits_.faces);
    return drawn > limits_.drawn_faces ? text(drawn, "the bodies", limits_.drawn_faces) : std::string();
  }

  std::string thinned_text() const {
    if (steps_.size() == run_.steps.size()) return {};
    return "Of the run's " + render::group_digits(run_.steps.size()) + " steps, this page contains " +
           render::group_digits(steps_.size()) +
           ", evenly spaced, up to a size limit. trace.json and summary.json contain all of them.";
  }

  json view() const {
    const std::vector<render::FrameSpec::View>& views = crowd_.frames.views;
    if (views.empty() || views[0].camera == render::FrameSpec::Camera::fixed) return nullptr;
    const auto vector = [](const Eigen::Vector3d& v) { return json({v.x(), v.y(), v.z()}); };
    return {{"from", vector(views[0].from)},
            {"up", vector(views[0].up)},
            {"orthographic", views[0].orthographic}};
  }

  json kinds(bool with_geometry) const {
    json out = json::array();
    for (std::uint32_t k = 0; k < run_.kinds.size(); ++k) {
      const LrbRep& rep = run_.kinds[k].rep;
      json kind = {{"name", crowd_.kinds[k].name},
                   {"count", crowd_.kinds[k].count},
                   {"colour", render::css(kind_colour(k))},
                   {"open", !rep.closed()},
                   {"realFaces", rep.real_face_count()}};
      if (with_geometry) kind["body"] = run::real_body_json(rep, frame_);
      out.push_back(std::move(kind));
    }
    return out;
  }

  /// Returns the half sizes of the arena, in the page's unit, and its centre; null: there is none.
  json room() const {
    if (crowd_.room.isZero()) return nullptr;
    std::vector<float> out;
    frame_.add_point(out, Eigen::Vector3d::Zero());
    frame_.add_vector(out, crowd_.room / 2);
    return packed(out);
  }

  /// Returns the work of every step of the run.
  json costs() const {
    Numbers boxes, planes, faces;
    for (const CrowdStep& s : run_.steps) {
      const Counters c = sum(s);
      boxes.push_back(static_cast<std::uint32_t>(c.box_tests));
      planes.push_back(static_cast<std::uint32_t>(c.prefilter_tests));
      faces.push_back(static_cast<std::uint32_t>(c.face_tests));
    }
    return {{"boxes", packed(boxes)}, {"planes", packed(planes)}, {"faces", packed(faces)}};
  }

  /// Returns the steps on the page, and for each the bodies that have moved since the one before, with their
  /// poses.
  json steps() const {
    Numbers ends, moved_bodies;
    std::vector<float> poses;
    std::vector<Eigen::Vector3d> centres;
    for (const bodies::LoadedBody& kind : run_.kinds) centres.push_back(run::body_centre(kind.rep));
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      for (std::uint32_t i = 0; i < bodies_; ++i) {
        if (k > 0 && !moved(i, steps_[k - 1], steps_[k])) continue;
        moved_bodies.push_back(i);
        run::add_pose(poses, run_.motion.pose(i, steps_[k]), centres[run_.motion.kind(i)], frame_);
      }
      ends.push_back(static_cast<std::uint32_t>(moved_bodies.size()));
    }
    return {{"index", packed(steps_)}, {"ends", packed(ends)},     {"moved", packed(moved_bodies)},
            {"poses", packed(poses)},  {"all", run_.steps.size()}, {"contacts", run_.contact_steps}};
  }

  /// Returns the queries of these steps, as columns. Intervals are texts, because rounded bounds may exclude
  /// the value.
  json queries() const {
    Numbers ends, a, b, relation, kept, pairs, boxes, planes, faces, contact_ends, contact_faces;
    json distance = json::array(), depth = json::array(), kind = json::array(), near = json::array();
    for (const std::uint32_t s : steps_) {
      for (const CrowdQuery& q : run_.steps[s].queries) {
        const trace::StepResult& r = q.result;
        a.push_back(q.bodies.i);
        b.push_back(q.bodies.j);
        relation.push_back(static_cast<std::uint32_t>(r.relation));
        kept.push_back(q.is_kept ? 1 : 0);
        pairs.push_back(static_cast<std::uint32_t>(r.pair_count));
        boxes.push_back(static_cast<std::uint32_t>(r.counters.box_tests));
        planes.push_back(static_cast<std::uint32_t>(r.counters.prefilter_tests));
        faces.push_back(static_cast<std::uint32_t>(r.counters.face_tests));
        for (const std::vector<std::uint32_t>& of : q.contact_faces) {
          contact_faces.insert(contact_faces.end(), of.begin(), of.end());
          contact_ends.push_back(static_cast<std::uint32_t>(contact_faces.size()));
        }
        if (r.distance) distance.push_back(run::interval_text(r.distance->lower, r.distance->upper));
        if (r.clash) {
          kind.push_back(run::kind_text(r.clash->kind, r.clash->reason));
          depth.push_back(r.clash->depth ? run::interval_text((*r.clash->depth)[0], (*r.clash->depth)[1])
                                         : "");
        }
        if (r.near) near.push_back(r.near->pairs);
      }
      ends.push_back(static_cast<std::uint32_t>(a.size()));
    }
    json words = json::array();
    for (const auto& entry : kEnumNames<Relation>) words.push_back(io::in_words(entry.name));
    json measures = json::object();
    if (crowd_.more.distance) measures["distance"] = std::move(distance);
    if (crowd_.more.clash) measures["contact kind"] = std::move(kind), measures["depth"] = std::move(depth);
    if (crowd_.more.near) measures["near pairs"] = std::move(near);
    return {{"ends", packed(ends)},
            {"a", packed(a)},
            {"b", packed(b)},
            {"relation", packed(relation)},
            {"relations", std::move(words)},
            {"kept", packed(kept)},
            {"pairs", packed(pairs)},
            {"boxes", packed(boxes)},
            {"planes", packed(planes)},
            {"faces", packed(faces)},
            {"contactEnds", packed(contact_ends)},
            {"contactFaces", packed(contact_faces)},
            {"measures", std::move(measures)}};
  }

  const spec::Crowd& crowd_;
  const CrowdRun& run_;
  const CrowdSceneLimits& limits_;
  std::uint32_t bodies_;
  run::SceneFrame frame_;
  Numbers steps_;  ///< on the page
};

}  // namespace

std::string crowd_scene_json(const spec::Crowd& crowd, const CrowdRun& run, const std::string& pair_command,
                             const CrowdSceneLimits& limits) {
  return SceneWriter(crowd, run, limits)
      .write(pair_command)
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace lrb::crowd

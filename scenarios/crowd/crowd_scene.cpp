#include "scenarios/crowd/crowd_scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "render/page_palette.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/crowd/crowd_frames.hpp"
#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/run_charts.hpp"
#include "scenarios/run/scene_json.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/world_box.hpp>

namespace lrb::crowd {
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

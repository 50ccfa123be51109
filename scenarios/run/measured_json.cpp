#include <algorithm>
#include <span>

#include <nlohmann/json.hpp>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/scene_json.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {
namespace {

std::optional<pictures::MarkedSegment> separation_vector_in(const frames::RecordedRun& p, std::size_t step) {
  const trace::Step& s = p.trace->steps[step];
  if (!s.result.clash) return std::nullopt;
  std::span<const ContactRegion> contacts;
  if (p.results != nullptr && step < p.results->size()) contacts = (*p.results)[step].regions;
  return frames::separation_vector_of(*s.result.clash, {*p.reps[0], s.pose_a, *p.reps[1], s.pose_b},
                                      contacts);
}

}  // namespace

nlohmann::json measured_json(const frames::RecordedRun& p, const SceneFrame& frame) {
  // The order of MEASURED in scene_marks.js.
  enum Kind : std::uint32_t { gap, separation_vector, near_pair, contact, point, point_inside };
  constexpr std::size_t kMaxOfStep = 100;  // near pairs, contacts, and points
  std::vector<std::uint32_t> steps, kinds;
  std::vector<float> ends;
  nlohmann::json words = nlohmann::json::array();
  const auto add = [&](const trace::Step& s, Kind kind, const Eigen::Vector3d& from,
                       const Eigen::Vector3d& to, const std::string& text) {
    steps.push_back(s.index);
    kinds.push_back(kind);
    frame.add_point(ends, from);
    frame.add_point(ends, to);
    words.push_back(text);
  };
  for (std::size_t i = 0; i < p.trace->steps.size(); ++i) {
    const trace::Step& s = p.trace->steps[i];
    if (!s.finished) continue;
    if (const auto segment = s.result.distance ? frames::gap_of(*s.result.distance) : std::nullopt)
      add(s, gap, segment->from, segment->to, "distance " + segment->text);
    if (const auto segment = separation_vector_in(p, i))
      add(s, separation_vector, segment->from, segment->to, "depth " + segment->text);
    if (s.result.near) {
      const std::vector<pictures::NearMark> marks = frames::near_marks(*s.result.near);
      for (std::size_t k = 0; k < std::min(kMaxOfStep, marks.size()); ++k)
        add(s, near_pair, marks[k].points[0], marks[k].points[1],
            k == 0 ? frames::text_of(*s.result.near) : "");
    }
    if (s.result.manifold) {
      const std::vector<pictures::ContactMark> marks = frames::contact_marks(*s.result.manifold);
      const std::vector<double> lengths =
          pictures::normal_lengths(marks, pictures::size_of({*p.reps[0], s.pose_a, *p.reps[1], s.pose_b}));
      for (std::size_t k = 0; k < std::min(kMaxOfStep, marks.size()); ++k)
        add(s, contact, marks[k].point, marks[k].point + lengths[k] * marks[k].normal,
            k == 0 ? frames::text_of(*s.result.manifold) : "");
    }
    if (s.result.points) {
      const std::vector<pictures::PointMark> marks = frames::point_marks(*s.result.points);
      for (std::size_t k = 0; k < std::min(kMaxOfStep, marks.size()); ++k)
        add(s, marks[k].side == Where::inside ? point_inside : point, marks[k].point, marks[k].closest,
            k == 0 ? frames::text_of(*s.result.points) : "");
    }
  }
  if (steps.empty()) return nullptr;
  return {{"step", report::packed(steps)},
          {"kind", report::packed(kinds)},
          {"ends", report::packed(ends)},
          {"words", std::move(words)}};
}

}  // namespace lrb::run

#pragma once
/// The state of a recorded run after any of its events, as a picture and as text.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/pictures/marks.hpp"
#include "scenarios/frames/frames.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::frames {

/// Returns CollideResult::error_bound as a short text.
std::string error_bound_text(double bound);

/// Returns the results of a pass: "pass 3: 47 regions, 1 064 to 340 faces, 12 caps rejected: 9 too many
/// faces, 3 too thick".
std::string pass_text(const trace::PassSummary& pass);

/// Returns the stage of a pass: "fitting, max. deviation 0.002".
std::string stage_text(const trace::PassSummary& pass);

/// Returns the text of a construction event.
std::string built_text(const trace::Event& e);

class FrameState {
 public:
  /// The data that `run` points to, and `spec`, must outlive this object.
  FrameState(RecordedRun run, const pictures::FrameSpec& spec, bool point_out_refined);

  FrameState(FrameState&&) = default;

  /// Moves to just after `event`. Call it before all other members.
  void seek(trace::EventId event);

  /// Returns the picture. `wrapper` false: only the bodies. `plain`: shows a state, not an event, so that
  /// only contacts are highlighted.
  render::Scene scene(bool wrapper = true, bool plain = false) const;
  /// Returns the text of a frame, without colour key and scale.
  render::Overlay overlay(const std::string& title) const;
  /// Returns the same as one sentence, for the page.
  std::string caption() const;
  /// Returns a shorter text for a panel of a montage.
  std::string short_caption() const;
  /// Returns true if the displayed answer has contact regions.
  bool in_contact() const { return !contacts().empty(); }
  /// Returns these contact regions.
  std::span<const ContactRegion> contacts() const {
    if (now_.result == nullptr) return {};
    return now_.result->regions;
  }
  std::uint32_t step() const { return cursor_.step()->index; }
  Pose pose(Side side) const { return cursor_.pose(side); }
  const std::vector<const LrbRep*>& reps() const { return run_.reps; }

 private:
  /// Data valid after the current event, in addition to the cursor's own state.
  struct Moment {
    bool is_step_end = false;  ///< the event is the step's last
    /// The step's answer with its contact regions; null before the step's end, or if no results were given.
    const CollideResult* result = nullptr;
    /// The step's answer in the trace; null before the step's end, or if the step is not finished.
    const trace::StepResult* answer = nullptr;
    /// The answer's certificate of separation, whose wrappers are then shown; null without one.
    const Separation* proof = nullptr;
    /// The separating plane of a step that ends here without contact; nullopt for other events, and if face
    /// colours by value take precedence.
    std::optional<WalkExplanation> separating;
    /// The segment between the closest points, and the separating translation of B, of a step that ends here;
    /// nullopt if they were not requested.
    std::optional<pictures::MarkedSegment> gap, separation_vector;
    /// The wrong pairs of another engine in the step; empty before the step's end.
    std::span<const pictures::WrongPair> wrong;
    /// The pass of a construction that the event belongs to; null before the first, and for other runs.
    const trace::PassSummary* pass = nullptr;
    bool is_pass_end = false;     ///< the end of a pass that made regions
    std::vector<RegionId> built;  ///< the regions of this pass so far
  };
  /// Data that a scene refers to until it is built.
  struct SceneParts {
    std::array<std::vector<double>, 2> values;
    std::array<std::vector<std::uint8_t>, 2> in_contact;
    std::vector<Wrapper> proving;
    std::vector<render::SceneBody> bodies;
  };

  Moment moment() const;
  void add_answer(Moment& m) const;
  void add_pass(Moment& m) const;
  bool shows_separating_plane(const Moment& m) const;

  bool is_single() const { return run_.reps.size() == 1; }
  const LrbRep& rep(Side side) const { return *run_.reps[static_cast<std::size_t>(side)]; }
  pictures::PosedBodies bodies() const { return {rep(Side::a), pose(Side::a), rep(Side::b), pose(Side::b)}; }

  // Pictures.
  SceneParts scene_parts(bool wrapper) const;
  render::SceneHighlight scene_highlight(bool wrapper, bool plain) const;
  render::SceneOptions scene_options(const SceneParts& parts) const;
  void add_marks(render::Scene& scene, bool plain) const;
  /// (|F|) Marks the intersecting faces of a coarse answer so far; empty if the answer has contact regions
  /// instead.
  std::vector<std::uint8_t> met(Side side) const;
  const trace::TreeShape* tree_of(Side side) const;     ///< Returns null if there is none.
  std::span<const trace::Event> events_so_far() const;  ///< Returns the events of the step so far.
  std::vector<double> values_of(Side side) const;
  /// Returns true unless other regions are isolated.
  bool is_shown(const trace::RefinedRegion& r) const;

  // Texts (frame_state_text.cpp).
  std::string event_text() const;
  std::string construction_text() const;
  static std::string node_pair_text(const trace::Event& e);
  /// Returns the measurements at the step's end, to be appended to other text; empty if none were requested.
  std::string measured_text() const;
  /// Describes the isolated regions; empty if there are none.
  std::string isolated_text() const;
  /// Names the wrappers at the beginning of a step.
  std::string first_wrappers_text() const;
  /// Explains why a relation is undefined.
  std::string open_text() const;
  std::string result_text() const;
  /// Returns the relation of the bodies, and how it was decided.
  std::string relation_text() const;
  std::string construction_caption() const;
  void add_construction(render::Overlay& o) const;
  void add_counters(render::Overlay& o) const;
  void add_pair_counters(render::Overlay& o) const;
  /// Returns the number of faces of the displayed wrapper.
  std::uint32_t boundary_size(Side side) const;
  trace::Totals totals() const;  ///< Counts the events of the step so far.

  RecordedRun run_;
  const trace::Trace& trace_;
  const pictures::FrameSpec& spec_;
  bool point_out_refined_;  ///< frames follow refinements, so that the last one is the new part
  trace::Cursor cursor_;
  std::vector<trace::PassSummary> passes_;  ///< of a construction
  Moment now_;
};

// The marks of a trace's measurements at a step.

inline Eigen::Vector3d vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

inline std::optional<pictures::MarkedSegment> gap_of(const trace::MeasuredDistance& distance) {
  return pictures::gap_of({distance.lower, distance.upper}, vector_of(distance.points[0]),
                          vector_of(distance.points[1]));
}

inline std::optional<pictures::MarkedSegment> separation_vector_of(const trace::MeasuredClash& clash,
                                                                   const pictures::PosedBodies& bodies,
                                                                   std::span<const ContactRegion> contacts) {
  std::optional<ProvedInterval> depth;
  if (clash.depth) depth = {(*clash.depth)[0], (*clash.depth)[1]};
  return pictures::separation_vector_of(depth, vector_of(clash.translation), bodies, contacts);
}

inline std::vector<pictures::NearMark> near_marks(const trace::MeasuredNearPairs& near) {
  std::vector<pictures::NearMark> out;
  for (const trace::MeasuredNearPairs::Pair& p : near.nearest)
    out.push_back({{vector_of(p.points[0]), vector_of(p.points[1])}, p.upper == 0});
  return out;
}

inline std::vector<pictures::ContactMark> contact_marks(const trace::MeasuredManifolds& manifolds) {
  std::vector<pictures::ContactMark> out;
  for (const trace::MeasuredManifolds::Point& p : manifolds.contacts)
    out.push_back({vector_of(p.points[1]), vector_of(p.normal), p.depth});
  return out;
}

inline std::vector<pictures::PointMark> point_marks(const trace::MeasuredPoints& points) {
  std::vector<pictures::PointMark> out;
  for (const trace::MeasuredPoints::Point& p : points.smallest) {
    const Where where = p.upper < 0 ? Where::inside : p.upper > 0 ? Where::outside : Where::on_surface;
    const bool has_side = points.has_sides || where == Where::on_surface;
    out.push_back(
        {vector_of(p.points[0]), vector_of(p.points[1]), has_side ? std::optional(where) : std::nullopt});
  }
  return out;
}

/// Return "12 pairs of faces within 0.05" and "2 contact manifolds with 8 points", "3 of 12 points inside,
/// smallest distance -0.25".
std::string text_of(const trace::MeasuredNearPairs& near);
std::string text_of(const trace::MeasuredManifolds& manifolds);
std::string text_of(const trace::MeasuredPoints& points);

}  // namespace lrb::frames

#pragma once
/// The state of a recorded run after any of its events, as a picture shows it and in words.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/pictures/marks.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::run {

/// Returns CollideResult::error_bound in a word or two.
std::string error_bound_text(double bound);

/// What not every run has: see RecordedRun.
struct FrameExtras {
  const std::vector<trace::TreeShape>* trees = nullptr;
  const std::vector<std::vector<WrongPair>>* wrong = nullptr;
  std::optional<std::array<double, 2>> value_range = {};
  const std::array<std::vector<double>, 2>* face_values = nullptr;
  std::string value_name = {};
};

class FrameState {
 public:
  /// `results`: one for each step, for contact regions; may be empty. All arguments must outlive this object.
  FrameState(const trace::Trace& trace, std::vector<const LrbRep*> reps,
             const std::vector<CollideResult>& results, const render::FrameSpec& spec, bool point_out_refined,
             const FrameExtras& extras = {});

  FrameState(FrameState&&) = default;

  /// Moves to just after `event`. To be called before anything else.
  void seek(trace::EventId event);

  /// Returns the picture. `wrapper` false: the bodies alone. `plain`: shows a state, not an event, so that
  /// nothing is pointed out but contacts.
  render::Scene scene(bool wrapper = true, bool plain = false) const;
  /// Returns the text of a frame, without colour key and scale.
  render::Overlay overlay(const std::string& title) const;
  /// Returns the same in one sentence, for the page.
  std::string caption() const;
  /// Returns the same in a few words, for a panel of a montage.
  std::string short_caption() const;
  /// Returns true if the answer that is shown has contact regions.
  bool in_contact() const { return now_.result != nullptr && !now_.result->regions.empty(); }
  std::uint32_t step() const { return cursor_.step()->index; }
  Pose pose(Side side) const { return cursor_.pose(side); }
  const std::vector<const LrbRep*>& reps() const { return reps_; }

 private:
  /// What is known after the event that was sought, besides the cursor's own state.
  struct Moment {
    bool is_step_end = false;  ///< the step's last event has come
    /// The step's answer with its contact regions; null before the step's end, or if none was handed over.
    const CollideResult* result = nullptr;
    /// The step's answer as the trace has it; null before the step's end, or if the step is not finished.
    const trace::StepResult* answer = nullptr;
    /// The answer's certificate of separation, whose wrappers are then shown; null if it has none.
    const Separation* proof = nullptr;
    /// What separates the bodies of a step that ends here without contact; nullopt for other events, and if
    /// it is not to be shown because colours of faces by numbers need the picture for themselves.
    std::optional<WalkExplanation> parting;
    /// The segment between the closest points, and the separating translation of B, of a step that ends here;
    /// nullopt if they were not requested.
    std::optional<MarkedWay> gap, way_out;
    /// The pairs that another engine got wrong in the step; empty before the step's end.
    std::span<const WrongPair> wrong;
    /// The pass of a construction that the event belongs to; null before the first, and for other runs.
    const trace::PassSummary* pass = nullptr;
    bool is_pass_end = false;     ///< the end of a pass that made regions
    std::vector<RegionId> built;  ///< the regions of this pass so far
  };
  /// What a scene refers to until it is built.
  struct SceneParts {
    std::array<std::vector<double>, 2> values;
    std::array<std::vector<std::uint8_t>, 2> in_contact;
    std::vector<Wrapper> proving;
    std::vector<render::SceneBody> bodies;
  };

  Moment moment() const;
  void add_answer(Moment& m) const;
  void add_pass(Moment& m) const;
  bool shows_parting(const Moment& m) const;

  bool is_single() const { return reps_.size() == 1; }
  const LrbRep& rep(Side side) const { return *reps_[static_cast<std::size_t>(side)]; }

  // Pictures.
  SceneParts scene_parts(bool wrapper) const;
  render::SceneHighlight scene_highlight(bool wrapper, bool plain) const;
  render::SceneOptions scene_options(const SceneParts& parts) const;
  void add_marks(render::Scene& scene, bool plain) const;
  /// (|F|) Marks the faces of a coarse answer so far; empty if the answer is one for contact regions.
  std::vector<std::uint8_t> met(Side side) const;
  const trace::TreeShape* tree_of(Side side) const;     ///< Returns null if there is none.
  std::span<const trace::Event> events_so_far() const;  ///< Returns those of the step.
  std::vector<double> values_of(Side side) const;
  /// Returns true unless other regions are isolated.
  bool is_shown(const trace::RefinedRegion& r) const;

  // Texts (frame_state_text.cpp).
  std::string event_text() const;
  std::string construction_text() const;
  static std::string node_pair_text(const trace::Event& e);
  /// Returns what was measured at the step's end, to follow other words; empty if nothing was requested.
  std::string measured_text() const;
  /// Describes the isolated regions; empty if there are none.
  std::string isolated_text() const;
  /// Names the wrappers that a step begins with.
  std::string first_wrappers_text() const;
  /// Explains why a relation is undefined.
  std::string open_text() const;
  std::string result_text() const;
  /// Returns the relation of the bodies, and how it is known.
  std::string relation_text() const;
  std::string construction_caption() const;
  void add_construction(render::Overlay& o) const;
  void add_counters(render::Overlay& o) const;
  void add_pair_counters(render::Overlay& o) const;
  /// Returns the number of faces of the wrapper that is shown.
  std::uint32_t boundary_size(Side side) const;
  trace::Totals totals() const;  ///< Counts the events of the step so far.

  const trace::Trace& trace_;
  std::vector<const LrbRep*> reps_;
  const std::vector<CollideResult>& results_;
  const render::FrameSpec& spec_;
  FrameExtras extras_;
  bool point_out_refined_;  ///< frames follow refinements, so that the last one is what is new
  trace::Cursor cursor_;
  std::vector<trace::PassSummary> passes_;  ///< of a construction
  Moment now_;
};

// The marks of what a trace has measured at a step.

inline Eigen::Vector3d vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

inline std::optional<MarkedWay> gap_of(const trace::MeasuredDistance& distance) {
  return gap_of({distance.lower, distance.upper}, vector_of(distance.points[0]),
                vector_of(distance.points[1]));
}

inline std::optional<MarkedWay> way_out_of(const trace::MeasuredClash& clash, const LrbRep& a,
                                           const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                           std::span<const ContactRegion> contacts) {
  std::optional<ProvedInterval> depth;
  if (clash.depth) depth = {(*clash.depth)[0], (*clash.depth)[1]};
  return way_out_of(depth, vector_of(clash.translation), a, pose_a, b, pose_b, contacts);
}

}  // namespace lrb::run

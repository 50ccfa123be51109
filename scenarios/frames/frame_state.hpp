#pragma once
/// The state of a recorded run after any of its events, as a picture shows it and in words.

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

namespace lrb::run {

/// Returns CollideResult::error_bound in a word or two.
std::string error_bound_text(double bound);

/// Returns what a pass made: "pass 3: 47 regions, 1 064 to 340 faces, 12 caps refused: 9 met the hull, 3 too
/// thick".
std::string pass_words(const trace::PassSummary& pass);

/// Returns what a pass was about: "fitting, caps at most 0.002 off the body".
std::string stage_words(const trace::PassSummary& pass);

/// Returns what an event of a construction says.
std::string built_words(const trace::Event& e);

class FrameState {
 public:
  /// The data that `run` points to, and `spec`, must outlive this object.
  FrameState(RecordedRun run, const render::FrameSpec& spec, bool point_out_refined);

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
  const std::vector<const LrbRep*>& reps() const { return run_.reps; }

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
    std::optional<WalkExplanation> separating;
    /// The segment between the closest points, and the separating translation of B, of a step that ends here;
    /// nullopt if they were not requested.
    std::optional<MarkedSegment> gap, separation_vector;
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
  bool shows_separating_plane(const Moment& m) const;

  bool is_single() const { return run_.reps.size() == 1; }
  const LrbRep& rep(Side side) const { return *run_.reps[static_cast<std::size_t>(side)]; }
  PosedBodies bodies() const { return {rep(Side::a), pose(Side::a), rep(Side::b), pose(Side::b)}; }

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

  RecordedRun run_;
  const trace::Trace& trace_;
  const render::FrameSpec& spec_;
  bool point_out_refined_;  ///< frames follow refinements, so that the last one is what is new
  trace::Cursor cursor_;
  std::vector<trace::PassSummary> passes_;  ///< of a construction
  Moment now_;
};

// The marks of what a trace has measured at a step.

inline Eigen::Vector3d vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

inline std::optional<MarkedSegment> gap_of(const trace::MeasuredDistance& distance) {
  return gap_of({distance.lower, distance.upper}, vector_of(distance.points[0]),
                vector_of(distance.points[1]));
}

inline std::optional<MarkedSegment> separation_vector_of(const trace::MeasuredClash& clash,
                                                         const PosedBodies& bodies,
                                                         std::span<const ContactRegion> contacts) {
  std::optional<ProvedInterval> depth;
  if (clash.depth) depth = {(*clash.depth)[0], (*clash.depth)[1]};
  return separation_vector_of(depth, vector_of(clash.translation), bodies, contacts);
}

}  // namespace lrb::run

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
  bool in_contact() const { return result_here() != nullptr && !result_here()->regions.empty(); }
  std::uint32_t step() const { return cursor_.step()->index; }
  Pose pose(Side side) const { return cursor_.pose(side); }
  const std::vector<const LrbRep*>& reps() const { return reps_; }

 private:
  bool at_step_end() const;
  const CollideResult* result_here() const;      ///< Returns the step's answer, once its last event has come;
                                                 ///< null before.
  const trace::StepResult* answer_here() const;  ///< Returns the same, as the trace has it.
  const Separation* proof_here() const;  ///< Returns the answer's certificate of separation, whose wrappers
                                         ///< are then shown.
  /// Returns the walk of a step that ends here without contact; null: of another, or where what parts the
  /// bodies is not to be shown: numbers of faces need the picture for themselves.
  const WalkExplanation* parting_here() const;
  /// Return the way between the nearest points, or B's way out, of a step that ends here; nothing if nobody
  /// asked.
  std::optional<MarkedWay> gap_here() const;
  std::optional<MarkedWay> way_out_here() const;
  /// Returns what was measured at the step's end, in words, to follow others; empty if nobody asked.
  std::string measured_text() const;
  /// Returns the pairs that another engine got wrong in the step, once its last event has come.
  std::span<const WrongPair> wrong_here() const;
  std::uint32_t boundary_size(Side side) const;  ///< Returns the number of faces of the wrapper that is
                                                 ///< shown.
  /// (|F|) Marks the faces of a coarse answer so far; empty if the answer is one for contact regions.
  std::vector<std::uint8_t> met(Side side) const;
  const trace::TreeShape* tree_of(Side side) const;     ///< Returns null where there is none.
  std::span<const trace::Event> events_so_far() const;  ///< Returns those of the step.
  std::vector<double> values_of(Side side) const;
  std::string event_text() const;
  /// Returns the pass of a construction that the event belongs to; null before the first, and for other runs.
  const trace::PassSummary* pass_here() const;
  /// Returns true at the end of a pass that made regions.
  bool at_pass_end() const;
  std::vector<RegionId> built_here() const;  ///< Returns the regions of this pass so far.
  void add_construction(render::Overlay& o) const;
  std::string construction_caption() const;
  static std::string node_pair_text(const trace::Event& e);
  /// Returns true unless other regions are isolated.
  bool is_shown(const trace::RefinedRegion& r) const;
  /// Says what the isolated regions are; empty if there are none.
  std::string isolated_text() const;
  /// Says which wrappers a step begins with.
  std::string first_wrappers_text() const;
  /// Says why a relation is undefined.
  std::string open_text() const;
  std::string result_text() const;
  /// Says how the bodies lie, and how that is known.
  std::string relation_text() const;
  trace::Totals totals() const;  ///< Counts the events of the step so far.

  const trace::Trace& trace_;
  std::vector<const LrbRep*> reps_;
  const std::vector<CollideResult>& results_;
  const render::FrameSpec& spec_;
  FrameExtras extras_;
  bool point_out_refined_;  ///< frames follow refinements, so that the last one is what is new
  trace::Cursor cursor_;
  struct Parting {
    std::size_t step;
    WalkExplanation walk;
  };
  mutable std::optional<Parting> parting_;  ///< of the step that was asked for last
  std::vector<trace::PassSummary> passes_;  ///< of a construction
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

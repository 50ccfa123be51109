#pragma once
/// A recorded run on stage: what is to be seen, and what is to be said, after any of its events.

#include <optional>
#include <string>
#include <vector>

#include "engine/query/collide.hpp"
#include "render/scene.hpp"
#include "scenarios/spec/scenario.hpp"
#include "trace/counters.hpp"
#include "trace/cursor.hpp"

namespace lrb::run {

/// CollideResult::error_bound in a word or two.
std::string error_bound_text(double bound);

class FrameState {
 public:
  /// `results`: one a step, for contact regions; may be empty. All must outlive the stage.
  FrameState(const trace::Trace& trace, std::vector<const LrbRep*> reps,
             const std::vector<CollideResult>& results, const spec::FrameSpec& spec, bool point_out_refined);

  void seek(trace::EventId event);

  /// `wrapper` false: the bodies alone. `plain`: a state, not an event: nothing is pointed out but contacts.
  render::Scene scene(bool wrapper = true, bool plain = false) const;
  /// The text of a frame; no key or scale.
  render::Overlay overlay(const std::string& title) const;
  /// The same in one sentence, for the page.
  std::string caption() const;
  /// In a few words, for a panel of a montage.
  std::string short_caption() const;
  std::uint32_t step() const { return cursor_.step()->index; }
  Pose pose(Side side) const { return cursor_.pose(side); }
  const std::vector<const LrbRep*>& reps() const { return reps_; }

 private:
  bool at_step_end() const;
  const CollideResult* result_here() const;      ///< the step's answer, once its last event has come
  const trace::StepResult* answer_here() const;  ///< the same as the trace has it
  const Separation* proof_here() const;          ///< its certificate, whose wrappers are then on show
  std::uint32_t boundary_size(Side side) const;  ///< of the wrapper on show
  /// (|F|) faces of a coarse answer so far; empty: the answer is one for contact regions.
  std::vector<std::uint8_t> met(Side side) const;
  std::vector<double> values_of(Side side) const;
  std::string event_text() const;
  std::string result_text() const;
  trace::Totals totals() const;  ///< of the step so far

  const trace::Trace& trace_;
  std::vector<const LrbRep*> reps_;
  const std::vector<CollideResult>& results_;
  const spec::FrameSpec& spec_;
  bool point_out_refined_;  ///< frames follow refinements, so that the last one is news
  trace::Cursor cursor_;
};

}  // namespace lrb::run

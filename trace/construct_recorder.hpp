#pragma once
/// Writes down what a builder does, as events of a trace.
///
/// ```
/// ConstructRecorder recorder(settings);
/// options.probe = &recorder;
/// LrbRep rep = build_lrb(mesh, options);
/// Trace trace = recorder.take(rep, pose);
/// ```

#include <cstdint>

#include "engine/construct/construct_probe.hpp"
#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "trace/recorder.hpp"

namespace lrb::trace {

class ConstructRecorder final : public ConstructProbe {
 public:
  explicit ConstructRecorder(RecorderSettings settings);

  void pass(const PassStart& start) override;
  void patch(const GrownPatch& patch) override;
  void cap(const TriedCap& cap) override;
  void region(RegionId region) override;
  void merged(RegionId into, std::uint32_t pieces) override;
  void end_pass(const PassEnd& end) override;
  void closed(std::uint32_t faces) override;

  /// Returns true if no builder has told anything.
  bool empty() const { return seen_ == 1; }

  /// Replays what was recorded on the body that was built, which counts the faces of the hull, and hands the
  /// trace over: one time step, at whose beginning the wrapper is the body itself. The recorder is then
  /// empty.
  Trace take(const LrbRep& rep, const Pose& pose);

 private:
  EventId push(const Event& event);

  RecorderSettings settings_;
  Trace trace_;
  WallClock clock_;
  std::uint64_t seen_ = 0;
  EventId pass_ = kNull, patch_ = kNull, cap_ = kNull;
};

/// Returns the trace of a body that came with its regions: what would have been told of passes that made
/// them.
Trace known_construction(const LrbRep& rep, const Pose& pose, const RecorderSettings& settings);

}  // namespace lrb::trace

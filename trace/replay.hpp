#pragma once
/// What events do to the wrappers. The recorder and the cursor both go through here, so that a replay is the
/// recording's twin.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/lrb/wrapper.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

/// The wrappers of one or two bodies and how many faces each has.
class Replay {
 public:
  Replay(std::span<const LrbRep* const> reps, WrapperMode mode);

  /// All wrappers are the outermost ones again.
  void reset();
  /// Step: reset(). Refine, coarsen: does so to the event's wrapper. Other kinds: nothing. True for refine
  /// and coarsen. `events` are all of the trace, for causes; indices must be in range (check_trace).
  ///
  /// In unregularised mode a wrapper is refined face by face: a refinement takes away the face that its
  /// cause, a face test, compared. Without such a cause the whole region is refined.
  bool apply(const Event& event, std::span<const Event> events);

  std::size_t body_count() const { return wrappers_.size(); }
  const Wrapper& wrapper(Side side) const { return wrappers_[static_cast<std::size_t>(side)]; }
  /// Faces on the boundary; kept up to date, so O(1).
  std::uint32_t boundary_size(Side side) const { return sizes_[static_cast<std::size_t>(side)]; }

 private:
  std::vector<Wrapper> wrappers_;
  std::array<std::uint32_t, 2> sizes_{};
};

}  // namespace lrb::trace

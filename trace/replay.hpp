#pragma once
/// Applies events to wrappers. The recorder and the cursor both do it through here, so that a replay cannot
/// differ from the recording.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/lrb/wrapper.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

/// The wrappers of one or two bodies, and the number of faces on the boundary of each.
class Replay {
 public:
  Replay(std::span<const LrbRep* const> reps, WrapperMode mode);

  /// Makes all wrappers the outermost ones again.
  void reset();
  /// Applies an event: a step resets all wrappers, a refinement or coarsening changes the wrapper of its
  /// side, other kinds do nothing. Returns true for refine and coarsen. `events` are those of the whole
  /// trace, in which causes are looked up; indices must be in range (check_trace).
  ///
  /// In unregularised mode a wrapper is refined face by face: a refinement takes away the face that its
  /// cause, a face test, compared. Without such a cause the whole region is refined.
  bool apply(const Event& event, std::span<const Event> events);

  std::size_t body_count() const { return wrappers_.size(); }
  const Wrapper& wrapper(Side side) const { return wrappers_[static_cast<std::size_t>(side)]; }
  /// Returns the number of faces on the boundary, in constant time.
  std::uint32_t boundary_size(Side side) const { return sizes_[static_cast<std::size_t>(side)]; }

 private:
  std::vector<Wrapper> wrappers_;
  std::array<std::uint32_t, 2> sizes_{};
};

}  // namespace lrb::trace

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
  /// `bare`: wrappers begin with the body itself, as in constructions.
  Replay(std::span<const LrbRep* const> reps, WrapperMode mode, bool bare = false);

  /// Makes all wrappers the outermost ones again, or the bodies themselves.
  void reset();
  /// Applies an event: a step resets all wrappers, a refinement or coarsening changes the wrapper of its
  /// side, and so does a region that was built; other kinds do nothing. Returns true if it changes one.
  /// `events` are those of the whole trace, in which causes are looked up; indices must be in range
  /// (check_trace).
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
  bool bare_;
};

}  // namespace lrb::trace

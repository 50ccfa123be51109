#pragma once
/// Queries one after another, without a word of memory asked for once the first ones have been answered, and
/// without exceptions for what a caller can foresee.

#include <memory>

#include "engine/core/expected.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/distance/distance.hpp"

namespace lrb {

/// The memory that queries use, and the last answer: one for each thread. It serves any bodies; those that
/// follow each other with the same two bodies are quickest.
class Workspace {
 public:
  Workspace();
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  struct Memory;
  Memory& memory() { return *memory_; }

 private:
  std::unique_ptr<Memory> memory_;
};

/// Does what collide() in collide.hpp does. The answer stays in the workspace until its next query, and is
/// the caller's to move from. Refuses what collide() throws InputError for: bodies of different dimensions,
/// poses and world coordinates that are not finite, requests that contradict themselves, more pairs than may
/// be kept.
///
/// Asks for no memory if the request is a plain one (complete; no contacts, interiors_overlap, separation or
/// limits) and a query of these bodies with no fewer pairs has been answered before.
Expected<CollideResult&> collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                 const CollideRequest& request, Workspace& workspace);

/// Does what distance() in distance.hpp does, and refuses what that throws InputError for.
Expected<DistanceResult> distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                  const DistanceRequest& request, Workspace& workspace);

}  // namespace lrb

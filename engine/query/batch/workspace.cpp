#include "engine/query/batch/workspace.hpp"

#include "engine/core/error.hpp"
#include "engine/query/batch/workspace_memory.hpp"
#include "engine/query/collide_impl.hpp"

namespace lrb {

Workspace::Workspace() : memory_(std::make_unique<Memory>()) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

void collide_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const CollideRequest& request, QueryContext& context, Expected<CollideResult>& answer) try {
  // An earlier answer keeps the memory of its vectors.
  if (answer)
    clear(*answer);
  else
    answer = CollideResult{};
  NullProbe probe;
  collide_into(a, pose_a, b, pose_b, request, context, probe, *answer);
} catch (const InputError& e) {
  answer = Refusal{e.what()};
}

Expected<CollideResult&> collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                 const CollideRequest& request, Workspace& workspace) try {
  Workspace::Memory& memory = workspace.memory();
  // Emptied, not replaced: it keeps its memory from the last query.
  clear(memory.result);
  NullProbe probe;
  collide_into(a, pose_a, b, pose_b, request, memory.context.query, probe, memory.result);
  return memory.result;
} catch (const InputError& e) {
  return Refusal{e.what()};
}

Expected<DistanceResult> distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                  const DistanceRequest& request, Workspace& workspace) try {
  return distance(a, pose_a, b, pose_b, request, workspace.memory().context);
} catch (const InputError& e) {
  return Refusal{e.what()};
}

}  // namespace lrb

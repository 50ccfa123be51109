#include "trace/replay.hpp"

#include <algorithm>

namespace lrb::trace {

namespace {

/// Returns the number of the region's faces on the boundary. Refining or coarsening a region changes nothing
/// but these.
std::uint32_t visible_faces(const Wrapper& wrapper, RegionId region) {
  const std::span<const FaceId> faces = wrapper.rep().collector(region);
  return static_cast<std::uint32_t>(
      std::count_if(faces.begin(), faces.end(), [&](FaceId f) { return wrapper.on_boundary(f); }));
}

/// Returns the face that a refinement in unregularised mode takes away; kNull: all faces of the region.
FaceId refined_face(const Event& event, std::span<const Event> events, const LrbRep& rep) {
  if (event.cause == kNull || events[event.cause].kind != EventKind::face_test) return kNull;
  const Event& test = events[event.cause];
  // The tested face alone is removed if it is a lid of the region; otherwise the whole region is refined.
  const FaceId face = rep.face_of_simplex(test.simplex(event.side));
  return rep.inner_cell(face) == event.region() ? face : kNull;
}

void change(Wrapper& wrapper, const Event& event, std::span<const Event> events) {
  if (event.kind != EventKind::refine) {
    wrapper.coarsen(event.region());
    return;
  }
  const FaceId face =
      wrapper.mode() == WrapperMode::unregularised ? refined_face(event, events, wrapper.rep()) : kNull;
  if (face == kNull)
    wrapper.refine(event.region());
  else
    wrapper.refine_face(face);
}

}  // namespace

Replay::Replay(std::span<const LrbRep* const> reps, WrapperMode mode, bool bare) : bare_(bare) {
  for (const LrbRep* rep : reps)
    if (rep) wrappers_.emplace_back(*rep, mode);
  reset();
}

void Replay::reset() {
  for (std::size_t i = 0; i < wrappers_.size(); ++i) {
    wrappers_[i].reset();
    if (bare_) wrappers_[i].refine_all();
    const LrbRep& rep = wrappers_[i].rep();
    sizes_[i] = bare_ ? rep.real_face_count() : static_cast<std::uint32_t>(rep.outermost_faces().size());
  }
}

bool Replay::apply(const Event& event, std::span<const Event> events) {
  if (event.kind == EventKind::step) reset();
  if (!event.changes_wrapper()) return false;
  const auto side = static_cast<std::size_t>(event.side);
  // Only faces of the region itself can change sides: update the boundary's size by their difference.
  const std::uint32_t before = visible_faces(wrappers_[side], event.region());
  change(wrappers_[side], event, events);
  sizes_[side] += visible_faces(wrappers_[side], event.region()) - before;
  return true;
}

}  // namespace lrb::trace

#pragma once
/// What one event does to the wrappers. The recorder and the cursor both go through here, so that a replay is the
/// recording's twin.

#include <span>
#include <vector>

#include "engine/lrb/wrapper.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

/// Step: resets all wrappers. Refine, coarsen: does so to the event's wrapper. Other kinds: nothing.
/// True for refine and coarsen.
///
/// In unregularised mode a wrapper is refined face by face: a refinement takes away the face that its cause, a face
/// test of the same step, compared. Without a cause the whole region is refined.
inline bool apply(const Event& event, std::span<const Event> events, std::vector<Wrapper>& wrappers) {
  if (event.kind == EventKind::step)
    for (Wrapper& w : wrappers) w.reset();
  if (event.kind != EventKind::refine && event.kind != EventKind::coarsen) return false;
  Wrapper& wrapper = wrappers[static_cast<std::size_t>(event.side)];
  if (event.kind == EventKind::coarsen) {
    wrapper.coarsen(event.a);
  } else if (wrapper.mode() == WrapperMode::unregularised && event.cause != kNull &&
             events[event.cause].kind == EventKind::face_test) {
    const Event& test = events[event.cause];
    const LrbRep& rep = wrapper.rep();
    const FaceId face = rep.face_of_simplex(event.side == Side::a ? test.a : test.b);
    if (rep.inner_cell(face) == event.a)
      wrapper.refine_face(face);
    else
      wrapper.refine(event.a);
  } else {
    wrapper.refine(event.a);
  }
  return true;
}

}  // namespace lrb::trace

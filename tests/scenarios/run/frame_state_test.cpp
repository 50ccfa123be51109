#include "scenarios/frames/frame_state.hpp"

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/trace/recorder.hpp>

using namespace lrb;

// Events contain simplices, captions name faces. The two have the same numbers until a face
// has more than three corners: "face 11" of a cube of six was shown for its last triangle.
TEST_CASE("captions name faces, also of bodies of polygons") {
  const LrbRep a = LrbRep::without_regions(shapes::quad_box(), true, false);
  const LrbRep b = LrbRep::without_regions(shapes::quad_box({0, 0, 0}, {0.5, 0.5, 0.5}), true, false);
  REQUIRE(a.real_simplex_count() == 2 * a.real_face_count());
  const Pose pose_b = Pose::translation({0.75, 0.25, 0.25});
  trace::Recorder recorder(a, b, trace::RecorderSettings());
  QueryContext context;
  recorder.begin_step(0, {}, pose_b);
  std::vector<CollideResult> results = {collide(a, {}, b, pose_b, {}, context, recorder)};
  recorder.end_step(results[0]);
  const trace::Trace trace = recorder.take();
  const render::FrameSpec spec;
  run::RecordedRun run;
  run.reps = {&a, &b};
  run.trace = &trace;
  run.results = &results;
  run::FrameState state(run, spec, true);

  std::size_t contacts = 0, beyond = 0;
  for (trace::EventId i = 0; i < trace.events.size(); ++i) {
    const trace::Event& e = trace.events[i];
    if (e.kind != EventKind::contact && e.kind != EventKind::face_test) continue;
    const bool contact = e.kind == EventKind::contact;
    const std::string fa = std::to_string(a.face_of_simplex(e.simplex(Side::a))),
                      fb = std::to_string(b.face_of_simplex(e.simplex(Side::b)));
    const std::string said = contact ? "face " + fa + " of A and face " + fb + " of B"
                                     : "face test " + fa + " against " + fb + ":";
    state.seek(i);
    CHECK_MESSAGE(state.caption().find(said) != std::string::npos, state.caption());
    contacts += contact;
    beyond += e.a >= a.real_face_count() || e.b >= b.real_face_count();
  }
  CHECK(contacts > 0);
  CHECK(beyond > 0);  // or the test would pass with simplices for faces
}

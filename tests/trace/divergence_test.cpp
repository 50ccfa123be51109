
#include <doctest/doctest.h>

#include "tests/trace/runs.hpp"
#include <lrbscope/trace/divergence.hpp>

using namespace lrb;
using namespace lrb::trace;
using runs::first_of;

namespace {

Trace diverging_run(const std::vector<Eigen::Vector3d>& poses = runs::kBoxPoses, Clock clock = Clock::event) {
  static const LrbRep box(toy::dented_box());
  RecorderSettings settings;
  settings.clock = clock;
  return runs::record(box, box, poses, settings).trace;
}

std::string difference(const Trace& x, const Trace& y) {
  const auto d = first_divergence(x, y);
  return d ? d->message() : "none";
}

}  // namespace

TEST_CASE("equal runs do not diverge, whatever the clock or the names") {
  CHECK(difference(diverging_run(), diverging_run()) == "none");
  Trace other = diverging_run(runs::kBoxPoses, Clock::wall);
  other.header.scenario = "renamed";
  other.header.bodies[0].source = "elsewhere.obj";
  other.header.lrbscope = "9.9";
  CHECK(difference(diverging_run(), other) == "none");
}

TEST_CASE("the first divergent event is reported, with the field and both values") {
  const Trace x = diverging_run();
  Trace y = x;
  const EventId contact = first_of(x, EventKind::contact);
  y.events[contact].meet = exact::Meet::disjoint;
  y.events[contact + 3].a += 1;
  auto d = first_divergence(x, y);
  REQUIRE(d);
  CHECK(d->event == contact);
  CHECK(d->step == x.step_of(contact));
  CHECK(d->what == "meet");
  CHECK(d->expected == "cross");
  CHECK(d->actual == "disjoint");

  y = x;
  const EventId refine = first_of(x, EventKind::refine);
  y.events[refine].a ^= 1;
  d = first_divergence(x, y);
  REQUIRE(d);
  CHECK(d->message() == "event " + std::to_string(refine) + " (step " + std::to_string(*d->step) +
                            "): region: expected " + std::to_string(x.events[refine].a) + ", found " +
                            std::to_string(y.events[refine].a));
}

TEST_CASE("the last event of a step, and the vertices of a patch in a later one, are compared") {
  const Trace x = diverging_run();
  Trace y = x, z = x;
  const EventId next = x.steps[1].first_event;
  y.events[next - 1].cause ^= 1;
  CHECK(first_divergence(x, y)->event == next - 1);
  for (Trace* t : {&y, &z}) {
    *t = x;
    t->events[next].kind = EventKind::patch;
    t->events[next].depth_a = 1;
    t->events[next].boundary = 0;
    t->patch_vertices.assign(1, VertexId(t == &y ? 5 : 6));
  }
  CHECK(difference(y, z).ends_with("vertices: expected 5, found 6"));
}

TEST_CASE("metadata of events is compared") {
  const Trace x = diverging_run();
  Trace y = x;
  y.header.level = EventLevel::nodes;
  CHECK(difference(x, y) == "run: level of events: expected faces, found nodes");
  y = x;
  y.header.engine = "FCL 0.7";
  CHECK(difference(x, y) == "run: engine: expected lrbscope, found FCL 0.7");
  y = x;
  y.steps[0].result.separation = Separation{{{{1}, {}}}, {7, 6}};
  CHECK(difference(x, y) == "step 0: separation: expected none, found wrappers of 7 and 6 faces");
  CHECK(difference(x, diverging_run({runs::kBoxPoses[0]})) == "run: number of steps: expected 3, found 1");
}

#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "tests/trace/runs.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;
using namespace lrb::trace;
using exact::Meet;
using runs::plate;

TEST_CASE("beyond the cap, events are counted and not stored") {
  const LrbRep box(toy::dented_box());
  const runs::Run whole = runs::record(box, box, runs::kBoxPoses);
  REQUIRE_FALSE(whole.trace.truncated());
  for (const std::uint32_t cap : {0u, 1u, 7u, static_cast<std::uint32_t>(whole.trace.steps[2].first_event),
                                  static_cast<std::uint32_t>(whole.trace.events.size()) - 1,
                                  static_cast<std::uint32_t>(whole.trace.events.size())}) {
    CAPTURE(cap);
    RecorderSettings settings;
    settings.event_cap = cap;
    const Trace cut = runs::record(box, box, runs::kBoxPoses, settings).trace;
    CHECK(cut.events.size() == cap);
    CHECK(cut.events_seen == whole.trace.events_seen);
    CHECK(cut.truncated() == (cap < whole.trace.events.size()));
    CHECK(std::equal(cut.events.begin(), cut.events.end(), whole.trace.events.begin()));
    REQUIRE(cut.steps.size() == 3);
    for (std::size_t s = 0; s < 3; ++s) {
      CHECK(cut.steps[s].events_seen == whole.trace.steps[s].events_seen);
      CHECK(cut.steps[s].result == whole.trace.steps[s].result);
    }
    CHECK_NOTHROW(check_trace(cut, "cut"));
  }
}

TEST_CASE("depths beyond 16 bits are cut, not wrapped") {
  Recorder recorder(plate(), plate(), {});
  recorder.begin_step(0, {}, {});
  recorder.face_test(0, 0, Meet::disjoint, 65534, 65536);
  const Trace t = recorder.take();
  CHECK(t.events[1].depth_a == 65534);
  CHECK(t.events[1].depth_b == 65535);
}

TEST_CASE("misuse of the recorder is reported") {
  Recorder recorder(plate(), plate(), {});
  Pose nowhere;
  nowhere.t.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(recorder.begin_step(0, nowhere, {}), InputError);
  CHECK_THROWS_AS(recorder.end_step({}), std::logic_error);
  recorder.face_test(0, 0, Meet::disjoint, 0, 0);
  CHECK_THROWS_AS(recorder.take(), std::logic_error);
  Recorder other(plate(), plate(), {});
  other.begin_step(3, {}, {});
  CHECK_THROWS_AS(other.begin_step(3, {}, {}), std::logic_error);
}

TEST_CASE("an emptied recorder starts from the beginning") {
  Recorder recorder(plate(), plate(), {});
  const auto run = [&] {
    recorder.begin_step(5, {}, {});
    recorder.face_test(11, 0, Meet::cross, 0, 0);
    recorder.refine(Side::a, 2, 3);
    recorder.face_test(10, 0, Meet::cross, 1, 0);
    return recorder.take();
  };
  const Trace first = run();
  CHECK(first == run());
}

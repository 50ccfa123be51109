#include <algorithm>
#include <random>
#include <stdexcept>

#include <doctest/doctest.h>

#include "tests/trace/runs.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/replay.hpp>

using namespace lrb;
using namespace lrb::trace;

namespace {

void check_state(const Cursor& cursor, const runs::Run& run) {
  CAPTURE(cursor.position());
  const runs::Snapshot& real = run.after[cursor.position()];
  CHECK(cursor.wrapper(Side::a).boundary() == real.a);
  CHECK(cursor.wrapper(Side::b).boundary() == real.b);
  CHECK(cursor.boundary_size(Side::a) == real.a.size());
  CHECK(cursor.boundary_size(Side::b) == real.b.size());
}

void check_run(const LrbRep& a, const LrbRep& b, const std::vector<Eigen::Vector3d>& poses,
               WrapperMode mode) {
  RecorderSettings settings;
  settings.request.wrapper = mode;
  const runs::Run run = runs::record(a, b, poses, settings);
  REQUIRE(run.after.size() == run.trace.events.size());
  const auto refinements = std::count_if(run.trace.events.begin(), run.trace.events.end(),
                                         [](const Event& e) { return e.kind == EventKind::refine; });
  REQUIRE(refinements >= 3);  // else this would test little
  Cursor cursor(run.trace, a, b);
  CHECK(cursor.at_start());
  EventId event = 0;
  for (; cursor.next(); ++event) {
    REQUIRE(cursor.position() == event);
    check_state(cursor, run);
  }
  CHECK(event == run.trace.events.size());
  for (; cursor.previous() && !cursor.at_start();) check_state(cursor, run);
  CHECK(cursor.at_start());
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    cursor.seek(static_cast<EventId>(random() % run.trace.events.size()));
    check_state(cursor, run);
  }
}

}  // namespace

TEST_CASE("a replay equals the recorded wrappers after every event, in any order") {
  const LrbRep plate(toy::notched_plate()), box(toy::dented_box());
  for (const WrapperMode mode : {WrapperMode::regularised, WrapperMode::unregularised}) {
    CAPTURE(static_cast<int>(mode));
    check_run(plate, plate, runs::kPlatePoses, mode);
    check_run(box, box, runs::kBoxPoses, mode);
  }
}

TEST_CASE("a replay rejects another body and another number of bodies") {
  const LrbRep plate(toy::notched_plate());
  LrbData moved = toy::notched_plate();
  moved.vertices[5].y() += 0.25;
  const LrbRep other(std::move(moved));
  const Trace t = runs::record(plate, plate, runs::kPlatePoses).trace;
  CHECK_NOTHROW(Cursor(t, plate, plate));
  CHECK_THROWS_WITH_AS(Cursor(t, plate, other), doctest::Contains("body B: expected"), InputError);
  CHECK_THROWS_WITH_AS(Cursor(t, other, plate), doctest::Contains("body A: expected"), InputError);
  CHECK_THROWS_AS(Cursor(t, plate), InputError);
}

TEST_CASE("a replay detects different refinements") {
  const LrbRep plate(toy::notched_plate());
  const runs::Run run = runs::record(plate, plate, runs::kPlatePoses);
  Trace t = run.trace;
  const auto refinement = std::find_if(t.events.begin(), t.events.end(),
                                       [](const Event& e) { return e.kind == EventKind::refine; });
  REQUIRE(refinement != t.events.end());
  refinement->boundary += 1;
  Cursor cursor(t, plate, plate);
  const auto event = static_cast<EventId>(refinement - t.events.begin());
  CHECK_THROWS_WITH_AS(cursor.seek(event), doctest::Contains("the trace is damaged"), InputError);
  CHECK(cursor.at_start());
  cursor.seek(event - 1);
  check_state(cursor, run);
  CHECK_THROWS_AS(cursor.seek(static_cast<EventId>(t.events.size())), std::out_of_range);
}

TEST_CASE("a truncated trace replays as far as it goes") {
  const LrbRep box(toy::dented_box());
  RecorderSettings settings;
  settings.event_cap = 40;
  const runs::Run run = runs::record(box, box, runs::kBoxPoses, settings);
  REQUIRE(run.trace.truncated());
  Cursor cursor(run.trace, box, box);
  while (cursor.next()) check_state(cursor, run);
  CHECK(cursor.position() == 39);
}

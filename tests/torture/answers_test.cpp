// Invariants of answers for any case of any family. RapidCheck draws the cases and, if one fails,
// searches the lowest difficulty that also fails. ctest fixes its seed; by hand each run
// draws others (RC_PARAMS="seed=... max_success=...").
#include <algorithm>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <unistd.h>

#include "engine/collide/collide_into.hpp"
#include "tests/torture/regions.hpp"
#include "tests/torture/sweep_oracle.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/replay.hpp>

using namespace lrb;
using namespace lrb::cases;

namespace {

constexpr std::uint32_t kMaxSimplices = 300;  // the builder is called often

/// A case of any family whose coordinates are finite. Discards bodies above kMaxSimplices.
cases::Case any_case() {
  const auto families = cases::all_families();
  const cases::Family& family = families[*rc::gen::inRange<std::size_t>(0, families.size()).as("family")];
  const int difficulty = *rc::gen::inRange(0, cases::kDifficulties).as("difficulty");
  const auto index = *rc::gen::inRange<std::uint64_t>(0, 1000000).as("index");
  cases::Case c = cases::make_case(family, 1, difficulty, index);
  RC_TAG(std::string(family.name));
  RC_PRE(c.a->real_simplex_count() <= 4 * kMaxSimplices && c.b->real_simplex_count() <= 4 * kMaxSimplices);
  for (const auto& [rep, pose] : {std::pair{c.a, c.pose_a}, std::pair{c.b, c.pose_b}})
    for (const auto& v : rep->vertices()) RC_PRE(pose.apply(v).allFinite());
  return c;
}

/// The same with regions, where the builder takes the mesh; often.
cases::Case any_case_with_regions() {
  cases::Case c = any_case();
  RandomEngine random(*rc::gen::arbitrary<std::uint64_t>().as("regions"));
  torture::give_regions(c, random, kMaxSimplices);
  return c;
}

CollideResult ask(const cases::Case& c, const CollideRequest& request = {}) {
  return collide(*c.a, c.pose_a, *c.b, c.pose_b, request);
}

CollideRequest any_request() {
  CollideRequest r;
  r.mode = *rc::gen::element(Mode::all_pairs, Mode::first_pair);
  r.recursion = *rc::gen::element(Recursion::complete, Recursion::complete, Recursion::paper,
                                  Recursion::paper_strict, Recursion::paper_wrapper);
  r.wrapper = *rc::gen::element(WrapperMode::regularised, WrapperMode::unregularised);
  return r;
}

void assert_same(const CollideResult& x, const CollideResult& y) {
  RC_ASSERT(x.pairs == y.pairs);
  RC_ASSERT(x.meets == y.meets);
  RC_ASSERT(x.relation == y.relation);
}

cases::Body saved_and_loaded(const LrbRep& rep) {
  const auto file =
      std::filesystem::temp_directory_path() / ("lrb-answers-" + std::to_string(getpid()) + ".lrb");
  save_lrb(rep, file.string());
  auto back = std::make_shared<LrbRep>(load_lrb(file.string()));
  std::filesystem::remove(file);
  return back;
}

}  // namespace

TEST_CASE("the complete query equals brute force, with regions and without") {
  CHECK(rc::check([] {
    const cases::Case c = any_case_with_regions();
    const CollideResult r = ask(c);
    const BruteForceResult expected = torture::swept_brute_force(*c.a, c.pose_a, *c.b, c.pose_b);
    RC_ASSERT(r.pairs == expected.pairs);
    RC_ASSERT(r.meets == expected.meets);
    RC_ASSERT(r.relation == expected.relation);
    RC_CLASSIFY(!r.pairs.empty(), "in contact");
  }));
}

TEST_CASE("a loaded body gives the same answers") {
  CHECK(rc::check([] {
    const cases::Case c = any_case_with_regions();
    const cases::Case loaded{saved_and_loaded(*c.a), saved_and_loaded(*c.b), c.pose_a, c.pose_b, {}, {}};
    const CollideRequest request = any_request();
    const CollideResult before = ask(c, request), after = ask(loaded, request);
    assert_same(before, after);
    RC_ASSERT(before.opened == after.opened);
    RC_ASSERT(before.counters.face_tests == after.counters.face_tests);
    RC_ASSERT(before.counters.box_tests == after.counters.box_tests);
  }));
}

TEST_CASE("recording changes no answer, and the trace replays to the wrappers that the query left") {
  CHECK(rc::check([] {
    const cases::Case c = any_case_with_regions();
    trace::RecorderSettings settings;
    settings.request = any_request();
    settings.event_cap = 100000;
    trace::Recorder recorder(*c.a, *c.b, settings);
    QueryContext context;
    recorder.begin_step(0, c.pose_a, c.pose_b);
    const CollideResult recorded =
        collide(*c.a, c.pose_a, *c.b, c.pose_b, settings.request, context, recorder);
    recorder.end_step(recorded);
    RC_PRE(recorder.events_seen() <= settings.event_cap);
    const CollideResult plain = ask(c, settings.request);
    assert_same(recorded, plain);
    RC_ASSERT(recorded.opened == plain.opened);
    const trace::Trace trace = recorder.take();
    trace::Cursor cursor(trace, *c.a, *c.b);
    cursor.seek(static_cast<trace::EventId>(trace.events.size()) - 1);
    for (const Side side : {Side::a, Side::b}) {
      RC_ASSERT(cursor.wrapper(side).excluded() == plain.opened[static_cast<std::size_t>(side)]);
      RC_ASSERT(cursor.wrapper(side).boundary() == context[side].wrapper->boundary());
    }
    RC_CLASSIFY(!plain.opened[0].empty() || !plain.opened[1].empty(), "wrappers refined");
  }));
}

#include <algorithm>

#include <doctest/doctest.h>

#include "scenarios/record/recorded_run.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;

TEST_CASE("a run whose trace names an invalid vertex is rejected") {
  spec::Scenario s;
  s.bodies.resize(2);
  for (spec::BodySpec& body : s.bodies) body.generator = "ball";
  s.events = EventLevel::nodes;
  s.motion.kind = spec::Motion::Kind::poses;
  s.motion.poses = {Pose::translation({0.1, 0, 5})};
  record::Recording r = record::record(s, record::kSilent);
  const test::Folder folder;
  save_lrb(r.bodies[0].rep, folder / "a.lrb");
  save_lrb(r.bodies[1].rep, folder / "b.lrb");
  const auto write = [&] { trace::save_trace(r.trace, folder / "trace.json"); };
  write();
  CHECK(record::open_run(folder.path.string()).trace == r.trace);
  const auto point = std::find_if(r.trace.events.begin(), r.trace.events.end(),
                                  [](const trace::Event& e) { return e.kind == EventKind::point; });
  REQUIRE(point != r.trace.events.end());
  point->a =
      static_cast<std::uint32_t>(r.bodies[static_cast<std::size_t>(point->side)].rep.vertices().size());
  write();
  CHECK_THROWS_AS(record::open_run(folder.path.string()), InputError);
}

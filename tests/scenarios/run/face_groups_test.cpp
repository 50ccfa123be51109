#include <map>
#include <numeric>

#include <doctest/doctest.h>

#include "scenarios/frames/face_colours.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "tests/support/approach.hpp"
#include <lrbscope/trace/counters.hpp>

using namespace lrb;

namespace {

using ColourPer = pictures::FrameSpec::ColourPer;

record::Recording rocks() {
  spec::Scenario s = test::approach("rock", 6);
  s.events = EventLevel::nodes;
  return record::record(s, record::kSilent);
}

}  // namespace

TEST_CASE("sums over regions and levels count every face once") {
  const record::Recording r = rocks();
  const LrbRep& rep = r.bodies[0].rep;
  const trace::FaceCounts counts = trace::count_faces(rep, Side::a, r.trace.events);
  const std::vector<double> tests(counts.tests.begin(), counts.tests.end());
  const double all = std::accumulate(tests.begin(), tests.end(), 0.0);
  REQUIRE(all > 0);
  CHECK(frames::grouped(tests, ColourPer::face, rep) == tests);
  for (const ColourPer per : {ColourPer::region, ColourPer::level}) {
    const std::vector<double> sums = frames::grouped(tests, per, rep);
    REQUIRE(sums.size() == tests.size());
    std::map<std::uint32_t, double> once;
    double total = 0;
    for (FaceId f = 0; f < rep.face_count(); ++f) {
      const std::uint32_t group =
          per == ColourPer::region ? frames::region_of(rep, f) : frames::level_of(rep, f);
      if (group == kNull) {
        CHECK(sums[f] == tests[f]);
        total += sums[f];
      } else if (once.emplace(group, sums[f]).second) {
        total += sums[f];
      } else {
        CHECK(sums[f] == once[group]);
      }
    }
    CHECK(total == all);
  }
}

TEST_CASE("a real face belongs to the region that covers it, a pseudo face to the one that it hides") {
  const record::Recording r = rocks();
  const LrbRep& rep = r.bodies[0].rep;
  for (RegionId region = 0; region < rep.region_count(); ++region) {
    for (const FaceId f : rep.lids(region)) CHECK(frames::region_of(rep, f) == region.value());
    for (const FaceId f : rep.floor(region))
      if (rep.is_real(f)) CHECK(frames::region_of(rep, f) == region.value());
  }
  for (const FaceId f : rep.outermost_faces()) CHECK(frames::level_of(rep, f) == 0);
}

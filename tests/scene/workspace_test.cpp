// A workspace: its answers to all four questions are those of the functions without one, with and without a
// probe, and what these throw comes back as a reason.
#include <array>
#include <limits>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/answer_content.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;
using lrb::test::content;

namespace {

/// Keeps all events, each as numbers.
class EventList final : public CollideProbe {
 public:
  using Event = std::array<std::uint32_t, 5>;

  void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a,
                 std::uint32_t depth_b) override {
    add(0, a, b, static_cast<std::uint32_t>(meet), depth_a + 1000 * depth_b);
  }
  void refine(Side side, RegionId region, std::uint32_t added) override {
    add(1, static_cast<std::uint32_t>(side), region, added);
  }
  void coarsen(Side side, RegionId region, std::uint32_t removed) override {
    add(2, static_cast<std::uint32_t>(side), region, removed);
  }
  void contact(SimplexId a, SimplexId b, exact::Meet meet) override {
    add(3, a, b, static_cast<std::uint32_t>(meet));
  }
  EventLevel level() const override { return EventLevel::all; }
  std::uint32_t node_pair(const NodeVisit& visit) override {
    add(4, visit.a, visit.b, visit.parent, visit.box_tests);
    return static_cast<std::uint32_t>(events.size() - 1);
  }
  void point(Side whose, VertexId v, Where where) override {
    add(5, static_cast<std::uint32_t>(whose), v, static_cast<std::uint32_t>(where));
  }
  void end(Phase phase, std::uint64_t count) override {
    add(6, static_cast<std::uint32_t>(phase), static_cast<std::uint32_t>(count));
  }

  std::vector<Event> events;

 private:
  void add(std::uint32_t kind, std::uint32_t a, std::uint32_t b, std::uint32_t c = 0, std::uint32_t d = 0) {
    events.push_back({kind, a, b, c, d});
  }
};

/// Asks each question with a workspace, with and without a probe, and compares with the functions without.
struct Comparison {
  Workspace workspace;
  std::size_t collide_events = 0, distance_events = 0, clash_events = 0, contact_events = 0;

  void collide(const LrbRep& a, const LrbRep& b, const Pose& pose_b, const CollideRequest& request) {
    EventList alone, here;
    const auto expected = content(lrb::collide(a, Pose{}, b, pose_b, request));
    CHECK(content(*lrb::collide(a, Pose{}, b, pose_b, request, workspace)) == expected);
    CHECK(content(*lrb::collide(a, Pose{}, b, pose_b, request, workspace, &here)) == expected);
    CHECK(content(lrb::collide(a, Pose{}, b, pose_b, request, alone)) == expected);
    CHECK(here.events == alone.events);
    collide_events += here.events.size();
  }
  void distance(const LrbRep& a, const LrbRep& b, const Pose& pose_b, const DistanceRequest& request) {
    BoundsHistory alone, here;
    const auto expected = content(lrb::distance(a, Pose{}, b, pose_b, request));
    CHECK(content(*lrb::distance(a, Pose{}, b, pose_b, request, workspace)) == expected);
    CHECK(content(*lrb::distance(a, Pose{}, b, pose_b, request, workspace, &here)) == expected);
    CHECK(content(lrb::distance(a, Pose{}, b, pose_b, request, alone)) == expected);
    CHECK(here.history == alone.history);
    distance_events += here.history.size();
  }
  void clash(const LrbRep& a, const LrbRep& b, const Pose& pose_b, const ClashRequest& request) {
    ClashHistory alone, here;
    const auto expected = content(lrb::clash(a, Pose{}, b, pose_b, request));
    CHECK(content(*lrb::clash(a, Pose{}, b, pose_b, request, workspace)) == expected);
    CHECK(content(*lrb::clash(a, Pose{}, b, pose_b, request, workspace, &here)) == expected);
    CHECK(content(lrb::clash(a, Pose{}, b, pose_b, request, alone)) == expected);
    CHECK(here.of_distance == alone.of_distance);
    CHECK(here.of_depth == alone.of_depth);
    clash_events += here.of_distance.size() + here.of_depth.size();
  }
  void first_contact(const LrbRep& a, const LrbRep& b, const Motion& motion_b,
                     const FirstContactRequest& request) {
    const Motion still = Motion::still({});
    FirstContactHistory alone, here;
    const auto expected = content(lrb::first_contact(a, still, b, motion_b, request));
    CHECK(content(*lrb::first_contact(a, still, b, motion_b, request, workspace)) == expected);
    CHECK(content(*lrb::first_contact(a, still, b, motion_b, request, workspace, &here)) == expected);
    CHECK(content(lrb::first_contact(a, still, b, motion_b, request, alone)) == expected);
    CHECK(here.history == alone.history);
    contact_events += here.history.size();
  }
};

/// Requests of every kind.
std::vector<CollideRequest> collide_requests() {
  std::vector<CollideRequest> out(7);
  out[1].mode = Mode::first_pair;
  out[2].contacts = out[2].interiors_overlap = true;
  out[3].tolerance = 0.05;
  out[4].separation = true;
  out[5].mode = Mode::any_pair;
  out[5].max_tests = 3;
  out[6].recursion = Recursion::paper;
  return out;
}

/// Returns the reason why a function without a workspace throws an InputError.
template <class Ask>
std::string reason_of(const Ask& ask) {
  try {
    ask();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no InputError";
}

static_assert(std::is_same_v<decltype(*std::declval<const Expected<int&>&>()), int&>);
static_assert(std::is_same_v<decltype(std::declval<Expected<int&>>().value()), int&>);

}  // namespace

TEST_CASE("a workspace answers all four questions as the functions without one, with and without a probe") {
  const LrbRep ball = build_lrb(shapes::bumpy_sphere(2, 4)), ring = build_lrb(shapes::torus(16, 8)),
               box = build_lrb(shapes::box());
  const LrbRep* const all[] = {&ball, &ring, &box};
  const std::vector<CollideRequest> kinds = collide_requests();
  shapes::RandomEngine random(7);
  Comparison compare;  // one workspace for all questions and bodies, in any order
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const LrbRep &a = *all[random() % 3], &b = *all[random() % 3];
    const Pose pose = shapes::random_pose(random, a, b, shapes::uniform(random, 0.2, 1.2));
    compare.collide(a, b, pose, kinds[random() % kinds.size()]);
    DistanceRequest distance;
    distance.relative_tolerance = i % 3 == 0 ? 0.1 : 0;
    if (i % 4 == 0) distance.within = 0.1;
    compare.distance(a, b, pose, distance);
    ClashRequest clash;
    clash.clearance = 0.1;
    if (i % 3 == 0) clash.along = Eigen::Vector3d(1, 2, 3);
    compare.clash(a, b, pose, clash);
    FirstContactRequest contact;
    contact.history = i % 2 == 0;
    compare.first_contact(
        a, b, Motion::screw(Pose::translation({6, 1, 0}), Pose{pose.r, pose.t - Eigen::Vector3d(4, 0, 0)}),
        contact);
  }
  CHECK(compare.collide_events > 1000);
  CHECK(compare.distance_events > 60);
  CHECK(compare.clash_events > 60);
  CHECK(compare.contact_events > 60);
  const LrbRep flat = build_lrb(shapes::ring_2d(12));
  compare.collide(flat, flat, Pose::translation({0.5, 0.25, 0}), {});
  compare.distance(flat, flat, Pose::translation({9, 0, 0}), {});
}

TEST_CASE("an answer stays in the workspace until the next query of the same kind") {
  const LrbRep box = build_lrb(shapes::box());
  const Pose at = Pose::translation({0.5, 0.25, 0.125});
  Workspace workspace;
  const CollideResult& pairs = collide(box, {}, box, at, {}, workspace).value();
  const DistanceResult& gap = distance(box, {}, box, Pose::translation({3, 0, 0}), {}, workspace).value();
  const std::size_t count = pairs.pairs.size();
  CHECK(count > 0);
  CHECK(clash(box, {}, box, at, {}, workspace)->kind == ClashKind::protrudes);
  const Motion motion = Motion::screw(Pose::translation({3, 0, 0}), Pose{});
  CHECK(first_contact(box, Motion::still({}), box, motion, {}, workspace)->is_contact());
  CHECK(pairs.pairs.size() == count);
  CHECK(gap.lower > 1.9);
  CHECK(&collide(box, {}, box, Pose::translation({9, 0, 0}), {}, workspace).value() == &pairs);
  CHECK(pairs.pairs.empty());
  // Moving the answer out leaves a workspace that goes on.
  const CollideResult mine = std::move(collide(box, {}, box, at, {}, workspace).value());
  CHECK(mine.pairs.size() == count);
  CHECK(collide(box, {}, box, at, {}, workspace)->pairs == mine.pairs);
}

TEST_CASE("describe_contact() adds the contacts that a query without them omitted") {
  const LrbRep ball = build_lrb(shapes::bumpy_sphere(2, 4)), box = build_lrb(shapes::box());
  Workspace workspace;
  CollideRequest more;
  more.contacts = more.interiors_overlap = true;
  const auto without_counters = [](CollideResult r) {
    r.counters = {};
    return r;
  };
  for (const LrbRep* const b : {&ball, &box})
    for (const double x : {0.25, 1.0, 2.0, 5.0}) {
      CAPTURE(x);
      const Pose pose = Pose::translation({x, 0, 0});
      CollideResult found = collide(box, Pose{}, *b, pose);
      const Expected<CollideResult&> described =
          describe_contact(box, Pose{}, *b, pose, more, workspace, found);
      REQUIRE(described.has_value());
      CHECK(&*described == &found);
      const CollideResult at_once = collide(box, Pose{}, *b, pose, more);
      CHECK(content(without_counters(found)) == content(without_counters(at_once)));
    }
}

TEST_CASE("a workspace returns the errors that the functions without one throw") {
  const LrbRep box = build_lrb(shapes::box()), flat = build_lrb(shapes::circle(8));
  const Pose nowhere = Pose::translation({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  Workspace workspace;
  CollideResult found;
  for (const auto& refused : {std::pair(&box, nowhere), std::pair(&flat, Pose{})}) {
    const auto* const b = refused.first;
    const Pose& pose = refused.second;
    const std::string reason = reason_of([&] { check_query(box, Pose{}, *b, pose); });
    CHECK(reason == reason_of([&] { (void)collide(box, Pose{}, *b, pose); }));
    CHECK(collide(box, Pose{}, *b, pose, {}, workspace).error().reason == reason);
    CHECK(distance(box, Pose{}, *b, pose, {}, workspace).error().reason == reason);
    CHECK(clash(box, Pose{}, *b, pose, {}, workspace).error().reason == reason);
    CHECK(describe_contact(box, Pose{}, *b, pose, {}, workspace, found).error().reason == reason);
  }
  CHECK(!first_contact(box, Motion::still({}), flat, Motion::still({}), {}, workspace));

  CollideRequest coarse;
  coarse.tolerance = 0.1;
  coarse.contacts = true;
  DistanceRequest within;
  within.within = -1;
  ClashRequest nowhere_along;
  nowhere_along.along = Eigen::Vector3d(0, 0, 0);
  FirstContactRequest wide;
  wide.tolerance = 2;
  CHECK(collide(box, {}, box, {}, coarse, workspace).error().reason ==
        reason_of([&] { check_request(coarse); }));
  CHECK(distance(box, {}, box, {}, within, workspace).error().reason ==
        reason_of([&] { check_request(within); }));
  CHECK(clash(box, {}, box, {}, nowhere_along, workspace).error().reason ==
        reason_of([&] { check_request(box, nowhere_along); }));
  CHECK(first_contact(box, Motion::still({}), box, Motion::still({}), wide, workspace).error().reason ==
        reason_of([&] { check_request(wide); }));
  check_request(CollideRequest{});
  CHECK(clash(flat, {}, flat, {}, {}, workspace).error().reason ==
        reason_of([&] { check_request(flat, ClashRequest{}); }));
  CollideRequest few;
  few.max_pairs = 1;
  CHECK(!collide(box, {}, box, {}, few, workspace));
  // The next query is answered as if nothing had been refused.
  CHECK(collide(box, {}, box, {}, {}, workspace)->relation == Relation::touching);
  CHECK_THROWS_AS((void)collide(box, {}, box, nowhere, {}, workspace).value(), InputError);
}

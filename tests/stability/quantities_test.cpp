// Numbers in the stability experiment: what rational arithmetic says is right, how answers are judged, and
// that ours are.
#include <array>
#include <cmath>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/quantities/truth.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/self_intersections.hpp>

using namespace lrb;
using namespace lrb::quantities;
using namespace lrb::stability;

namespace {

cases::Case boxes(const Eigen::Vector3d& shift) {
  cases::Case c;
  c.a = c.b = cases::body(shapes::box());
  c.pose_b = Pose::translation(shift);
  return c;
}

void check_number(Quantity quantity, const cases::Case& c, double right) {
  const RightAnswer e = true_number(quantity, c);
  REQUIRE(e.rejection == "");
  CHECK(*e.least <= right);
  CHECK(*e.most >= right);
  CHECK(*e.most - *e.least <= 1e-15 * right);
}

/// Asks lrbscope, and judges its answer.
Record ask_ours(Quantity quantity, const cases::Case& c) {
  static const std::vector<methods::MethodEntry> kMethods = methods::registered_methods();
  const methods::MethodEntry& ours = methods::find_method(kMethods, "ours", quantity);
  Record r;
  judge(r, ours.info, ask_number(ours, c), true_number(quantity, c));
  return r;
}

/// Judges a number as it comes from a worker.
Outcome judged(Quantity quantity, double lower, double upper, double least, double most, bool proves) {
  methods::MethodInfo info;
  info.quantity = quantity;
  info.traits.set(methods::Trait::proves, proves);
  RightAnswer e;
  e.least = least;
  e.most = most;
  e.size = 1;
  Record r;
  const std::string line = workers::to_json(methods::number_answer(lower, upper, 0)).dump();
  judge(r, info, workers::answer_from(nlohmann::json::parse(line)), e);
  return r.outcome;
}

}  // namespace

TEST_CASE("stability: the true distance and depth of two boxes") {
  check_number(Quantity::distance, boxes({4, 5, 0.5}), 5);
  check_number(Quantity::distance, boxes({1, 0, 0}), 0);
  check_number(Quantity::distance, boxes({0.5, 0.5, 0.5}), 0);
  check_number(Quantity::depth, boxes({0.75, 0.25, 0.5}), 0.25);
  check_number(Quantity::depth, boxes({1, 0.25, 0.5}), 0);
  cases::Case large = boxes({0.5, 0.5, 0.5});
  large.b = cases::body(shapes::l_shape());
  CHECK(true_number(Quantity::depth, large).rejection.find("more than 20 triangles") != std::string::npos);
  CHECK(!true_number(Quantity::depth, large).least);
}

TEST_CASE("B collides with A at the time found by exact queries") {
  const cases::Case c = boxes({0.25, 0.5, 0.875});
  const RightAnswer e = true_number(Quantity::first_contact, c);
  const methods::Question q = question_of(c);
  const double gap = q.from.z() + 0.875 - 1, way = q.from.z() - q.to.z();  // from above, face on face
  const double by_x = q.from.x() + 0.25 - 1, by_y = q.from.y() + 0.5 - 1;
  REQUIRE(gap > 0);
  REQUIRE(by_x + gap / way * (q.to.x() - q.from.x()) < 0);
  REQUIRE(by_y + gap / way * (q.to.y() - q.from.y()) < 0);
  CHECK(*e.least <= gap / way * (1 + 1e-15));
  CHECK(*e.most >= gap / way * (1 - 1e-15));
}

TEST_CASE("stability: computed numbers are compared with the true ones") {
  const auto distance = [](double lower, double upper, double right, bool proves) {
    return judged(Quantity::distance, lower, upper, right, right, proves);
  };
  CHECK(distance(1, 1.1, 1.05, true) == Outcome::right);
  CHECK(distance(1, 1.1, 1.2, true) == Outcome::wrong);
  CHECK(distance(1, 1.1, 0.9, true) == Outcome::wrong);
  CHECK(distance(1, 1, 1 + 1e-7, false) == Outcome::right);
  CHECK(distance(1, 1, 1 + 1e-5, false) == Outcome::wrong);
  CHECK(distance(0, 0, 1e-16, false) == Outcome::wrong);
  CHECK(distance(1e-16, 1e-16, 0, false) == Outcome::wrong);
  CHECK(distance(0, 0, 0, false) == Outcome::right);
  using methods::kNever;
  CHECK(judged(Quantity::first_contact, kNever, kNever, 0.5, 0.5, false) == Outcome::wrong);
  CHECK(judged(Quantity::first_contact, 0.5, 0.5, kNever, kNever, false) == Outcome::wrong);
  CHECK(judged(Quantity::first_contact, kNever, kNever, kNever, kNever, false) == Outcome::right);
  CHECK(judged(Quantity::first_contact, 0.5, 0.5, 0.5005, 0.5005, false) == Outcome::right);
  CHECK(judged(Quantity::first_contact, 0.5, 0.5, 0.51, 0.51, false) == Outcome::wrong);
  for (const double x : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    for (const bool proves : {false, true}) {
      CHECK(judged(Quantity::distance, x, x, 1, 1, proves) == Outcome::wrong);
      CHECK(judged(Quantity::first_contact, x, x, 0.5, 0.5, proves) == Outcome::wrong);
    }
}

TEST_CASE("lrbscope's numbers are right from benign to degenerate") {
  int right = 0;
  for (const Quantity quantity : {Quantity::distance, Quantity::first_contact, Quantity::depth})
    for (const char* name : {"kiss", "sliver", "thin", "far", "scale"})
      for (const int difficulty : {0, 6, 10}) {
        CAPTURE(name);
        CAPTURE(difficulty);
        CAPTURE(name_of(quantity));
        const cases::Case c = cases::make_case(*cases::find_family(name), 3, difficulty, 0);
        const Record r = ask_ours(quantity, c);
        CAPTURE(r.relation);
        CAPTURE(r.expected_relation);
        CHECK((r.outcome == Outcome::right || r.outcome == Outcome::rejected));
        right += r.outcome == Outcome::right;
      }
  CHECK(right > 20);
  // However short a span of time is, more pairs may stay near this needle than the search looks for at first.
  for (const int difficulty : {2, 5, 10})
    CHECK(ask_ours(Quantity::first_contact, cases::make_case(*cases::find_family("sliver"), 1, difficulty, 1))
              .outcome == Outcome::right);
}

namespace {

LrbRep triangles(const std::vector<Eigen::Vector3d>& points, const std::vector<std::array<int, 3>>& faces) {
  Mesh m;
  m.vertices = points;
  for (const auto& f : faces) {
    const VertexId corners[3] = {VertexId(f[0]), VertexId(f[1]), VertexId(f[2])};
    m.add_face(corners);
  }
  return LrbRep::without_regions(m, false, true);
}

}  // namespace

TEST_CASE("rational lists: pairs within a distance, with the distance itself") {
  const cases::Case c = boxes({1.25, 0, 0});
  const methods::Question q = question_of(c);
  CHECK(true_near_pairs(q.a, q.b, std::nextafter(0.25, 0)).empty());
  const std::size_t facing = true_near_pairs(q.a, q.b, 0.25).size();
  CHECK(facing > 4);  // the two facing sides, and faces beside them
  CHECK(true_near_pairs(q.a, q.b, 0).empty());
  CHECK(true_near_pairs(q.a, q.b, 10).size() == 144);
  // Tiny distances, whose squares are less than the least double.
  const LrbRep a = triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}),
               b = triangles({{0, 0, 0x1p-600}, {1, 0, 0x1p-600}, {0, 1, 0x1p-600}}, {{0, 1, 2}});
  CHECK(true_near_pairs(a, b, 0x1p-600).size() == 1);
  CHECK(true_near_pairs(a, b, 0x1p-601).empty());
}

TEST_CASE("rational lists: self-intersections of triangles that share corners") {
  const std::vector<Eigen::Vector3d> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},  {0, -1, 0},
                                          {0, 2, 0}, {1, 1, 1}, {1, 1, -1}, {2, 0, 0}};
  const auto pairs = [&](const std::vector<std::array<int, 3>>& faces) {
    const LrbRep body = triangles(p, faces);
    const std::size_t right = true_self_intersections(body).size();
    CHECK(self_intersections(body, 1).pairs.size() == right);
    return right;
  };
  CHECK(pairs({{0, 1, 2}, {0, 1, 3}}) == 0);  // an edge, on both sides of it
  CHECK(pairs({{0, 1, 2}, {0, 1, 4}}) == 1);  // an edge, on one side
  CHECK(pairs({{0, 1, 2}, {0, 1, 5}}) == 0);  // an edge, in two planes
  CHECK(pairs({{0, 1, 4}, {0, 5, 6}}) == 1);  // a corner, and through each other
  CHECK(pairs({{0, 2, 6}, {1, 5, 7}}) == 0);  // no corner
  CHECK(pairs({{0, 1, 2}, {1, 0, 2}}) == 1);  // all corners
  CHECK(pairs({{0, 1, 2}, {0, 1, 7}}) == 0);  // the second has no area
}

TEST_CASE("lrbscope's lists of near pairs and self-intersections are right from benign to degenerate") {
  std::uint64_t right = 0, pairs = 0;
  for (const Quantity quantity : {Quantity::near_pairs, Quantity::self_intersections})
    for (const char* name : {"coplanar", "stack", "shared", "sliver", "far", "slide", "mixture", "zero-area"})
      for (const int difficulty : {0, 6, 10})
        for (const std::uint64_t index : {0, 1}) {
          CAPTURE(name);
          CAPTURE(difficulty);
          CAPTURE(index);
          CAPTURE(name_of(quantity));
          const cases::Case c = cases::make_case(*cases::find_family(name), 5, difficulty, index);
          const Record r = ask_ours(quantity, c);
          CHECK((r.outcome == Outcome::right || r.outcome == Outcome::rejected));
          right += r.outcome == Outcome::right;
          pairs += r.expected;
        }
  CHECK(right > 30);
  CHECK(pairs > 500);
}

/// Speed and accuracy: data sets, records, and the numbers computed from them. The commands:
/// tests/commands/bench.txt. tests/commands/bench.txt.

#include <algorithm>
#include <cmath>
#include <map>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include "bench/speed/bench_runner.hpp"
#include "bench/speed/build_times.hpp"
#include "bench/speed/data_set.hpp"
#include "bench/speed/make_sets.hpp"
#include "bench/speed/metrics.hpp"
#include "bench/speed/peer_table.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/report/chart.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>

using namespace lrb;
using namespace lrb::speed;
using lrb::test::Folder;
using lrb::test::slurp;

namespace {

speed::BodyPair small_pair() {
  return {"spheres", "two bumpy spheres", [] { return shapes::bumpy_sphere(2, 1); },
          [] { return shapes::bumpy_sphere(2, 2); }};
}

speed::SetOptions few() {
  speed::SetOptions o;
  o.poses = 4;
  return o;
}

methods::MethodInfo info(const std::string& name) {
  methods::MethodInfo i;
  i.name = name;
  if (name == "ours") i.role = methods::Role::ours;
  return i;
}

speed::Record answer(const std::string& method, std::uint64_t question, speed::PoseClass c, double us) {
  speed::Record r;
  r.set = "set";
  r.method = method;
  r.question = question;
  r.pose_class = c;
  r.all.hot_us = r.first.hot_us = us;
  r.all.cold_us = r.first.cold_us = 2 * us;
  return r;
}

speed::DataSet made_up_set(int questions) {
  speed::DataSet set;
  set.name = "set";
  for (int i = 0; i < questions; ++i) set.questions.push_back({speed::PoseClass::deep, 0, 0, {}, {}, {}});
  return set;
}

}  // namespace

TEST_CASE("quantiles are observed values, means of ratios are geometric") {
  CHECK(speed::quantile({5, 1, 4, 2, 3}, 0.5) == 3);
  CHECK(speed::quantile({5, 1, 4, 2, 3}, 0.95) == 5);
  CHECK(speed::quantile({1, 2}, 0.5) == 1);
  CHECK(speed::quantile({}, 0.5) == 0);
  CHECK(speed::geometric_mean({2, 8}) == doctest::Approx(4));
}

TEST_CASE("a data set contains poses of its classes, and is read back unchanged") {
  const Folder folder;
  const speed::DataSet set = speed::make_data_set(small_pair(), few(), folder.path.string());
  REQUIRE(set.questions.size() == 4 * 4 + 1);
  for (const speed::Question& q : set.questions)
    CHECK(q.expected.empty() == (q.pose_class == speed::PoseClass::apart));
  CHECK(set.bodies.size() == 3);
  const speed::DataSet again = speed::read_data_set(folder / "spheres.set.json");
  REQUIRE(again.questions.size() == set.questions.size());
  for (std::size_t i = 0; i < set.questions.size(); ++i) {
    CHECK(again.questions[i].pose_b.r == set.questions[i].pose_b.r);
    CHECK(again.questions[i].pose_b.t == set.questions[i].pose_b.t);
    CHECK(again.questions[i].expected == set.questions[i].expected);
    CHECK(again.questions[i].pose_class == set.questions[i].pose_class);
  }
  // Made again only if asked for something else.
  const std::string before = slurp(folder / "spheres.set.json");
  speed::make_data_set(small_pair(), few(), folder.path.string());
  CHECK(slurp(folder / "spheres.set.json") == before);
  speed::SetOptions other = few();
  other.seed = 2;
  speed::make_data_set(small_pair(), other, folder.path.string());
  CHECK(slurp(folder / "spheres.set.json") != before);
  folder.write("spheres.set.json", "{}");
  CHECK_THROWS_AS(speed::read_data_set(folder / "spheres.set.json"), InputError);
}

TEST_CASE("records are read back from their lines, and a partial line is skipped") {
  speed::Record r = answer("spheres", 3, speed::PoseClass::small, 1.5);
  r.setting = 4;
  r.round = 2;
  r.errors.emplace();
  (*r.errors)[static_cast<std::size_t>(speed::Metric::hausdorff)] = 0.1;
  (*r.errors)[static_cast<std::size_t>(speed::Metric::contact)] = 0;
  r.all.missed = 7;
  r.build_seconds = 0.25;
  const speed::Record same = speed::record_from(nlohmann::json::parse(to_json(r).dump()));
  CHECK(to_json(same).dump() == to_json(r).dump());
  CHECK(speed::name_of(same) == "spheres 4");
  CHECK(same.errors == r.errors);
  CHECK(same.round == 2);
  r.outcome = speed::Outcome::crashed;
  r.message = "died";
  CHECK(speed::record_from(to_json(r)).outcome == speed::Outcome::crashed);
  const Folder folder;
  const std::string line = to_json(r).dump();
  const std::string file = folder.write("records.jsonl", line + "\n" + line.substr(0, line.size() / 2));
  CHECK(speed::read_records(file).size() == 1);
  CHECK(speed::read_records(folder / "none.jsonl").empty());
  CHECK_THROWS_AS(speed::record_from(nlohmann::json::parse("{}")), InputError);
}

TEST_CASE("ratios are medians over questions; faster engines are named") {
  std::vector<speed::Record> records;
  for (std::uint64_t q = 0; q < 3; ++q) {
    records.push_back(answer("ours", q, speed::PoseClass::deep, 10));
    records.push_back(answer("slow", q, speed::PoseClass::deep, q == 0 ? 1 : 70));
    records.push_back(answer("fast", q, speed::PoseClass::deep, 5));
  }
  speed::Record dead = answer("dead", 0, speed::PoseClass::deep, 0);
  dead.outcome = speed::Outcome::crashed;
  records.push_back(dead);
  const speed::PeerTable t =
      speed::peer_table({made_up_set(3)}, {info("ours"), info("slow"), info("fast"), info("dead")}, records);
  CHECK(t.find("set", "slow", speed::PoseClass::deep, Mode::all_pairs)->ratio == 7);
  CHECK(t.find("set", "fast", speed::PoseClass::deep, Mode::all_pairs)->ratio == 0.5);
  CHECK(t.find("set", "dead", speed::PoseClass::deep, Mode::all_pairs)->crashed == 1);
  const std::string text = speed::in_brief(t);
  CHECK(text.find("set, deep, 10 %, all pairs: fast 2.00x") != std::string::npos);
  CHECK(text.find("slow 0") == std::string::npos);
  CHECK(text.find("crash") != std::string::npos);
}

namespace {

/// A data set with its errors, as workers judge the answers of methods.
struct Judged {
  Folder folder;
  speed::DataSet set = speed::make_data_set(small_pair(), few(), folder.path.string());
  std::vector<LrbRep> bodies;

  Judged() {
    for (const speed::BodyFile& b : set.bodies) bodies.push_back(load_lrb(folder / b.file));
  }
  /// Returns the record of a method that lists these pairs.
  speed::Record record(const methods::MethodInfo& m, std::uint64_t q, double us,
                       const std::vector<SimplexPair>& pairs) const {
    const speed::Question& question = set.questions[q];
    speed::Record r = answer(m.name, q, question.pose_class, us);
    r.set = set.name;
    methods::Answer said;
    said.pairs = pairs;
    said.contact = !pairs.empty();
    r.all.contact = said.contact;
    r.errors = speed::errors_of_answer(set, question, bodies[question.a], bodies[question.b], m, said);
    return r;
  }
};

}  // namespace

TEST_CASE("points: failures score worst, and the Pareto frontier contains the undominated points") {
  const Judged judged;
  const speed::DataSet& set = judged.set;
  std::vector<methods::MethodInfo> infos = {info("right"), info("blind"), info("dead"), info("slow"),
                                            info("told")};
  infos.back().traits.set(methods::Trait::knows_poses_in_advance);
  std::vector<speed::Record> records;
  for (std::uint64_t q = 0; q < set.questions.size(); ++q)
    for (const methods::MethodInfo& m : infos) {
      const double us = m.name == "slow" ? 9 : m.name == "blind" ? 1 : m.name == "told" ? 0.5 : 2;
      speed::Record r =
          judged.record(m, q, us, m.name == "blind" ? std::vector<SimplexPair>{} : set.questions[q].expected);
      if (m.name == "right" || (m.name == "slow" && q > 0)) r.all.error_bound = 0.25 * set.diagonal;
      if (m.name == "dead") r.outcome = speed::Outcome::timed_out;
      records.push_back(r);
    }
  std::size_t seen = 0;
  const speed::PoseClass first_class = set.questions[0].pose_class;
  for (const speed::Point& p : speed::measure_points({set}, infos, records)) {
    const bool meets = p.pose_class != speed::PoseClass::apart;
    CHECK(p.proven_deviation.has_value() ==
          (p.method == "right" || (p.method == "slow" && p.pose_class != first_class)));
    if (p.method == "told") {  // it knew more
      CHECK_FALSE(p.frontier);
      CHECK(p.left_out == "knows earlier poses");
    }
    if (p.method == "right") {
      CHECK(*p.proven_deviation == doctest::Approx(0.25));
      CHECK(p.error() == 0);
      CHECK(p.frontier == meets);  // apart, to see nothing is as right, and faster
    }
    if (p.method == "slow") CHECK_FALSE(p.frontier);
    if (p.method == "blind") {  // a point only where it is right
      CHECK(p.error() == (meets ? 1 : 0));
      CHECK(p.always_wrong == meets);
      CHECK(p.frontier == !meets);
      CHECK(p.left_out == (meets ? "wrong in every case" : ""));
    }
    if (p.method == "dead") {
      CHECK(p.error() == 1);
      CHECK(p.failed() == p.questions);
      CHECK(*p.errors[static_cast<std::size_t>(speed::Metric::recall)] == 1);
      CHECK_FALSE(p.frontier);
      CHECK(p.left_out == "no answer");
    }
    ++seen;
  }
  CHECK(seen == 5 * speed::classes_of(speed::Quantity::pairs).size());
}

TEST_CASE("a frontier needs times that differ by more than their rounds; others are too close to call") {
  speed::DataSet set = made_up_set(2);
  // Two of equal error whose rounds overlap, one that is faster than either in every round but less accurate,
  // and one slower than all.
  const std::vector<std::pair<const char*, std::vector<double>>> methods = {{"ours", {10, 10.4, 9.9}},
                                                                            {"twin", {10.2, 9.8, 10.1}},
                                                                            {"coarse", {5, 5.2, 6}},
                                                                            {"late", {11, 12, 10.5}}};
  const auto points_of = [&](double factor) {
    std::vector<speed::Record> records;
    std::vector<methods::MethodInfo> infos;
    for (const auto& [name, rounds] : methods) {
      infos.push_back(info(name));
      for (std::uint64_t round = 0; round < rounds.size(); ++round)
        for (std::uint64_t q = 0; q < 2; ++q) {
          speed::Record r = answer(name, q, speed::PoseClass::deep, factor * rounds[round]);
          r.round = round;
          if (round == 0) {
            r.errors.emplace();
            (*r.errors)[static_cast<std::size_t>(Metric::hausdorff)] =
                std::string(name) == "coarse" ? 0.1 : 0;
          }
          records.push_back(r);
        }
    }
    std::map<std::string, speed::Point> out;
    for (const speed::Point& p : speed::measure_points({set}, infos, records)) out[p.method] = p;
    return out;
  };
  auto points = points_of(1);
  CHECK(points["ours"].median == 10);
  CHECK(points["ours"].least == 9.9);
  CHECK(points["ours"].most == 10.4);
  CHECK(points["ours"].cold == 20);
  CHECK(points["ours"].rounds == 3);
  CHECK_FALSE(points["ours"].frontier);
  CHECK((points["ours"].ties == std::vector<std::string>{"twin"}));
  CHECK((points["twin"].ties == std::vector<std::string>{"ours"}));
  CHECK(points["coarse"].frontier);
  CHECK_FALSE(points["late"].frontier);
  CHECK(points["late"].ties.empty());
  points = points_of(3);  // under load, which slows all alike
  CHECK(points["coarse"].frontier);
  CHECK((points["twin"].ties == std::vector<std::string>{"ours"}));
  CHECK(speed::to_lines({points["ours"]}).find("\"too_close_to\":[\"twin\"]") != std::string::npos);
}

TEST_CASE("numbers are judged by their error, in diagonals or fractions of the motion") {
  const auto error = [](Quantity quantity, double known, const speed::Record& r) {
    speed::DataSet set;
    set.name = r.set;
    set.quantity = quantity;
    set.diagonal = 2;
    set.questions.resize(1);
    set.questions[0].number = {known, known};
    return speed::measure_points({set}, {info("some")}, {r}).at(0);
  };
  const auto said = [](double lower, double upper) {
    speed::Record r = answer("some", 0, speed::PoseClass::apart, 3);
    r.all.lower = lower;
    r.all.upper = upper;
    if (upper > lower) r.all.error_bound = upper - lower;
    return r;
  };
  CHECK(error(Quantity::distance, 1, said(1, 1)).error() == 0);
  CHECK(error(Quantity::distance, 1, said(0.5, 1.5)).error() == 0.25);
  CHECK(*error(Quantity::distance, 1, said(0.5, 1.5)).proven_deviation == 0.5);
  CHECK_FALSE(error(Quantity::distance, 1, said(0.5, 0.5)).proven_deviation);
  CHECK(error(Quantity::distance, 1, said(0, 1e300)).error() == 1);
  CHECK(error(Quantity::first_contact, 0.5, said(0.25, 0.25)).error() == 0.25);
  CHECK(error(Quantity::first_contact, 0.5, said(2, 2)).error() == 1);
  CHECK(error(Quantity::first_contact, 2, said(0.9, 0.9)).error() == 1);
  CHECK(error(Quantity::first_contact, 2, said(2, 2)).error() == 0);
  speed::Record dead = said(1, 1);
  dead.outcome = speed::Outcome::crashed;
  CHECK(error(Quantity::depth, 1, dead).error() == 1);
  const speed::Point p = error(Quantity::depth, 1, said(1, 1));
  CHECK(p.frontier);
  CHECK(p.errors[static_cast<std::size_t>(Metric::penetration)].has_value());
}

TEST_CASE("errors of near pairs: missing and extra pairs, and the largest error of a distance") {
  // The nearest corners of two boxes are 5 apart: (3, 4, 0).
  const LrbRep a = build_lrb(shapes::box()), b = methods::at_pose(a, Pose::translation({4, 5, 0.5}));
  speed::DataSet set;
  set.quantity = Quantity::near_pairs;
  set.diagonal = 10;
  speed::Question q;
  q.expected = speed::exact_pairs(a, Pose{}, b, Pose{}, 5);
  REQUIRE(q.expected.size() > 2);
  CHECK(speed::exact_pairs(a, Pose{}, b, Pose{}, std::nextafter(5, 0)).empty());
  const auto error = [&](std::vector<SimplexPair> pairs, double distance, Metric m) {
    std::sort(pairs.begin(), pairs.end());
    methods::Answer found;
    found.distances.assign(pairs.size(), distance);
    found.pairs = std::move(pairs);
    return speed::errors_of_answer(set, q, a, b, info("near"), found)[static_cast<std::size_t>(m)];
  };
  CHECK(*error(q.expected, 5, Metric::list) == 0);
  CHECK(*error(q.expected, 5, Metric::distance) == 0);
  CHECK(*error(q.expected, 5.5, Metric::distance) == doctest::Approx(0.05));
  CHECK(*error(q.expected, 4.5, Metric::distance) == doctest::Approx(0.05));
  std::vector<SimplexPair> some(q.expected.begin() + 1, q.expected.end());
  const auto n = static_cast<double>(q.expected.size());
  CHECK(*error(some, 5, Metric::list) == doctest::Approx(1 / n));
  CHECK(*error(some, 5, Metric::recall) == doctest::Approx(1 / n));
  CHECK(*error(some, 5, Metric::precision) == 0);
  std::vector<SimplexPair> more = q.expected;
  for (SimplexId s = 0; more.size() == q.expected.size(); ++s)
    if (const SimplexPair p{s, SimplexId(0)}; std::find(more.begin(), more.end(), p) == more.end())
      more.push_back(p);
  CHECK(*error(more, 5, Metric::list) == doctest::Approx(1 / (n + 1)));
  CHECK(*error(more, 5, Metric::precision) == doctest::Approx(1 / (n + 1)));
  CHECK(*error({}, 5, Metric::list) == 1);
}

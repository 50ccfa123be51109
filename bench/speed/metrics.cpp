#include "bench/speed/metrics.hpp"

#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <tuple>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pair_distance.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::speed {
namespace {

/// The number of points between which distances are measured: enough for three digits, few enough to compare
/// all pairs.
constexpr std::size_t kMaxPoints = 1500;

std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() <= kMaxPoints) return points;
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < kMaxPoints; ++i) out.push_back(points[i * points.size() / kMaxPoints]);
  return out;
}

/// Returns the maximum distance of a point of `from` to its closest point in `to`.
double directed(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  double worst = 0;
  for (const Eigen::Vector3d& p : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& q : to) nearest = std::min(nearest, (p - q).squaredNorm());
    worst = std::max(worst, nearest);
  }
  return std::sqrt(worst);
}

double relative(double a, double b) {
  const double largest = std::max(std::abs(a), std::abs(b));
  return largest > 0 ? std::abs(a - b) / largest : 0;
}

double angle_share(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (a.isZero(0) && b.isZero(0)) return 0;
  if (a.isZero(0) || b.isZero(0)) return 1;
  constexpr double kHalfTurn = 3.141592653589793;
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kHalfTurn;
}

Eigen::Vector3d centroid_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum(0, 0, 0);
  for (const Eigen::Vector3d& p : points) sum += p;
  return points.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(points.size()));
}

}  // namespace

Region region_of(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                 const std::vector<SimplexPair>& pairs) {
  CollideResult result;
  CollideRequest request;
  request.contacts = true;
  Region out;
  for (const SimplexPair& p : pairs) {
    const WorldTriangle s(a, pose_a, p.a), t(b, pose_b, p.b);
    const exact::Meet meet = exact::meet_triangles(s.corners().data(), t.corners().data());
    if (meet != exact::Meet::disjoint) {
      result.pairs.push_back(p);
      result.meets.push_back(meet);
      continue;
    }
    Eigen::Vector3d sum(0, 0, 0);
    for (int k = 0; k < 3; ++k) sum += s.x[k] + t.x[k];
    out.points.push_back(sum / 6);
  }
  Workspace workspace;
  describe_contact(a, pose_a, b, pose_b, request, workspace, result).value();
  double largest = -1;
  for (const exact::PairContact& c : result.contacts)
    for (std::uint8_t i = 0; i < c.corner_count; ++i) out.points.push_back(c.corners[i].x);
  for (const ContactRegion& r : result.regions) {
    out.length += r.length;
    out.area += r.area;
    out.depth = std::max(out.depth, r.depth_estimate);
    if (r.length + r.area > largest) out.normal = r.normal;
    largest = std::max(largest, r.length + r.area);
  }
  out.centroid = centroid_of(out.points);
  out.points = thinned(out.points);
  return out;
}

double deviation(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                 const std::vector<Eigen::Vector3d>& points) {
  if (!std::all_of(points.begin(), points.end(), [](const Eigen::Vector3d& x) { return x.allFinite(); }))
    return std::numeric_limits<double>::infinity();
  const PointDistanceRequest request{.relative_tolerance = 1e-6, .side = false};
  const std::vector<PointDistance> to_a = point_distances(a, pose_a, points, request, 1),
                                   to_b = point_distances(b, pose_b, points, request, 1);
  double most = 0;
  for (std::size_t i = 0; i < points.size(); ++i) most = std::max(most, to_a[i].upper + to_b[i].upper);
  return most;
}

Region of_points(const std::vector<Eigen::Vector3d>& points) {
  Region out;
  out.points = thinned(points);
  out.centroid = centroid_of(points);
  return out;
}

RegionError region_error(const Region& exact, const Region& found, double diagonal) {
  if (exact.points.empty() && found.points.empty()) return {};
  if (exact.points.empty() || found.points.empty()) return {1, 1, 1, 1, 1, 1};
  RegionError e;
  const double far = std::max(directed(exact.points, found.points), directed(found.points, exact.points));
  e.hausdorff = std::min(1.0, far / diagonal);
  e.centroid = std::min(1.0, (exact.centroid - found.centroid).norm() / diagonal);
  e.length = relative(exact.length, found.length);
  e.area = relative(exact.area, found.area);
  e.normal = angle_share(exact.normal, found.normal);
  e.depth = std::min(1.0, std::abs(exact.depth - found.depth) / diagonal);
  return e;
}

namespace {

/// Metrics of other quantities than intersecting pairs.
constexpr Metric kOfNumbers[] = {Metric::distance, Metric::time_of_impact, Metric::penetration, Metric::list};

std::optional<double>& at(Errors& e, Metric m) {
  return e[static_cast<std::size_t>(m)];
}

bool lists_pairs(const methods::MethodInfo& m) {
  return m.pairs;
}
bool gives_points(const methods::MethodInfo& m) {
  return m.has(methods::Trait::approximate) || m.has(methods::Trait::convex);
}

bool is_of_number(Metric m) {
  return std::find(std::begin(kOfNumbers), std::end(kOfNumbers), m) != std::end(kOfNumbers);
}

/// Returns true if a method that is compared on pairs provides the data for a metric.
bool applies(const methods::MethodInfo& info, Metric m) {
  if (is_of_number(m)) return false;
  if (m == Metric::contact) return true;
  if (m == Metric::hausdorff || m == Metric::deviation || m == Metric::centroid)
    return lists_pairs(info) || gives_points(info);
  return lists_pairs(info);
}

Errors worst_of(const methods::MethodInfo& info) {
  Errors e;
  for (const MetricInfo& m : kMetricInfos)
    if (applies(info, m.metric)) at(e, m.metric) = m.worst;
  return e;
}

std::size_t without(const std::vector<SimplexPair>& of, const std::vector<SimplexPair>& others) {
  return methods::without(of, others).size();
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Returns the unit of errors of a number.
double unit_of(const DataSet& set) {
  return set.quantity == Quantity::first_contact ? 1 : set.diagonal;
}

/// Returns the metric that the chart shows for a quantity.
Metric chart_metric(Quantity quantity) {
  switch (quantity) {
    case Quantity::distance:
      return Metric::distance;
    case Quantity::first_contact:
      return Metric::time_of_impact;
    case Quantity::depth:
      return Metric::penetration;
    case Quantity::near_pairs:
      return Metric::list;
    case Quantity::pairs:
    case Quantity::self_intersections:  // not measured
      break;
  }
  return Metric::hausdorff;
}

/// Judges a number. For an interval its upper end is used: there is a pair of points at that distance, the
/// bodies are in contact at that time, or a translation of that length separates them.
Errors errors_of_number(const DataSet& set, const Question& q, const Record& r) {
  const Metric metric = chart_metric(set.quantity);
  Errors e;
  at(e, metric) = metric_info(metric).worst;
  if (r.outcome != Outcome::answered || !r.all.upper || !q.number) return e;
  const double x = *r.all.upper;
  const bool is_time = set.quantity == Quantity::first_contact;
  if (is_time && (x >= methods::kNever) != (q.number->least >= methods::kNever)) return e;
  const double offset = std::max({0.0, q.number->least - x, x - q.number->most}) / unit_of(set);
  at(e, metric) = std::min(metric_info(metric).worst, offset);
  return e;
}

/// Judges the answer to one query with all pairs.
class Judge {
 public:
  Judge(const DataSet& set, const Question& q, const LrbRep& a, const LrbRep& b)
      : diagonal_(set.diagonal), q_(q), a_(a), b_(b) {}

  Errors errors(const methods::MethodInfo& info, const methods::Answer& answer) const {
    Errors e;
    at(e, Metric::contact) = answer.contact == q_.expected.empty() ? metric_info(Metric::contact).worst : 0;
    if (lists_pairs(info)) {
      at(e, Metric::precision) = share(without(answer.pairs, q_.expected), answer.pairs.size());
      at(e, Metric::recall) = share(without(q_.expected, answer.pairs), q_.expected.size());
      if (answer.pairs == q_.expected)
        set_region(e, info, {}, 0);
      else
        set_region(e, info, region_of(answer.pairs));
    } else if (gives_points(info)) {
      set_region(e, info, of_points(answer.points));
    }
    return e;
  }

 private:
  Region region_of(const std::vector<SimplexPair>& pairs) const {
    return speed::region_of(a_, q_.pose_a, b_, q_.pose_b, pairs);
  }

  void set_region(Errors& e, const methods::MethodInfo& info, const Region& found) const {
    set_region(e, info, region_error(region_of(q_.expected), found, diagonal_),
               std::min(1.0, deviation(a_, q_.pose_a, b_, q_.pose_b, found.points) / diagonal_));
  }

  static void set_region(Errors& e, const methods::MethodInfo& info, const RegionError& r, double offset) {
    const std::pair<Metric, double> values[] = {{Metric::hausdorff, r.hausdorff}, {Metric::deviation, offset},
                                                {Metric::length, r.length},       {Metric::area, r.area},
                                                {Metric::centroid, r.centroid},   {Metric::normal, r.normal},
                                                {Metric::depth, r.depth}};
    for (const auto& [m, value] : values)
      if (applies(info, m)) at(e, m) = value;
  }

  double diagonal_;
  const Question& q_;
  const LrbRep &a_, &b_;
};

/// Data collected for a point.
struct Gathered {
  Point point;
  std::map<std::uint64_t, std::array<std::vector<double>, 2>> us;  ///< by round: warm and cold
  bool any_right = false;  ///< an answer has less than the worst error
  Errors sums;
  std::optional<double> proved_sum = 0;  ///< nullopt as soon as an answer has no proof
  double worst = -1;
};

/// Adds the times of an answer.
void add_times(Gathered& g, const Record& r) {
  if (r.outcome != Outcome::answered) return;
  auto& [warm, cold] = g.us[r.round];
  warm.push_back(r.all.hot_us);
  cold.push_back(r.all.cold_us);
}

/// Adds an answer of round 0.
void add(Gathered& g, const Record& r, const Errors& e, double unit) {
  Point& p = g.point;
  ++p.questions;
  p.rejected += r.outcome == Outcome::rejected;
  p.crashed += r.outcome == Outcome::crashed;
  p.timed_out += r.outcome == Outcome::timed_out;
  for (std::size_t m = 0; m < kMetrics; ++m)
    if (e[m]) g.sums[m] = g.sums[m].value_or(0) + *e[m];
  Point one;
  one.errors = e;
  g.any_right |= one.error() < 1;  // the worst of every error on a chart's axis
  if (one.error() > g.worst) {
    g.worst = one.error();
    p.worst_question = r.question;
  }
  if (r.outcome != Outcome::answered || !r.all.error_bound || !g.proved_sum)
    g.proved_sum.reset();
  else
    *g.proved_sum += std::min(1.0, *r.all.error_bound / unit);
  if (r.outcome != Outcome::answered) return;
  p.build_seconds = std::max(p.build_seconds, r.build_seconds);
  p.bytes = std::max(p.bytes, r.bytes);
  p.face_tests += static_cast<double>(r.all.face_tests);
}

/// Sets a time and its span from the medians of rounds.
void set_span(const std::vector<double>& rounds, double& time, double& least, double& most) {
  if (rounds.empty()) return;
  time = median(rounds);
  least = *std::min_element(rounds.begin(), rounds.end());
  most = *std::max_element(rounds.begin(), rounds.end());
}

Point finished(Gathered g) {
  Point& p = g.point;
  const auto n = static_cast<double>(p.questions);
  for (std::size_t m = 0; m < kMetrics; ++m)
    if (g.sums[m]) p.errors[m] = *g.sums[m] / n;
  if (g.proved_sum) p.proven_deviation = *g.proved_sum / n;
  const std::size_t answered = p.questions - p.failed();
  std::vector<double> warm, cold, all;
  for (const auto& [round, us] : g.us) {
    if (us[0].size() < answered) continue;  // a round that is not complete has another median
    warm.push_back(median(us[0]));
    cold.push_back(median(us[1]));
    all.insert(all.end(), us[0].begin(), us[0].end());
  }
  p.rounds = warm.size();
  set_span(warm, p.median, p.least, p.most);
  set_span(cold, p.cold, p.cold_least, p.cold_most);
  p.p95 = quantile(all, 0.95);
  p.p99 = quantile(all, 0.99);
  p.always_wrong = !g.any_right;
  if (answered > 0) p.face_tests /= static_cast<double>(answered);
  return p;
}

/// Returns why a point cannot be on a frontier, or an empty string if it can.
std::string why_left_out(const Point& p, const std::vector<methods::MethodInfo>& methods) {
  if (!(p.median > 0)) return "no answer";
  if (p.always_wrong) return "wrong in every case";
  if (p.says_only_yes_or_no()) return "answers only yes or no";
  const bool knew = std::any_of(methods.begin(), methods.end(), [&](const methods::MethodInfo& m) {
    return m.name == p.method && m.has(methods::Trait::knows_poses_in_advance);
  });
  return knew ? "knows earlier poses" : "";
}

/// True if every round of one was faster than every round of the other.
bool is_faster(const Point& p, const Point& other) {
  return p.most < other.least;
}

}  // namespace

void mark_frontiers(std::vector<Point>& points, const std::vector<methods::MethodInfo>& methods) {
  for (Point& p : points) p.left_out = why_left_out(p, methods);
  for (Point& p : points) {
    if (!p.left_out.empty()) continue;
    bool is_beaten = false;
    for (const Point& other : points) {
      if (&other == &p || other.set != p.set || other.pose_class != p.pose_class || !other.left_out.empty())
        continue;
      if (other.error() > p.error() || is_faster(p, other)) continue;
      if (is_faster(other, p))
        is_beaten = true;
      else
        p.ties.push_back(name_of(other.method, other.setting));
    }
    if (is_beaten) p.ties.clear();
    p.frontier = !is_beaten && p.ties.empty();
  }
}

double Point::error() const {
  if (const auto& list = errors[static_cast<std::size_t>(Metric::list)])
    return std::max(*list, errors[static_cast<std::size_t>(Metric::distance)].value_or(0));
  for (const Metric m :
       {Metric::hausdorff, Metric::distance, Metric::time_of_impact, Metric::penetration, Metric::contact})
    if (const auto& e = errors[static_cast<std::size_t>(m)]) return *e;
  return metric_info(Metric::contact).worst;
}

bool Point::says_only_yes_or_no() const {
  const auto has = [&](Metric m) { return errors[static_cast<std::size_t>(m)].has_value(); };
  return !has(Metric::hausdorff) && std::none_of(std::begin(kOfNumbers), std::end(kOfNumbers), has);
}

namespace {

using RecordsByQuestion = std::map<std::pair<std::string, std::uint64_t>, std::vector<const Record*>>;

/// Returns the errors of a record, or nullopt if it was not judged.
std::optional<Errors> errors_of(const DataSet& set, const Question& q, const methods::MethodInfo& info,
                                const Record& r) {
  if (!methods::is_list(set.quantity)) return errors_of_number(set, q, r);
  if (r.outcome == Outcome::answered) return r.errors;
  if (set.quantity == Quantity::pairs) return worst_of(info);
  Errors e;
  at(e, Metric::list) = metric_info(Metric::list).worst;
  return e;
}

/// Adds a data set's points.
void add_points(const DataSet& set, const std::vector<methods::MethodInfo>& methods,
                const RecordsByQuestion& by_question, std::vector<Point>& points) {
  std::map<std::tuple<PoseClass, std::string, std::optional<double>>, Gathered> gathered;
  for (std::uint64_t k = 0; k < set.questions.size(); ++k) {
    const Question& q = set.questions[k];
    const auto records = by_question.find({set.name, k});
    if (records == by_question.end()) continue;
    for (const Record* r : records->second) {
      const auto info = std::find_if(methods.begin(), methods.end(),
                                     [&](const methods::MethodInfo& m) { return m.name == r->method; });
      if (info == methods.end()) continue;
      const std::optional<Errors> errors = errors_of(set, q, *info, *r);
      if (r->round == 0 && !errors) continue;
      Gathered& g = gathered[{q.pose_class, r->method, r->setting}];
      g.point.set = set.name;
      g.point.method = r->method;
      g.point.setting = r->setting;
      g.point.pose_class = q.pose_class;
      if (r->round == 0) add(g, *r, *errors, unit_of(set));
      add_times(g, *r);
    }
  }
  for (auto& [key, g] : gathered) points.push_back(finished(std::move(g)));
}

}  // namespace

Errors errors_of_answer(const DataSet& set, const Question& question, const LrbRep& a, const LrbRep& b,
                        const methods::MethodInfo& info, const methods::Answer& answer) {
  if (set.quantity == Quantity::pairs) return Judge(set, question, a, b).errors(info, answer);
  const std::vector<SimplexPair>& pairs = answer.pairs;
  const std::vector<double>& distances = answer.distances;
  Errors e;
  const std::size_t extra = without(pairs, question.expected), missed = without(question.expected, pairs);
  at(e, Metric::precision) = share(extra, pairs.size());
  at(e, Metric::recall) = share(missed, question.expected.size());
  at(e, Metric::list) = share(extra + missed, question.expected.size() + extra);
  if (distances.size() != pairs.size()) return e;
  double worst = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const WorldTriangle s(a, Pose{}, pairs[i].a), t(b, Pose{}, pairs[i].b);
    double least = 0, most = 0;
    if (exact::meet_triangles(s.corners().data(), t.corners().data()) == exact::Meet::disjoint) {
      const exact::PairDistance exact =
          exact::distance_of_simplices(s.corners().data(), t.corners().data(), 3);
      least = exact.lower;
      most = exact.upper;
    }
    worst = std::max({worst, least - distances[i], distances[i] - most});
  }
  // Rounding to doubles is no error: otherwise, the frontier would contain slower methods that round better.
  constexpr double kRounding = 1e-14;
  const double error = worst / set.diagonal;
  at(e, Metric::distance) = error < kRounding ? 0 : std::min(metric_info(Metric::distance).worst, error);
  return e;
}

std::vector<Point> measure_points(const std::vector<DataSet>& sets,
                                  const std::vector<methods::MethodInfo>& methods,
                                  const std::vector<Record>& records) {
  RecordsByQuestion by_question;
  for (const Record& r : records) by_question[{r.set, r.question}].push_back(&r);
  std::vector<Point> points;
  for (const DataSet& set : sets) add_points(set, methods, by_question, points);
  mark_frontiers(points, methods);
  return points;
}

std::string to_lines(const std::vector<Point>& points) {
  std::string out;
  for (const Point& p : points) {
    nlohmann::ordered_json value = {{"set", p.set}, {"class", name_of(p.pose_class)}, {"method", p.method}};
    if (p.setting) value["setting"] = *p.setting;
    value["questions"] = p.questions;
    value["refused"] = p.rejected;
    value["crashed"] = p.crashed;
    value["timed_out"] = p.timed_out;
    for (const MetricInfo& info : kMetricInfos)
      if (const auto& e = p.errors[static_cast<std::size_t>(info.metric)]) value["errors"][info.name] = *e;
    if (p.proven_deviation) value["proved_off"] = *p.proven_deviation;
    value["rounds"] = p.rounds;
    value["us"] = {
        {"median", p.median}, {"least", p.least}, {"most", p.most}, {"p95", p.p95}, {"p99", p.p99}};
    value["cold_us"] = {{"median", p.cold}, {"least", p.cold_least}, {"most", p.cold_most}};
    value["build_s"] = p.build_seconds;
    value["bytes"] = p.bytes;
    value["face_tests"] = p.face_tests;
    value["frontier"] = p.frontier;
    if (!p.ties.empty()) value["too_close_to"] = p.ties;
    if (!p.left_out.empty()) value["left_out"] = p.left_out;
    value["worst_question"] = p.worst_question;
    out += value.dump() + "\n";
  }
  return out;
}

}  // namespace lrb::speed

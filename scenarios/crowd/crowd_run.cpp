#include "scenarios/crowd/crowd_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>

#include <lrbscope/core/random.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/scene.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::crowd {
namespace {

using Clock = std::chrono::steady_clock;

class Player {
 public:
  Player(const spec::Crowd& crowd, CrowdRun& run)
      : crowd_(crowd), run_(run), workers_(run.threads), workspaces_(workers_.count()), scene_(run.threads) {
    std::vector<Body> kinds;  // the run has the LRB-reps, and outlives the player
    for (const bodies::LoadedBody& kind : run.kinds)
      kinds.push_back(Body::from(std::shared_ptr<const LrbRep>(std::shared_ptr<void>(), &kind.rep)));
    scene_.reserve(run.motion.body_count());
    for (std::uint32_t body = 0; body < run.motion.body_count(); ++body)
      keys_.push_back(scene_.add(kinds[run.motion.kind(body)]));
  }

  CrowdStep play(std::uint32_t number) {
    CrowdStep step;
    const Clock::time_point begin = Clock::now();
    move_bodies(number);
    const std::vector<BodyPair> pairs = near();
    step.broad_phase = scene_.work().broad_phase;
    const Clock::time_point swept = Clock::now();
    std::vector<PosedPair> questions;
    for (const BodyPair& p : pairs)
      questions.push_back({&run_.rep(p.i), pose(p.i), &run_.rep(p.j), pose(p.j)});
    step.queries.resize(pairs.size());
    keep_answers(pairs, step);
    const std::vector<std::size_t> order = order_by_bodies(questions);
    workers_.for_each(pairs.size(), [&](std::size_t k, unsigned thread) {
      CrowdQuery& query = step.queries[order[k]];
      query.bodies = pairs[order[k]];
      if (!query.is_kept) ask(questions[order[k]], workspaces_[thread], query);
    });
    step.broad_phase_ns = nanoseconds(swept - begin);
    step.queries_ns = nanoseconds(Clock::now() - swept);
    return step;
  }

 private:
  static std::uint64_t nanoseconds(Clock::duration d) {
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(d).count());
  }

  void move_bodies(std::uint32_t number) {
    moved_.assign(keys_.size(), number == 0);
    for (std::uint32_t body = 0; body < keys_.size(); ++body) {
      const Pose pose = run_.motion.pose(body, number);
      if (!trace::equal(pose, this->pose(body))) moved_[body] = true;
      if (moved_[body]) scene_.move(keys_[body], pose);
    }
  }

  /// Copies the answers of pairs of which neither body has moved from the step before. Both lists are
  /// ascending.
  void keep_answers(const std::vector<BodyPair>& pairs, CrowdStep& step) const {
    if (run_.steps.empty()) return;
    const std::vector<CrowdQuery>& before = run_.steps.back().queries;
    auto last = before.begin();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      while (last != before.end() && last->bodies < pairs[i]) ++last;
      if (last == before.end()) return;
      if (last->bodies != pairs[i] || moved_[pairs[i].i] || moved_[pairs[i].j]) continue;
      step.queries[i] = *last;
      step.queries[i].result.counters = {};
      step.queries[i].is_kept = true;
    }
  }

  /// Returns the pairs of bodies with overlapping boxes, or with boxes at most as far apart as near pairs,
  /// ascending. Keys are in the order of the bodies.
  std::vector<BodyPair> near() {
    std::vector<BodyPair> pairs;
    const auto number = [&](BodyKey key) {
      return static_cast<std::uint32_t>(std::lower_bound(keys_.begin(), keys_.end(), key) - keys_.begin());
    };
    for (const ScenePair& p : scene_.near(crowd_.more.near.value_or(0)))
      pairs.push_back({number(p.a), number(p.b)});
    if (crowd_.more.near) std::sort(pairs.begin(), pairs.end());  // they are in the order of their gaps
    return pairs;
  }

  /// Returns the current pose.
  const Pose& pose(std::uint32_t body) const { return scene_.pose(keys_[body]); }

  void ask(const PosedPair& question, Workspace& workspace, CrowdQuery& query) const {
    try {
      const CollideResult& r =
          collide(*question.a, question.pose_a, *question.b, question.pose_b, crowd_.request, workspace)
              .value();
      query.result = {r.relation, r.interiors_overlap, r.pairs.size(), fingerprint(r.pairs), r.counters};
      measure(question, workspace, query.result);
    } catch (const InputError& e) {
      throw InputError("crowd " + crowd_.name + ", " + run_.names[query.bodies.i] + " (A) and " +
                       run_.names[query.bodies.j] + " (B): " + e.what());
    }
  }

  /// Adds the distance, the clash and the near pairs, if requested.
  void measure(const PosedPair& q, Workspace& workspace, trace::StepResult& result) const {
    const spec::StepQuestions& more = crowd_.more;
    if (more.distance)
      result.distance =
          trace::measured(distance(*q.a, q.pose_a, *q.b, q.pose_b, DistanceRequest{}, workspace).value(), {});
    if (more.clash)
      result.clash =
          trace::measured(clash(*q.a, q.pose_a, *q.b, q.pose_b, *more.clash, workspace).value(), {});
    if (more.near) {
      NearPairsRequest request;
      request.within = *more.near;
      result.near = trace::measured(near_pairs(*q.a, q.pose_a, *q.b, q.pose_b, request, workspace).value(),
                                    request.within);
    }
  }

  const spec::Crowd& crowd_;
  CrowdRun& run_;
  Workers workers_;
  std::vector<Workspace> workspaces_;  ///< one for each thread
  Scene scene_;
  std::vector<BodyKey> keys_;  ///< by body, ascending
  std::vector<bool> moved_;    ///< by body, in the current step
};

}  // namespace

std::vector<std::string> body_names(const spec::Crowd& crowd) {
  std::vector<std::string> names;
  for (const spec::CrowdKind& kind : crowd.kinds)
    for (std::uint32_t i = 1; i <= kind.count; ++i) names.push_back(kind.name + " " + std::to_string(i));
  return names;
}

std::vector<bodies::LoadedBody> make_kinds(const spec::Crowd& crowd, const record::ProgressReport& progress) {
  std::vector<bodies::LoadedBody> kinds;
  for (const spec::CrowdKind& kind : crowd.kinds) {
    progress("build", kinds.size(), crowd.kinds.size());
    kinds.push_back(record::make_body(kind.body));
    if (kinds.back().rep.dim() != kinds[0].rep.dim())
      throw InputError("crowd " + crowd.name + ": " + kind.name + " is " +
                       std::to_string(kinds.back().rep.dim()) + "D and " + crowd.kinds[0].name + " is " +
                       std::to_string(kinds[0].rep.dim()) + "D; expected bodies of the same dimension");
  }
  return kinds;
}

CrowdRun run_crowd(const spec::Crowd& crowd, std::uint32_t threads, const record::ProgressReport& progress) {
  std::vector<bodies::LoadedBody> kinds = make_kinds(crowd, progress);
  CrowdMotion motion(crowd, kinds);
  CrowdRun run{std::move(kinds), body_names(crowd), std::move(motion), {}, {}, threads};
  for (std::size_t k = 0; k < run.kinds.size(); ++k)
    for (const std::string& note : run.kinds[k].notes) run.notes.push_back(crowd.kinds[k].name + ": " + note);
  Player player(crowd, run);
  for (std::uint32_t step = 0; step < crowd.steps; ++step) {
    progress("query", step, crowd.steps);
    run.steps.push_back(player.play(step));
  }
  return run;
}

namespace {

Eigen::Vector3d random_direction(Random& random, int dim) {
  if (dim == 2) {
    const double angle = random.in(0, 2 * std::numbers::pi);
    return {deterministic::cos(angle), deterministic::sin(angle), 0};
  }
  while (true) {
    const double x = random.in(-1, 1);
    const double y = random.in(-1, 1);
    const double z = random.in(-1, 1);
    const Eigen::Vector3d d(x, y, z);
    if (d.norm() > 0.1 && d.norm() <= 1) return d.normalized();
  }
}

/// Returns positions in rows over the arena, shuffled: as many as there are bodies or a few more.
std::vector<Eigen::Vector3d> grid_places(const Eigen::Vector3d& reach, std::uint32_t count, int dim,
                                         Random& random) {
  const double side = dim == 2 ? std::sqrt(count) : std::cbrt(count);
  std::uint32_t n[3] = {1, 1, 1};
  for (int i = 0; i < dim; ++i) n[i] = std::max(1U, static_cast<std::uint32_t>(std::floor(side)));
  for (int i = 0; n[0] * n[1] * n[2] < count; ++i) ++n[i % dim];
  std::vector<Eigen::Vector3d> places;
  for (std::uint32_t k = 0; k < n[0] * n[1] * n[2]; ++k) {
    const std::uint32_t at[3] = {k % n[0], k / n[0] % n[1], k / n[0] / n[1]};
    Eigen::Vector3d p(0, 0, 0);
    for (int i = 0; i < dim; ++i) p[i] = n[i] > 1 ? reach[i] * (2.0 * at[i] / (n[i] - 1) - 1) : 0;
    places.push_back(p);
  }
  for (std::size_t k = places.size(); k > 1; --k) std::swap(places[k - 1], places[random.bits() % k]);
  return places;
}

/// Returns the coordinate of a point in uniform motion that is reflected at -reach and reach.
double thrown_back(double x, double reach) {
  if (!(reach > 0)) return 0;
  double y = std::fmod(x + reach, 4 * reach);
  if (y < 0) y += 4 * reach;
  return (y > 2 * reach ? 4 * reach - y : y) - reach;
}

/// Returns the largest distance of a body's points from its origin.
double radius_of(const LrbRep& rep, const Pose& own) {
  double r = 0;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) r = std::max(r, own.apply(rep.vertices()[v]).norm());
  return r;
}

std::vector<std::uint32_t> kinds_of_bodies(const spec::Crowd& crowd) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t k = 0; k < crowd.kinds.size(); ++k) out.insert(out.end(), crowd.kinds[k].count, k);
  return out;
}

}  // namespace

CrowdMotion::CrowdMotion(const spec::Crowd& crowd, std::span<const bodies::LoadedBody> kinds)
    : kinds_(kinds_of_bodies(crowd)), given_(crowd.poses) {
  for (std::vector<Pose>& step : given_)
    for (std::size_t body = 0; body < step.size(); ++body)
      step[body] = spec::then(crowd.kinds[kinds_[body]].body.pose, step[body]);
  if (!given_.empty()) return;
  const int dim = kinds[0].rep.dim();
  Random random(crowd.seed);
  for (std::uint32_t k = 0; k < crowd.kinds.size(); ++k) {
    const Pose& own = crowd.kinds[k].body.pose;
    const double radius = radius_of(kinds[k].rep, own);
    for (std::uint32_t i = 0; i < crowd.kinds[k].count; ++i) {
      Mover m;
      m.own = own;
      m.reach = (crowd.room / 2 - Eigen::Vector3d::Constant(radius)).cwiseMax(0);
      if (dim == 2) m.reach.z() = 0;
      for (int axis = 0; axis < 3; ++axis) m.start[axis] = random.in(-m.reach[axis], m.reach[axis]);
      m.speed = random_direction(random, dim);
      m.speed *= random.in(crowd.speed[0], crowd.speed[1]);
      m.axis = dim == 2 ? Eigen::Vector3d::UnitZ().eval() : random_direction(random, dim);
      m.turned = deterministic::rotation(m.axis, random.in(0, 2 * std::numbers::pi));
      if (dim == 3) m.axis = random_direction(random, dim);
      m.spin = random.in(crowd.spin[0], crowd.spin[1]) * std::numbers::pi / 180;
      movers_.push_back(m);
    }
  }
  if (crowd.arrangement == spec::Crowd::Arrangement::random) return;
  const auto places =
      grid_places(Eigen::Vector3d::Ones(), static_cast<std::uint32_t>(movers_.size()), dim, random);
  for (std::size_t i = 0; i < movers_.size(); ++i)
    movers_[i].start = places[i].cwiseProduct(movers_[i].reach);
}

Pose CrowdMotion::pose(std::uint32_t body, std::uint32_t step) const {
  if (!given_.empty()) return given_.at(step).at(body);
  const Mover& m = movers_[body];
  Pose move;
  const Eigen::Vector3d straight = m.start + static_cast<double>(step) * m.speed;
  for (int i = 0; i < 3; ++i) move.t[i] = thrown_back(straight[i], m.reach[i]);
  move.r = deterministic::rotation(m.axis, m.spin * step) * m.turned;
  return spec::then(m.own, move);
}

}  // namespace lrb::crowd

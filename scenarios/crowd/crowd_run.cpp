#include "scenarios/crowd/crowd_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "render/pictures/panel.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/core/random.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/scene.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::crowd {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<bodies::LoadedBody> make_kinds(const spec::Crowd& crowd, const run::ProgressReport& progress) {
  std::vector<bodies::LoadedBody> kinds;
  for (const spec::CrowdKind& kind : crowd.kinds) {
    progress("build", kinds.size(), crowd.kinds.size());
    kinds.push_back(run::make_body(kind.body));
    if (kinds.back().rep.dim() != kinds[0].rep.dim())
      throw InputError("crowd " + crowd.name + ": " + kind.name + " is " +
                       std::to_string(kinds.back().rep.dim()) + "D and " + crowd.kinds[0].name + " is " +
                       std::to_string(kinds[0].rep.dim()) + "D; expected bodies of the same dimension");
  }
  return kinds;
}

std::vector<const LrbRep*> reps_of(const std::vector<bodies::LoadedBody>& kinds) {
  std::vector<const LrbRep*> out;
  for (const bodies::LoadedBody& kind : kinds) out.push_back(&kind.rep);
  return out;
}

class Player {
 public:
  Player(const spec::Crowd& crowd, CrowdRun& run)
      : crowd_(crowd),
        run_(run),
        workers_(run.threads),
        workspaces_(workers_.count()),
        scene_(run.threads),
        began_(Clock::now()) {
    std::vector<Body> kinds;  // the run has the LRB-reps, and outlives the player
    for (const bodies::LoadedBody& kind : run.kinds)
      kinds.push_back(Body::from(std::shared_ptr<const LrbRep>(std::shared_ptr<void>(), &kind.rep)));
    scene_.reserve(run.motion.body_count());
    for (std::uint32_t body = 0; body < run.motion.body_count(); ++body)
      keys_.push_back(scene_.add(kinds[run.motion.kind(body)]));
  }

  /// Runs a step; `moment` receives the data for a picture of it, unless it is null.
  CrowdStep play(std::uint32_t number, CrowdMoment* moment) {
    CrowdStep step;
    const std::uint64_t begin = now();
    move_bodies(number);
    const std::vector<BodyPair> pairs = near();
    step.broad_phase = scene_.work().broad_phase;
    const std::uint64_t swept = now();
    std::vector<PosedPair> questions;
    for (const BodyPair& p : pairs)
      questions.push_back({&run_.rep(p.i), pose(p.i), &run_.rep(p.j), pose(p.j)});
    std::vector<CollideResult> results(moment != nullptr ? pairs.size() : 0);
    step.queries.resize(pairs.size());
    keep_answers(pairs, step);
    const std::vector<std::size_t> order = order_by_bodies(questions);
    workers_.for_each(pairs.size(), [&](std::size_t k, unsigned thread) {
      const std::size_t at = order[k];
      CrowdQuery& query = step.queries[at];
      if (query.is_kept && moment == nullptr) return;
      CrowdQuery repeated;  // for the picture
      CollideResult& result = ask(pairs[at], questions[at], thread, query.is_kept ? repeated : query);
      // Otherwise its memory is reused.
      if (moment != nullptr) results[at] = std::move(result);
    });
    limit_contact_faces(number, step);
    step.begin_ns = begin;
    step.broad_phase_ns = swept - begin;
    step.queries_ns = now() - swept;
    if (moment != nullptr) remember(pairs, results, *moment);
    return step;
  }

 private:
  std::uint64_t now() const {
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - began_).count());
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
      step.queries[i].begin_ns = step.queries[i].end_ns = now();
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

  /// Returns the result in the thread's workspace.
  CollideResult& ask(const BodyPair& pair, const PosedPair& question, std::uint32_t thread,
                     CrowdQuery& query) {
    query.bodies = pair;
    query.thread = thread;
    query.begin_ns = now();
    try {
      CollideResult& r = collide(*question.a, question.pose_a, *question.b, question.pose_b, crowd_.request,
                                 workspaces_[thread])
                             .value();
      query.result = {r.relation, r.interiors_overlap, r.pairs.size(), fingerprint(r.pairs), r.counters};
      query.contact_regions = r.regions.size();
      measure(question, workspaces_[thread], query.result);
      query.end_ns = now();
      if (keeps_contact_faces_)
        for (const SimplexPair& p : r.pairs) {
          query.contact_faces[0].push_back(question.a->face_of_simplex(p.a).value());
          query.contact_faces[1].push_back(question.b->face_of_simplex(p.b).value());
        }
      for (std::vector<std::uint32_t>& faces : query.contact_faces) {
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
      }
      return r;
    } catch (const InputError& e) {
      throw InputError("crowd " + crowd_.name + ", " + run_.names[pair.i] + " (A) and " + run_.names[pair.j] +
                       " (B): " + e.what());
    }
  }

  /// Counts the faces in contact. Discards those of a step that exceeds the limit, and of all later ones.
  void limit_contact_faces(std::uint32_t number, CrowdStep& step) {
    if (!keeps_contact_faces_) return;
    for (const CrowdQuery& q : step.queries)
      contact_faces_ += q.contact_faces[0].size() + q.contact_faces[1].size();
    keeps_contact_faces_ = contact_faces_ <= kMaxContactFaces;
    if (keeps_contact_faces_)
      run_.contact_steps = number + 1;
    else
      for (CrowdQuery& q : step.queries) q.contact_faces = {};
  }

  /// Adds the distance, the clash and the near pairs, if requested.
  void measure(const PosedPair& q, Workspace& workspace, trace::StepResult& result) const {
    const spec::StepQuestions& more = crowd_.more;
    if (more.distance)
      result.distance =
          trace::measured(distance(*q.a, q.pose_a, *q.b, q.pose_b, DistanceRequest{}, workspace).value(), {});
    if (more.clash)
      result.clash =
          trace::measured(clash(*q.a, q.pose_a, *q.b, q.pose_b, ClashRequest{}, workspace).value(), {});
    if (more.near) {
      NearPairsRequest request;
      request.within = *more.near;
      result.near = trace::measured(near_pairs(*q.a, q.pose_a, *q.b, q.pose_b, request, workspace).value(),
                                    request.within);
    }
  }

  void remember(const std::vector<BodyPair>& pairs, std::vector<CollideResult>& results,
                CrowdMoment& moment) const {
    moment.opened.resize(keys_.size());
    moment.in_contact.resize(keys_.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const std::uint32_t body[2] = {pairs[k].i, pairs[k].j};
      for (const int side : {0, 1}) {
        const std::vector<RegionId>& opened = results[k].opened[static_cast<std::size_t>(side)];
        std::vector<RegionId>& all = moment.opened[body[side]];
        all.insert(all.end(), opened.begin(), opened.end());
        std::vector<std::uint8_t>& marks = moment.in_contact[body[side]];
        const LrbRep& rep = run_.rep(body[side]);
        if (!results[k].pairs.empty()) marks.resize(rep.real_face_count());
        for (const SimplexPair& p : results[k].pairs) marks[rep.face_of_simplex(side == 0 ? p.a : p.b)] = 1;
      }
      std::move(results[k].regions.begin(), results[k].regions.end(), std::back_inserter(moment.contacts));
    }
    for (std::vector<RegionId>& all : moment.opened) {
      std::sort(all.begin(), all.end());
      all.erase(std::unique(all.begin(), all.end()), all.end());
    }
  }

  const spec::Crowd& crowd_;
  CrowdRun& run_;
  Workers workers_;
  std::vector<Workspace> workspaces_;  ///< one for each thread
  Scene scene_;
  std::vector<BodyKey> keys_;  ///< by body, ascending
  std::vector<bool> moved_;    ///< by body, in the current step
  std::size_t contact_faces_ = 0;
  bool keeps_contact_faces_ = true;
  Clock::time_point began_;
};

}  // namespace

std::vector<std::string> body_names(const spec::Crowd& crowd) {
  std::vector<std::string> names;
  for (const spec::CrowdKind& kind : crowd.kinds)
    for (std::uint32_t i = 1; i <= kind.count; ++i) names.push_back(kind.name + " " + std::to_string(i));
  return names;
}

std::vector<std::uint32_t> drawn_steps(const render::FrameSpec& spec, std::uint32_t steps) {
  std::vector<std::uint32_t> all;
  if (spec.at == render::FrameSpec::At::none) return all;
  for (std::uint32_t s = 0; s < steps; ++s)
    if (s % spec.every == 0 || s + 1 == steps) all.push_back(s);
  std::vector<std::uint32_t> out;
  for (const std::size_t i : run::evenly(all.size(), spec.most)) out.push_back(all[i]);
  return out;
}

CrowdRun run_crowd(const spec::Crowd& crowd, std::uint32_t threads, const run::ProgressReport& progress) {
  std::vector<bodies::LoadedBody> kinds = make_kinds(crowd, progress);
  CrowdMotion motion(crowd, reps_of(kinds));
  return play_crowd(crowd, std::move(kinds), std::move(motion), threads, progress);
}

CrowdRun play_crowd(const spec::Crowd& crowd, std::vector<bodies::LoadedBody> kinds, CrowdMotion motion,
                    std::uint32_t threads, const run::ProgressReport& progress) {
  CrowdRun run{std::move(kinds), {}, std::move(motion), {}, {}, {}, threads, 0};
  for (std::size_t k = 0; k < run.kinds.size(); ++k)
    for (const std::string& note : run.kinds[k].notes) run.notes.push_back(crowd.kinds[k].name + ": " + note);
  run.names = body_names(crowd);
  const std::vector<std::uint32_t> drawn = drawn_steps(crowd.frames, crowd.steps);
  Player player(crowd, run);
  for (std::uint32_t step = 0; step < crowd.steps; ++step) {
    progress("query", step, crowd.steps);
    const bool is_drawn = std::binary_search(drawn.begin(), drawn.end(), step);
    CrowdMoment moment;
    moment.step = step;
    run.steps.push_back(player.play(step, is_drawn ? &moment : nullptr));
    if (is_drawn) run.moments.push_back(std::move(moment));
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

CrowdMotion::CrowdMotion(const spec::Crowd& crowd, std::vector<std::vector<Pose>> poses)
    : kinds_(kinds_of_bodies(crowd)), given_(std::move(poses)) {}

CrowdMotion::CrowdMotion(const spec::Crowd& crowd, std::span<const LrbRep* const> reps)
    : kinds_(kinds_of_bodies(crowd)), given_(crowd.poses) {
  for (std::vector<Pose>& step : given_)
    for (std::size_t body = 0; body < step.size(); ++body)
      step[body] = spec::then(crowd.kinds[kinds_[body]].body.pose, step[body]);
  if (!given_.empty()) return;
  const int dim = reps[0]->dim();
  Random random(crowd.seed);
  for (std::uint32_t k = 0; k < crowd.kinds.size(); ++k) {
    const Pose& own = crowd.kinds[k].body.pose;
    const double radius = radius_of(*reps[k], own);
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

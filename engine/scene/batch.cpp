#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/clash/clash_parts.hpp"
#include "engine/collide/collide_into.hpp"
#include "engine/collide/relation.hpp"
#include "engine/distance/manifold_points.hpp"
#include "engine/distance/near_pairs_context.hpp"
#include "engine/motion/contact_search.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb {

struct Workspace::Memory {
  explicit Memory(unsigned threads) : workers(threads) { of_collision().workers = &workers; }

  FirstContactContext context;
  NearPairsContext near;
  ManifoldContext manifold;
  Workers workers;
  // The last answers.
  CollideResult collision;
  DistanceResult distance;
  ClashResult clash;
  FirstContactResult contact;
  NearPairsResult pairs;
  ManifoldResult manifolds, earlier_manifolds;

  // One context serves all queries: each query initialises what it reads, so that only memory is reused.
  DistanceContext& of_distance() { return context.distance; }
  QueryContext& of_collision() { return context.distance.query; }
};

Workspace::Workspace(unsigned threads) : memory_(std::make_unique<Memory>(threads)) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

Expected<CollideResult&> collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                 const CollideRequest& request, Workspace& workspace,
                                 CollideProbe* probe) try {
  Workspace::Memory& memory = workspace.memory();
  // Cleared, not replaced, to reuse its memory.
  clear(memory.collision);
  collide_watched(a, pose_a, b, pose_b, request, memory.of_collision(), probe, memory.collision);
  return memory.collision;
} catch (const InputError& e) {
  return Error{e.what()};
}

Expected<CollideResult&> describe_contact(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                          const Pose& pose_b, const CollideRequest& request,
                                          Workspace& workspace, CollideResult& result) try {
  const FloatMode float_mode;
  check_query(a, pose_a, b, pose_b);
  QueryContext& context = workspace.memory().of_collision();
  context.body[0].begin(a, pose_a, request.wrapper);
  context.body[1].begin(b, pose_b, request.wrapper);
  describe_contact(context, request, result);
  return result;
} catch (const InputError& e) {
  return Error{e.what()};
}

Expected<DistanceResult&> distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                   const DistanceRequest& request, Workspace& workspace,
                                   BoundsProbe* probe) try {
  Workspace::Memory& memory = workspace.memory();
  memory.distance = distance(a, pose_a, b, pose_b, request, memory.of_distance(), nullptr, probe);
  return memory.distance;
} catch (const InputError& e) {
  return Error{e.what()};
}

Expected<NearPairsResult&> near_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                      const Pose& pose_b, const NearPairsRequest& request,
                                      Workspace& workspace) try {
  Workspace::Memory& memory = workspace.memory();
  near_pairs_into(a, pose_a, b, pose_b, request, memory.workers, memory.near, memory.pairs);
  return memory.pairs;
} catch (const InputError& e) {
  return Error{e.what()};
}

Expected<ManifoldResult&> contact_manifolds(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                            const Pose& pose_b, const ManifoldRequest& request,
                                            Workspace& workspace, const ManifoldResult* previous) try {
  Workspace::Memory& memory = workspace.memory();
  // The previous answer may be the one in the workspace: keep it until the next one is complete.
  contact_manifolds_into(a, pose_a, b, pose_b, request, previous, memory.workers, memory.of_collision(),
                         memory.near, memory.manifold, memory.earlier_manifolds);
  std::swap(memory.manifolds, memory.earlier_manifolds);
  return memory.manifolds;
} catch (const InputError& e) {
  return Error{e.what()};
}

Expected<ClashResult&> clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                             const ClashRequest& request, Workspace& workspace, ClashProbe* probe) try {
  Workspace::Memory& memory = workspace.memory();
  memory.clash = clash(a, pose_a, b, pose_b, request, memory.of_distance(), probe);
  return memory.clash;
} catch (const InputError& e) {
  return Error{e.what()};
}

Expected<FirstContactResult&> first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                            const Motion& motion_b, const FirstContactRequest& request,
                                            Workspace& workspace, FirstContactProbe* probe) try {
  Workspace::Memory& memory = workspace.memory();
  memory.contact = first_contact(a, motion_a, b, motion_b, request, memory.context, probe);
  return memory.contact;
} catch (const InputError& e) {
  return Error{e.what()};
}

namespace {

/// Ask one query of a batch, and write to `answer`, whose memory is reused.
void ask(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
         const CollideRequest& request, Workspace& workspace, Expected<CollideResult>& answer) try {
  // An earlier answer keeps the memory of its vectors.
  if (answer)
    clear(*answer);
  else
    answer = CollideResult{};
  collide_watched(a, pose_a, b, pose_b, request, workspace.memory().of_collision(), nullptr, *answer);
} catch (const InputError& e) {
  answer = Error{e.what()};
}

void ask(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
         const DistanceRequest& request, Workspace& workspace, Expected<DistanceResult>& answer) {
  const Expected<DistanceResult&> found = distance(a, pose_a, b, pose_b, request, workspace);
  if (found)
    answer = *found;
  else
    answer = found.error();
}

}  // namespace

std::vector<std::size_t> order_by_bodies(std::span<const PosedPair> pairs) {
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
    // The index breaks ties: the order does not depend on the sorting algorithm.
    const auto key = [&](std::size_t i) { return std::tuple(pairs[i].a->serial(), pairs[i].b->serial(), i); };
    return key(x) < key(y);
  });
  return order;
}

class Batch::Work {
 public:
  explicit Work(unsigned threads) : workers_(threads), workspaces_(workers_.count()) {}
  unsigned threads() const { return workers_.count(); }

  /// Each worker has its own workspace: queries share no memory and need no locks.
  template <class Request, class Answers>
  void run(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
           const Request& request, Answers& answers) {
    answers.resize(poses_b.size());
    workers_.for_each(poses_b.size(), [&](std::size_t i, unsigned worker) {
      ask(a, pose_a, b, poses_b[i], request, workspaces_[worker], answers[i]);
    });
  }

  /// The same for pairs; those of the same two bodies are processed consecutively.
  template <class Request, class Answers>
  void run(std::span<const PosedPair> pairs, const Request& request, Answers& answers) {
    // Only the order of work changes: answers are written to the index of their query.
    const std::vector<std::size_t> order = order_by_bodies(pairs);
    answers.resize(pairs.size());
    workers_.for_each(pairs.size(), [&](std::size_t k, unsigned worker) {
      const PosedPair& p = pairs[order[k]];
      ask(*p.a, p.pose_a, *p.b, p.pose_b, request, workspaces_[worker], answers[order[k]]);
    });
  }

 private:
  Workers workers_;
  std::vector<Workspace> workspaces_;  ///< (threads)
};

Batch::Batch(unsigned threads) : work_(std::make_unique<Work>(threads)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

unsigned Batch::threads() const {
  return work_->threads();
}

void Batch::collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                    const CollideRequest& request, CollideAnswers& answers) {
  work_->run(a, pose_a, b, poses_b, request, answers);
}

void Batch::collide(std::span<const PosedPair> pairs, const CollideRequest& request,
                    CollideAnswers& answers) {
  work_->run(pairs, request, answers);
}

void Batch::distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                     const DistanceRequest& request, DistanceAnswers& answers) {
  work_->run(a, pose_a, b, poses_b, request, answers);
}

void Batch::distance(std::span<const PosedPair> pairs, const DistanceRequest& request,
                     DistanceAnswers& answers) {
  work_->run(pairs, request, answers);
}

namespace {

/// Calls run(poses, answers) for one chunk of poses after the other, and visit() for its answers.
template <class Answer, class Run>
std::size_t visit_chunks(std::span<const Pose> poses, std::size_t chunk, const Batch::Visit<Answer>& visit,
                         const Run& run) {
  std::vector<Expected<Answer>> answers;
  for (std::size_t first = 0; first < poses.size(); first += answers.size()) {
    run(poses.subspan(first, std::min(std::max<std::size_t>(chunk, 1), poses.size() - first)), answers);
    for (std::size_t i = 0; i < answers.size(); ++i)
      if (!visit(first + i, answers[i])) return first + i + 1;
  }
  return poses.size();
}

}  // namespace

std::size_t Batch::collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                           std::span<const Pose> poses_b, const CollideRequest& request,
                           const Visit<CollideResult>& visit, std::size_t chunk) {
  return visit_chunks<CollideResult>(poses_b, chunk, visit, [&](std::span<const Pose> poses, auto& answers) {
    collide(a, pose_a, b, poses, request, answers);
  });
}

std::size_t Batch::distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                            std::span<const Pose> poses_b, const DistanceRequest& request,
                            const Visit<DistanceResult>& visit, std::size_t chunk) {
  return visit_chunks<DistanceResult>(poses_b, chunk, visit, [&](std::span<const Pose> poses, auto& answers) {
    distance(a, pose_a, b, poses, request, answers);
  });
}

CollideAnswers collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                       const CollideRequest& request, unsigned threads) {
  CollideAnswers answers;
  Batch(threads).collide(a, pose_a, b, poses_b, request, answers);
  return answers;
}

CollideAnswers collide(std::span<const PosedPair> pairs, const CollideRequest& request, unsigned threads) {
  CollideAnswers answers;
  Batch(threads).collide(pairs, request, answers);
  return answers;
}

DistanceAnswers distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                         const DistanceRequest& request, unsigned threads) {
  DistanceAnswers answers;
  Batch(threads).distance(a, pose_a, b, poses_b, request, answers);
  return answers;
}

DistanceAnswers distance(std::span<const PosedPair> pairs, const DistanceRequest& request, unsigned threads) {
  DistanceAnswers answers;
  Batch(threads).distance(pairs, request, answers);
  return answers;
}

}  // namespace lrb

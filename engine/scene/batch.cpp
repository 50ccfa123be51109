#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/clash/clash_parts.hpp"
#include "engine/collide/candidate_cache.hpp"
#include "engine/collide/collide_into.hpp"
#include "engine/collide/relation.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
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

/// Returns an answer without content, in the memory of an earlier one.
CollideResult& emptied(Expected<CollideResult>& answer) {
  if (answer)
    clear(*answer);
  else
    answer = CollideResult{};
  return *answer;
}

/// Asks one query of a batch, and writes to `answer`, whose memory is reused.
void ask(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
         const CollideRequest& request, Workspace& workspace, Expected<CollideResult>& answer) try {
  collide_watched(a, pose_a, b, pose_b, request, workspace.memory().of_collision(), nullptr, emptied(answer));
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

/// Returns true if one traversal of the trees, of at most `most` pairs of nodes, proves that B meets A at
/// none of several poses, those of a motion in equal steps.
///
/// From the midpoint pose to pose i, a point x of B moves by D x + d. With the half H x + h of the
/// motion from the first pose to the last, and the step s in [-1, 1] of pose i, this differs from s (H x + h)
/// by E x + e, E = D - s H, e = d - s h, which is at most |E c + e| + |E| r, where c and r are the centre and
/// the radius of B, and |E| is the Frobenius norm. The kernel allows for this sweep and the largest of these
/// deviations (aim_at()). The displacements that it allows a point are a convex set, so that every point of B
/// can move straight from one pose to any other without a contact: solids have the same relation at all of
/// them.
bool meets_at_none(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses,
                   std::uint64_t most, QueryContext& context) {
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  const FloatMode float_mode;
  const std::size_t midpoint = poses.size() / 2;  // not nearer to the first pose than to the last
  const Pose& from = poses[midpoint];
  const double half = static_cast<double>(midpoint), share = half / static_cast<double>(poses.size() - 1);
  const Matrix3d turn = share * (poses.back().r - poses.front().r);
  const Vector3d shift = share * (poses.back().t - poses.front().t);
  const TreeNode& root = b.tree().nodes()[0];
  const Vector3d centre = Vector3d(root.origin[0], root.origin[1], root.origin[2]) * b.tree().unit();
  const double radius = static_cast<double>(root.radius) * b.tree().unit(), up = 1 + kWorldRounding;
  double turned_sq = 0, moved_sq = 0, sum = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double s = (static_cast<double>(i) - half) / half;
    const Matrix3d e = poses[i].r - from.r - s * turn;
    const double moved = (e * centre + (poses[i].t - from.t - s * shift)).squaredNorm(),
                 turned = e.squaredNorm();
    if (moved > radius * radius || turned > 1) return false;  // no motion, or too long a one
    turned_sq = std::max(turned_sq, turned);
    moved_sq = std::max(moved_sq, moved);
    sum += moved + turned;  // not finite if a pose is not
  }
  const Matrix3d to_a = pose_a.r.transpose();
  Sweep sweep;
  sweep.mid_pose = {to_a * from.r, to_a * (from.t - pose_a.t)};
  sweep.dm = to_a * turn;
  sweep.dt = to_a * shift;
  sweep.turn = sweep.dm.norm() * up;
  sweep.length = (stable_norm3(sweep.dm * centre + sweep.dt) + sweep.turn * radius) * up;
  sweep.width = (std::sqrt(moved_sq) + std::sqrt(turned_sq) * radius) * stretch(pose_a) * up;
  // A bound on the terms of all world coordinates at all poses, for their rounding: see RelativeMotion.
  const double unit = query_unit(a.tree(), b.tree()), defect = rotation_defect(pose_a.r),
               size = world_size(pose_a, a.tree()) + world_size(from, b.tree()) + std::sqrt(moved_sq) +
                      stable_norm3(shift) +
                      (std::sqrt(turned_sq) + turn.norm()) * (stable_norm3(centre) + 2 * b.tree().extent());
  // Beyond these numbers squares could underflow or overflow.
  constexpr double kLeast = 0x1p-300, kMax = 0x1p300;
  if (!std::isfinite(sum) || !(size > kLeast && size < kMax) ||
      !(defect <= kRigid && sweep.mid_pose.defect <= kRigid))
    return false;
  context.body[0].begin(a, pose_a, WrapperMode::regularised);
  context.body[1].begin(b, from, WrapperMode::regularised);
  TreeKernel k = start_rigid_kernel(context, pose_a, from, 64);
  aim_at(sweep, 4 * (kWrapperMargin * size + 2 * defect * a.tree().extent()), unit, k);
  k.max_node_pairs = most;
  if (!(k.margin < std::numeric_limits<float>::infinity())) return false;
  run_tree_kernel(k);  // returns at the first candidate
  return is_done(k) && k.out_size == 0;
}

/// Returns true for requests whose answers for bodies apart have nothing but the relation.
bool asks_only_whether(const LrbRep& a, const LrbRep& b, const CollideRequest& request) {
  return request.mode == Mode::any_pair && request.recursion == Recursion::complete &&
         request.predicates == Predicates::exact && !request.is_coarse() && !request.contacts &&
         !request.interiors_overlap && !request.separation && a.closed() && b.closed() && a.dim() == 3 &&
         b.dim() == 3 && !a.tree().empty() && !b.tree().empty();
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
    known_.assign(poses_b.size(), 0);
    const auto ask_one = [&](std::size_t i, unsigned worker) {
      if (std::exchange(known_[i], 1) == 0)
        ask(a, pose_a, b, poses_b[i], request, workspaces_[worker], answers[i]);
    };
    if constexpr (std::is_same_v<Request, CollideRequest>)
      if (asks_only_whether(a, b, request))
        workers_.for_each((poses_b.size() + kTogether - 1) / kTogether, [&](std::size_t i, unsigned worker) {
          const std::size_t first = i * kTogether;
          answer_apart(a, pose_a, b, poses_b, {first, std::min(first + kTogether, poses_b.size())}, answers,
                       ask_one, worker);
        });
    workers_.for_each(poses_b.size(), ask_one);
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
  /// The number of poses that are proven apart at once, and the fewest for which this is tried. After
  /// kMaxMisses attempts in a row that proved nothing for these poses, each is queried on its own. One thread
  /// tries all ranges of kTogether poses: 3 to 60 us in all, for which two threads are not faster.
  static constexpr std::size_t kTogether = 64, kFewest = 4, kMaxMisses = 7;
  struct Range {
    std::size_t begin, end;
  };

  /// Answers for ranges of poses in which B never meets A: asks at the midpoint pose, and answers the
  /// same for the others if that is proven, otherwise tries both halves. Which ones are answered does not
  /// depend on the number of threads.
  template <class Ask>
  void answer_apart(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses,
                    Range all, CollideAnswers& answers, const Ask& ask_one, unsigned worker) {
    std::vector<Range> ranges = {all};
    std::size_t misses = 0;
    for (std::size_t i = 0; i < ranges.size() && misses < kMaxMisses; ++i) {
      const auto [begin, end] = ranges[i];
      if (end - begin < kFewest) continue;
      const std::size_t midpoint = begin + (end - begin) / 2;
      ask_one(midpoint, worker);
      const Expected<CollideResult>& found = answers[midpoint];
      // A traversal with a sweep takes a few times as many pairs of nodes.
      if (found && found->pairs.empty() &&
          meets_at_none(a, pose_a, b, poses.subspan(begin, end - begin), 64 + 4 * found->counters.node_pairs,
                        workspaces_[worker].memory().of_collision())) {
        for (std::size_t k = begin; k < end; ++k) {
          if (std::exchange(known_[k], 1) != 0) continue;
          CollideResult& same = emptied(answers[k]);
          same.mode = found->mode;
          same.relation = found->relation;
          same.interiors_overlap = found->interiors_overlap;
        }
        misses = 0;
        continue;
      }
      ++misses;
      ranges.push_back({begin, midpoint});
      ranges.push_back({midpoint, end});
    }
  }

  Workers workers_;
  std::vector<Workspace> workspaces_;  ///< (threads)
  std::vector<std::uint8_t> known_;    ///< (poses) 1: answered
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

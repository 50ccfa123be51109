#pragma once
/// Repeated queries: memory that they reuse (Workspace), batches on all cores (Batch), and errors that are
/// returned instead of thrown.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/motion.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

// Many queries at once, on all cores: answers stand in the order of the questions and are the same, to the
// bit, for any number of threads. (Only a limit in seconds, CollideRequest::max_time, depends on the
// machine.) A question that is refused has its reason in its place, and the others their answers.

/// One question of a batch: two bodies where they stand.
struct PosedPair {
  const LrbRep* a = nullptr;
  Pose pose_a;
  const LrbRep* b = nullptr;
  Pose pose_b;
};

/// Returns the numbers of the pairs in an order in which those of the same two bodies follow each other: the
/// memory of queries then keeps more of what it has.
std::vector<std::size_t> order_by_bodies(std::span<const PosedPair> pairs);

using CollideAnswers = std::vector<Expected<CollideResult>>;
using DistanceAnswers = std::vector<Expected<DistanceResult>>;

/// Asks batch after batch with the same threads and memory.
class Batch {
 public:
  /// Uses `threads` threads, the calling one included; 0: as many as the machine runs at once.
  explicit Batch(unsigned threads = 0);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  unsigned threads() const;

  /// Answer as collide() does, for each pose of B, or for each pair, into `answers`, whose memory is used
  /// again: contacts, coarse answers and single pairs as the request says.
  void collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
               const CollideRequest& request, CollideAnswers& answers);
  void collide(std::span<const PosedPair> pairs, const CollideRequest& request, CollideAnswers& answers);

  /// Answer as distance() does.
  void distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                const DistanceRequest& request, DistanceAnswers& answers);
  void distance(std::span<const PosedPair> pairs, const DistanceRequest& request, DistanceAnswers& answers);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

/// Answer one batch. threads: as for Batch.
CollideAnswers collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                       const CollideRequest& request = {}, unsigned threads = 0);
CollideAnswers collide(std::span<const PosedPair> pairs, const CollideRequest& request = {},
                       unsigned threads = 0);
DistanceAnswers distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                         const DistanceRequest& request = {}, unsigned threads = 0);
DistanceAnswers distance(std::span<const PosedPair> pairs, const DistanceRequest& request = {},
                         unsigned threads = 0);

/// Memory that queries reuse, and the last answer to each question: one for each thread. It serves all four
/// questions, about any bodies in space and in the plane; it is fastest when the same two bodies follow each
/// other. A moved-from workspace may only be assigned to or destroyed.
class Workspace {
 public:
  Workspace();
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  struct Memory;
  Memory& memory() { return *memory_; }

 private:
  std::unique_ptr<Memory> memory_;
};

// The four questions with a workspace. Each does what the function of the same name and the same arguments
// does without one, and its answer is the same to the last bit. Poses and motions map body coordinates to the
// world; lengths in requests and answers are in world units, except where the request says otherwise.
//
// The answer lies in the workspace until the next query there that asks the same question, and is the
// caller's to move from. What the functions without a workspace throw InputError for is returned as a
// Refusal: bodies of different dimensions, poses and world coordinates that are not finite, requests that
// contradict themselves. `probe` (null: none) is notified of what happens; what it throws ends the query, an
// InputError as a Refusal.

/// As collide() in <lrbscope/collide.hpp>; with a probe, as in <lrbscope/observe.hpp>. Also refuses more
/// pairs than CollideRequest::max_pairs.
///
/// Allocates no memory if the request is a plain one (complete; no contacts, interiors_overlap, separation or
/// limits), there is no probe, and a query of these bodies with no fewer pairs has been answered before.
Expected<CollideResult&> collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                 const CollideRequest& request, Workspace& workspace,
                                 CollideProbe* probe = nullptr);

/// Adds to an answer of collide() what its request left out and `request` asks for: `contacts` (with the
/// regions that they form) and `interiors_overlap`. The result is the same as if collide() had been called
/// with `request`, apart from its counters. Intended for programs that decide by the answer whether to pay
/// for more.
///
/// `result`: all pairs of these bodies at these poses, found with Recursion::complete and without tolerance
/// or limits, and not yet described. Returns it; refuses bodies and poses that collide() refuses.
Expected<CollideResult&> describe_contact(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                          const Pose& pose_b, const CollideRequest& request,
                                          Workspace& workspace, CollideResult& result);

/// As distance() in <lrbscope/distance.hpp>. Also refuses numbers of the request that are negative or not
/// finite.
Expected<DistanceResult&> distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                   const DistanceRequest& request, Workspace& workspace,
                                   BoundsProbe* probe = nullptr);

/// As clash() in <lrbscope/clash.hpp>. Also refuses bodies in the plane, a clearance that is negative or not
/// finite, and a direction without length.
Expected<ClashResult&> clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                             const ClashRequest& request, Workspace& workspace, ClashProbe* probe = nullptr);

/// As first_contact() in <lrbscope/first_contact.hpp>, for motions over t from 0 to 1. Also refuses a
/// tolerance that is not in (0, 1].
Expected<FirstContactResult&> first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                            const Motion& motion_b, const FirstContactRequest& request,
                                            Workspace& workspace, FirstContactProbe* probe = nullptr);

}  // namespace lrb

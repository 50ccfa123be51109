#pragma once
/// Repeated queries: reuse of memory (Workspace), batches on all cores (Batch), and errors that are returned
/// instead of thrown.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/motion.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

// Batches: many queries on all cores. The answers are in the order of the queries and bitwise equal for any
// number of threads. (Only CollideRequest::max_time, a limit in seconds, depends on the machine.) The answer
// to a rejected query is its error; other queries are not affected.

/// One query of a batch: two bodies with their poses.
struct PosedPair {
  const LrbRep* a = nullptr;
  Pose pose_a;
  const LrbRep* b = nullptr;
  Pose pose_b;
};

/// Returns a permutation of the pairs in which those of the same two bodies are adjacent, so that queries can
/// reuse more of their memory.
std::vector<std::size_t> order_by_bodies(std::span<const PosedPair> pairs);

using CollideAnswers = std::vector<Expected<CollideResult>>;
using DistanceAnswers = std::vector<Expected<DistanceResult>>;

/// Runs batches with the same threads and memory.
class Batch {
 public:
  /// `threads`: number of threads including the caller; 0: number of hardware threads.
  explicit Batch(unsigned threads = 0);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  unsigned threads() const;

  /// Run collide() for each pose of B, or for each pair, with any request. Writes to `answers`, whose memory
  /// is reused. In Mode::any_pair, poses in the order of a motion are fastest for closed 3D bodies: while B
  /// does not meet A, one test answers for up to 64 of them. Their answers have no opened regions and no
  /// counters.
  void collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
               const CollideRequest& request, CollideAnswers& answers);
  void collide(std::span<const PosedPair> pairs, const CollideRequest& request, CollideAnswers& answers);

  /// Run collide() or distance() for each pose of B, and call visit(i, answer) for each, in their order, on
  /// the calling thread, as soon as the answers of `chunk` poses (at least 1) are known: only these are in
  /// memory. Visitors may move from the answer. Ends if one returns false. Returns the number of visits.
  template <class Answer>
  using Visit = std::function<bool(std::size_t, Expected<Answer>&)>;
  std::size_t collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                      const CollideRequest& request, const Visit<CollideResult>& visit,
                      std::size_t chunk = 1024);
  std::size_t distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                       const DistanceRequest& request, const Visit<DistanceResult>& visit,
                       std::size_t chunk = 1024);

  /// Run distance() for each pose of B, or for each pair.
  void distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                const DistanceRequest& request, DistanceAnswers& answers);
  void distance(std::span<const PosedPair> pairs, const DistanceRequest& request, DistanceAnswers& answers);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

/// Run one batch. `threads`: as for Batch.
CollideAnswers collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                       const CollideRequest& request = {}, unsigned threads = 0);
CollideAnswers collide(std::span<const PosedPair> pairs, const CollideRequest& request = {},
                       unsigned threads = 0);
DistanceAnswers distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses_b,
                         const DistanceRequest& request = {}, unsigned threads = 0);
DistanceAnswers distance(std::span<const PosedPair> pairs, const DistanceRequest& request = {},
                         unsigned threads = 0);

/// Memory that queries reuse, and the last answer of each kind of query. Use one per thread. It serves all
/// kinds of queries for any bodies, 3D and 2D, and is fastest if successive queries are about the same
/// two bodies. A moved-from workspace may only be assigned to or destroyed.
class Workspace {
 public:
  /// `threads`: number of threads for one query, including the caller; 0: number of hardware threads. Used
  /// for all pairs of bodies in deep contact (over about 1,000 pairs), and by near_pairs() and
  /// contact_manifolds(). Answers are the same for any number.
  explicit Workspace(unsigned threads = 1);
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  struct Memory;
  Memory& memory() { return *memory_; }

 private:
  std::unique_ptr<Memory> memory_;
};

// The queries with a workspace. Each returns the same answer, to the last bit, as the function of the
// same name and arguments without a workspace. Poses and motions map body to world coordinates. Lengths in
// requests and answers are in world units unless the request states otherwise.
//
// The answer is stored in the workspace. It is valid until the next query of the same kind there, and the
// caller may move from it. Where the function without a workspace throws InputError, an error is returned:
// bodies of different dimensions, poses or world coordinates that are not finite, invalid requests. `probe`
// (may be null) is notified of events. An exception that it throws ends the query; an InputError is returned
// as an error.

/// See collide() in <lrbscope/collide.hpp>; with a probe, in <lrbscope/observe.hpp>. Also returns an error if
/// there are more pairs than CollideRequest::max_pairs.
///
/// Allocates no memory if the request is plain (complete; no contacts, interiors_overlap, separation or
/// limits), there is no probe, the workspace has one thread, and a query of these bodies with at least as
/// many pairs was answered before.
Expected<CollideResult&> collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                 const CollideRequest& request, Workspace& workspace,
                                 CollideProbe* probe = nullptr);

/// Adds the parts that `request` requires to a result of collide() without them: `contacts` (with their
/// regions) and `interiors_overlap`. The result is the same as if collide() had been called with `request`,
/// except for its counters. For programs that decide from the pairs whether the rest is worth computing.
///
/// `result`: all pairs of these bodies at these poses, found with Recursion::complete and without tolerance
/// or limits, and without these parts. Returns it, or an error for bodies and poses that collide() rejects.
Expected<CollideResult&> describe_contact(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                          const Pose& pose_b, const CollideRequest& request,
                                          Workspace& workspace, CollideResult& result);

/// See distance() in <lrbscope/distance.hpp>. Also returns an error for a request with a negative or
/// non-finite number.
Expected<DistanceResult&> distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                   const DistanceRequest& request, Workspace& workspace,
                                   BoundsProbe* probe = nullptr);

/// See near_pairs() in <lrbscope/near_pairs.hpp>, on one thread. Also returns an error for a negative or
/// non-finite distance and for more pairs than NearPairsRequest::max_pairs.
Expected<NearPairsResult&> near_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                      const Pose& pose_b, const NearPairsRequest& request,
                                      Workspace& workspace);

/// See contact_manifolds() in <lrbscope/contact_manifold.hpp>, on one thread. `previous` may be the answer of
/// the previous step in this workspace. Also returns an error for a negative or non-finite margin and for
/// more pairs than ManifoldRequest::max_pairs.
Expected<ManifoldResult&> contact_manifolds(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                            const Pose& pose_b, const ManifoldRequest& request,
                                            Workspace& workspace, const ManifoldResult* previous = nullptr);

/// See clash() in <lrbscope/clash.hpp>. Also returns an error for 2D bodies, a negative or non-finite
/// clearance, and a direction of length zero.
Expected<ClashResult&> clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                             const ClashRequest& request, Workspace& workspace, ClashProbe* probe = nullptr);

/// See first_contact() in <lrbscope/first_contact.hpp>, for motions over t in [0, 1]. Also returns an error
/// for a tolerance outside (0, 1].
Expected<FirstContactResult&> first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                            const Motion& motion_b, const FirstContactRequest& request,
                                            Workspace& workspace, FirstContactProbe* probe = nullptr);

}  // namespace lrb

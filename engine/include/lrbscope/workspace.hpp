#pragma once
/// Queries one after another, without a word of memory asked for once the first ones have been answered, and
/// without exceptions for what a caller can foresee.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
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

/// The memory that queries use, and the last answer: one for each thread. It serves any bodies; those that
/// follow each other with the same two bodies are quickest.
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

/// Does what collide() in collide.hpp does. The answer stays in the workspace until its next query, and is
/// the caller's to move from. Refuses what collide() throws InputError for: bodies of different dimensions,
/// poses and world coordinates that are not finite, requests that contradict themselves, more pairs than may
/// be kept.
///
/// Asks for no memory if the request is a plain one (complete; no contacts, interiors_overlap, separation or
/// limits) and a query of these bodies with no fewer pairs has been answered before.
Expected<CollideResult&> collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                 const CollideRequest& request, Workspace& workspace);

/// Does what distance() in distance.hpp does, and refuses what that throws InputError for.
Expected<DistanceResult> distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                  const DistanceRequest& request, Workspace& workspace);

}  // namespace lrb

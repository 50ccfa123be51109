#pragma once
/// Many queries at once, on all cores: answers stand in the order of the questions and are the same, to the
/// bit, for any number of threads. (Only a limit in seconds, CollideRequest::max_time, depends on the
/// machine.) A question that is refused has its reason in its place, and the others their answers.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/expected.hpp"
#include "engine/core/pose.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/distance/distance.hpp"

namespace lrb {

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

}  // namespace lrb

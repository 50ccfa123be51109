#pragma once
/// A set of moving bodies, with queries for all intersecting pairs and for the closest pair. A broad phase
/// that is coherent between calls finds the pairs whose AABBs intersect; these are queried exactly, on all
/// cores.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <lrbscope/body.hpp>
#include <lrbscope/broad_phase.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// Identifies a body of a scene from add() to remove(). Ascending, never reused.
enum class BodyKey : std::uint64_t {};

/// Two bodies of a scene (or of two scenes) with the answer for them.
struct SceneAnswer {
  BodyKey a{}, b{};  ///< within one scene: a < b
  Expected<CollideResult> result;
};

/// Two bodies of a scene (or of two scenes) whose AABBs are close.
struct ScenePair {
  BodyKey a{}, b{};  ///< within one scene: a < b
  /// A lower bound on the distance of the AABBs, and thus of the bodies; 0 if the AABBs intersect.
  double gap = 0;
};

/// The definition of the distance of two bodies.
enum class Apart : std::uint8_t {
  surfaces,  ///< DistanceResult::upper
  solids,    ///< DistanceResult::solids_upper(): 0 also if one body contains the other
};

/// The closest two bodies and their distance.
struct SceneDistance {
  BodyKey a{}, b{};
  Expected<DistanceResult> result;
};

/// A set of posed bodies. Not thread-safe.
class Scene {
 public:
  /// `threads`: number of threads including the caller; 0: number of hardware threads. Answers do not depend
  /// on it.
  explicit Scene(unsigned threads = 0);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Reserves memory for `bodies` bodies, which avoids restarts of the broad phase while bodies are added.
  void reserve(std::size_t bodies);
  /// Adds a body at a pose. A body may be added several times; the copies share its data.
  BodyKey add(Body body, const Pose& pose = {});
  /// Removes a body. Returns false if the key does not exist.
  bool remove(BodyKey key);
  /// Moves a body to a pose. A body that already has this pose has not moved. Returns false if the key does
  /// not exist.
  bool move(BodyKey key, const Pose& pose);

  std::size_t size() const;
  bool has(BodyKey key) const;
  /// Return a body or its pose. The key must exist.
  const Body& body(BodyKey key) const;
  const Pose& pose(BodyKey key) const;
  /// Returns the keys of all bodies, ascending.
  std::vector<BodyKey> keys() const;

  /// Returns the pairs of bodies whose AABBs are at most `within` apart (at least 0; world units), closest
  /// first; equal gaps are in ascending order of keys. With 0 these are the pairs that collide() queries.
  /// Valid until the next call of near().
  std::span<const ScenePair> near(double within = 0);
  /// As above, for a body from outside the scene (A) and the bodies of the scene (B), and for the bodies of
  /// this scene (A) and of another (B).
  std::span<const ScenePair> near(const Body& body, const Pose& pose, double within = 0);
  std::span<const ScenePair> near(Scene& other, double within = 0);
  /// Return the pair with the closest AABBs, which is the first pair of near() if `within` is large enough;
  /// nullopt if there is no pair.
  std::optional<ScenePair> nearest_boxes();
  std::optional<ScenePair> nearest_boxes(const Body& body, const Pose& pose);
  std::optional<ScenePair> nearest_boxes(Scene& other);

  /// Returns all intersecting pairs of bodies, in ascending order of keys. Includes pairs with an error (a
  /// pose that is not finite). Omits pairs that are `separate`, or `undefined` for bodies without a solid.
  /// Valid until the next call of collide(). Does not repeat the queries of pairs of which neither body has
  /// moved since the last call of this overload with the same request, unless the request limits the time.
  std::span<const SceneAnswer> collide(const CollideRequest& request = {});
  /// Returns the bodies that intersect a body from outside the scene. That body is A; SceneAnswer::a is
  /// unused.
  std::span<const SceneAnswer> collide(const Body& body, const Pose& pose,
                                       const CollideRequest& request = {});
  /// Returns the intersecting pairs of a body of this scene (A) and one of another (B).
  std::span<const SceneAnswer> collide(Scene& other, const CollideRequest& request = {});

  /// Returns the closest pair of bodies by `apart`; ties are resolved deterministically. nullopt if there are
  /// fewer than two bodies. A pair with an error that might be the closest is returned with its error.
  /// DistanceRequest::within is ignored.
  std::optional<SceneDistance> nearest(const DistanceRequest& request = {}, Apart apart = Apart::surfaces);
  /// Returns the body closest to a body from outside the scene. That body is A; SceneDistance::a is unused.
  std::optional<SceneDistance> nearest(const Body& body, const Pose& pose,
                                       const DistanceRequest& request = {}, Apart apart = Apart::surfaces);
  /// Returns the closest pair of a body of this scene (A) and one of another (B).
  std::optional<SceneDistance> nearest(Scene& other, const DistanceRequest& request = {},
                                       Apart apart = Apart::surfaces);

  /// The work of the last call. `broad_phase`: of the last call that updated the scene's broad phase.
  struct Work {
    std::size_t moved = 0;  ///< bodies whose AABBs were recomputed
    std::size_t near = 0;   ///< pairs with intersecting AABBs
    std::size_t kept = 0;   ///< of these, the pairs whose answers collide() kept from the last call
    SweepAndPrune::Work broad_phase;
  };
  const Work& work() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lrb

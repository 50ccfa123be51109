#pragma once
/// Many bodies that come, go and move: which of them meet, and how far they are apart. A broad phase that
/// keeps its order from call to call finds the pairs whose boxes meet; each of those is asked exactly, on all
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

/// Names a body of a scene, from add() to remove(). Given out in ascending order, and never again.
enum class BodyKey : std::uint64_t {};

/// Two bodies of a scene (or of two scenes) and the answer about them.
struct SceneAnswer {
  BodyKey a{}, b{};  ///< of one scene: a < b
  Expected<CollideResult> result;
};

/// Two bodies of a scene (or of two scenes) whose boxes are near each other.
struct ScenePair {
  BodyKey a{}, b{};  ///< of one scene: a < b
  double gap =
      0;  ///< a lower bound on how far the boxes, and so the bodies, are apart; 0 where the boxes meet
};

/// What the distance of two bodies is taken to be.
enum class Apart : std::uint8_t {
  surfaces,  ///< DistanceResult::upper
  solids,    ///< DistanceResult::solids_upper(): 0 also where one body holds the other
};

/// The two bodies that are nearest to each other, and how near.
struct SceneDistance {
  BodyKey a{}, b{};
  Expected<DistanceResult> result;
};

/// Not to be used by two threads at once.
class Scene {
 public:
  /// Uses `threads` threads, the calling one included; 0: as many as the machine runs at once. No answer
  /// depends on their number.
  explicit Scene(unsigned threads = 0);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Makes room for so many bodies, to spare the broad phase from beginning anew as they come.
  void reserve(std::size_t bodies);
  /// Adds a body where it stands. A body may be added many times: copies share what is made for it.
  BodyKey add(Body body, const Pose& pose = {});
  /// Takes a body out. Returns false if there is none of that key.
  bool remove(BodyKey key);
  /// Moves a body. Returns false if there is none of that key.
  bool move(BodyKey key, const Pose& pose);

  std::size_t size() const;
  bool has(BodyKey key) const;
  /// Return a body and where it stands. There must be one of that key.
  const Body& body(BodyKey key) const;
  const Pose& pose(BodyKey key) const;
  /// Returns the keys of all bodies, ascending.
  std::vector<BodyKey> keys() const;

  /// Finds the pairs of bodies whose boxes are no further apart than `within` (from 0 on, the world's unit),
  /// nearest first, those of the same gap in ascending order of their keys. At 0 these are the pairs that
  /// collide() asks about. Valid until the next call of near().
  std::span<const ScenePair> near(double within = 0);
  /// Do the same for a body from outside the scene, which is A, and for a body of this scene, A, and one of
  /// another.
  std::span<const ScenePair> near(const Body& body, const Pose& pose, double within = 0);
  std::span<const ScenePair> near(Scene& other, double within = 0);
  /// Find the pair whose boxes are nearest to each other: near() begins with it if it is asked for far
  /// enough. None if there is no pair.
  std::optional<ScenePair> nearest_boxes();
  std::optional<ScenePair> nearest_boxes(const Body& body, const Pose& pose);
  std::optional<ScenePair> nearest_boxes(Scene& other);

  /// Finds all pairs of bodies that meet, in ascending order of their keys. What is refused (a pose that is
  /// not finite) is among them, with its reason; pairs that are `separate` or, without a solid, `undefined`
  /// are not. Valid until the next call of collide().
  std::span<const SceneAnswer> collide(const CollideRequest& request = {});
  /// Finds the bodies that a body from outside the scene meets: it is A, and SceneAnswer::a means nothing.
  std::span<const SceneAnswer> collide(const Body& body, const Pose& pose,
                                       const CollideRequest& request = {});
  /// Finds the pairs of a body of this scene, A, and one of another, B, that meet.
  std::span<const SceneAnswer> collide(Scene& other, const CollideRequest& request = {});

  /// Finds the pair of bodies that are nearest, by `apart`; of equals always the same. None if there are less
  /// than two bodies. A pair that is refused is the answer, with its reason, where it may be the nearest. The
  /// request's `within` is not looked at.
  std::optional<SceneDistance> nearest(const DistanceRequest& request = {}, Apart apart = Apart::surfaces);
  /// Finds the body that is nearest to one from outside the scene, which is A; SceneDistance::a means
  /// nothing.
  std::optional<SceneDistance> nearest(const Body& body, const Pose& pose,
                                       const DistanceRequest& request = {}, Apart apart = Apart::surfaces);
  /// Finds the nearest pair of a body of this scene, A, and one of another, B.
  std::optional<SceneDistance> nearest(Scene& other, const DistanceRequest& request = {},
                                       Apart apart = Apart::surfaces);

  /// The work of the last call; `broad_phase` is that of the last one that asked which boxes of the scene
  /// meet.
  struct Work {
    std::size_t moved = 0;  ///< bodies whose boxes were made anew
    std::size_t near = 0;   ///< pairs whose boxes meet: so many queries has collide()
    SweepAndPrune::Work broad_phase;
  };
  const Work& work() const;

 private:
  class Held;
  std::unique_ptr<Held> held_;
};

}  // namespace lrb

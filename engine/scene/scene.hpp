#pragma once
/// Many bodies that come, go and move: which of them meet, and how far they are apart. A broad phase that keeps its
/// order from call to call finds the pairs whose boxes meet; each of those is asked exactly, on all cores.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/body/body.hpp"
#include "engine/core/expected.hpp"
#include "engine/core/pose.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/distance/distance.hpp"

namespace lrb {

/// Names a body of a scene, from add() to remove(). Given out in ascending order, and never again.
enum class BodyKey : std::uint64_t {};

/// Two bodies of a scene (or of two scenes) and the answer about them.
struct SceneAnswer {
  BodyKey a{}, b{};  ///< of one scene: a < b
  Expected<CollideResult> result;
};

/// The two bodies that are nearest to each other, and how near.
struct SceneDistance {
  BodyKey a{}, b{};
  Expected<DistanceResult> result;
};

/// Not to be used by two threads at once.
class Scene {
 public:
  /// Uses `threads` threads, the calling one included; 0: as many as the machine runs at once. No answer depends on
  /// their number.
  explicit Scene(unsigned threads = 0);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

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

  /// Finds all pairs of bodies that meet, in ascending order of their keys. What is refused (a pose that is not
  /// finite) is among them, with its reason; pairs that are `separate` or, without a solid, `undefined` are not.
  /// Valid until the next call of collide().
  std::span<const SceneAnswer> collide(const CollideRequest& request = {});
  /// Finds the bodies that a body from outside the scene meets: it is A, and SceneAnswer::a means nothing.
  std::span<const SceneAnswer> collide(const Body& body, const Pose& pose,
                                       const CollideRequest& request = {});
  /// Finds the pairs of a body of this scene, A, and one of another, B, that meet.
  std::span<const SceneAnswer> collide(Scene& other, const CollideRequest& request = {});

  /// Finds the pair of bodies whose surfaces are nearest, by DistanceResult::upper; of equals always the same. None
  /// if there are less than two bodies. A pair that is refused is the answer, with its reason, where it may be the
  /// nearest. The request's `within` is not looked at.
  std::optional<SceneDistance> nearest(const DistanceRequest& request = {});
  /// Finds the body that is nearest to one from outside the scene, which is A; SceneDistance::a means nothing.
  std::optional<SceneDistance> nearest(const Body& body, const Pose& pose,
                                       const DistanceRequest& request = {});
  /// Finds the nearest pair of a body of this scene, A, and one of another, B.
  std::optional<SceneDistance> nearest(Scene& other, const DistanceRequest& request = {});

  /// The work of the last collide(); swaps and sorted_afresh are of the last one of the whole scene.
  struct Work {
    std::size_t moved = 0;       ///< bodies whose boxes were made anew
    std::size_t near = 0;        ///< pairs whose boxes meet: so many queries
    std::uint64_t swaps = 0;     ///< of neighbours in the order of the broad phase
    bool sorted_afresh = false;  ///< the order was not kept
  };
  const Work& work() const;

 private:
  class Held;
  std::unique_ptr<Held> held_;
};

}  // namespace lrb

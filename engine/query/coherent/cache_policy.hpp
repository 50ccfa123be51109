#pragma once
/// Decides when a coherent query makes a candidate cache, and for how many steps: by the clock, comparing
/// what caches cost with what queries from scratch cost. The answers do not depend on it.

#include <cstdint>
#include <optional>
#include <utility>

namespace lrb {

class CachePolicy {
 public:
  /// What a cache covers: a sweep of B, or the surroundings of a fixed pose. Each kind has a number of steps
  /// that suits it.
  enum class Kind : std::uint8_t { swept, fixed };

  /// Starts a query. Returns true while the policy pauses after caches that did not pay: B's motion need not
  /// be watched then. For the last few queries of a pause returns false, because a cache can be made only
  /// once the motion is known.
  bool rests();
  /// Returns true during a pause: the query is to be answered from scratch.
  bool must_wait() const { return pause_ > 0; }

  struct Plan {
    Kind kind;
    double steps;  ///< number of steps that the cache is to serve for
  };
  /// Returns the cache that should be made now, if any. is_steady: B's motion is steady
  /// (RelativeMotion::is_kept()); step: how far B moves at a time; radius: B's (both in the mesh's unit).
  /// Takes into account what the last cache cost.
  std::optional<Plan> next(bool is_steady, double step, double radius);
  /// The number of steps that caches are made for before it is known what suits.
  static constexpr double kFirstSteps = 8;

  /// Returns the time in seconds after which making a cache is given up.
  double patience() const;

  // Report the time that a whole query took, in seconds: one from scratch, one that made a cache, one
  // answered from it.
  void scratch_took(double time);
  void build_took(Kind kind, double time);
  void step_took(double time);
  /// Ignores what the last cache cost, because it ended for reasons of its own; does so only once until the
  /// next cache is accounted for.
  void forgive() {
    if (!std::exchange(forgave_, true)) build_time_ = 0;
  }

 private:
  struct Aim {
    double steps = kFirstSteps;
    double cost = 0;  ///< recent cost of a query with such caches, in queries from scratch; 0: not known
    /// The next cache is for more steps, as long as that makes queries faster; else for fewer.
    bool is_growing = true;
  };
  Aim& aim(Kind kind) { return aim_[static_cast<int>(kind)]; }
  double cost() const;  ///< cost of a query with the current cache, in queries from scratch
  double growth(Aim& used, double now) const;
  void take_stock();
  void rest();

  Aim aim_[2] = {{}, {.cost = 0.6}};       ///< fixed caches are tried where swept ones cost more than this
  bool has_memory_ = false;                ///< a cache has been made before
  Kind kind_ = Kind::swept;                ///< kind of the current cache
  double build_time_ = 0, step_time_ = 0;  ///< times of making it, and of the steps since
  std::uint32_t steps_ = 0;                ///< number of these steps
  double scratch_time_ = 0;
  bool is_fresh_ = false;                     ///< scratch_time_ is newer than the cache
  bool forgave_ = false;                      ///< forgive() was called since the last take_stock()
  std::uint32_t failures_ = 0;                ///< number of caches in a row that did not pay
  double too_long_ = 0;                       ///< a step for which a cache did not pay, mesh's unit
  std::uint32_t pause_ = 0, next_pause_ = 4;  ///< queries from scratch before the next cache is tried
  std::uint32_t pauses_ = 0;                  ///< number of pauses since the last try
};

}  // namespace lrb

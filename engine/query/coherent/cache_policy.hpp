#pragma once
/// When a coherent query makes a list, and for how many steps: by what lists cost, by the clock, against what
/// queries from scratch cost. The answers do not depend on it.

#include <cstdint>
#include <optional>
#include <utility>

namespace lrb {

class CachePolicy {
 public:
  /// What a list is for, each of which has a length that suits it: a stretch of a course, or a place.
  enum class Kind : std::uint8_t { swept, fixed };

  /// A query begins. True: it is one of those, after lists that did not pay, in which nothing is watched; for
  /// the last few of them the motion must be, for a list to be made.
  bool rests();
  bool must_wait() const { return pause_ > 0; }

  struct Plan {
    Kind kind;
    double steps;  ///< that it is to serve for
  };
  /// The list that should be made now, if any, B being on a course or not, of that radius, and moving by
  /// `step` at a time (mesh's unit). Takes what the last one cost into account.
  std::optional<Plan> next(bool on_course, double step, double radius);
  /// What lists are made for before it is known what suits.
  static constexpr double kFirstSteps = 8;

  /// A list that is not found after so many seconds is given up.
  double patience() const;

  // Seconds, of whole queries.
  void scratch_took(double time);
  void build_took(Kind kind, double time);
  void step_took(double time);
  /// The last list ended for reasons of its own: what it cost tells nothing, unless so did the one before.
  void forgive() {
    if (!std::exchange(forgave_, true)) build_time_ = 0;
  }

 private:
  struct Aim {
    double steps = kFirstSteps;
    double cost = 0;         ///< of a query with such lists of late, queries from scratch; 0: not known
    bool is_growing = true;  ///< the next list is longer, while this makes queries faster; else shorter
  };
  Aim& aim(Kind kind) { return aim_[static_cast<int>(kind)]; }
  double cost() const;  ///< of a query with the list at hand, queries from scratch
  double growth(Aim& used, double now) const;
  void take_stock();
  void rest();

  Aim aim_[2] = {{}, {.cost = 0.6}};       ///< places are tried where stretches are little cheaper than this
  bool has_memory_ = false;                ///< there has been a list
  Kind kind_ = Kind::swept;                ///< of the list at hand
  double build_time_ = 0, step_time_ = 0;  ///< of it, and of the steps since
  std::uint32_t steps_ = 0;                ///< so many
  double scratch_time_ = 0;
  bool is_fresh_ = false;                     ///< it is younger than the list
  bool forgave_ = false;                      ///< since stock was taken
  std::uint32_t failures_ = 0;                ///< so many lists in a row did not pay
  double too_long_ = 0;                       ///< a step for which a list did not pay
  std::uint32_t pause_ = 0, next_pause_ = 4;  ///< queries from scratch before the next list is tried
  std::uint32_t pauses_ = 0;                  ///< since the last try
};

}  // namespace lrb

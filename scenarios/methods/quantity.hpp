#pragma once
/// What methods are asked for where they are compared: pairs that meet, or a number.

#include <array>
#include <cstdint>

#include "engine/core/enum_words.hpp"

namespace lrb::methods {

enum class Quantity : std::uint8_t {
  pairs,          ///< which pairs meet, and how the bodies lie
  distance,       ///< of the surfaces
  first_contact,  ///< the time at which B, which moves straight, first meets A
  depth,          ///< the length of the shortest translation that parts the bodies
};
constexpr auto words_of(Quantity) {
  return std::to_array<EnumWord<Quantity>>({{Quantity::pairs, "pairs"},
                                            {Quantity::distance, "distance"},
                                            {Quantity::first_contact, "first_contact"},
                                            {Quantity::depth, "depth"}});
}

/// What is said of a first contact if there is none: motions end at 1.
inline constexpr double kNever = 2;

}  // namespace lrb::methods

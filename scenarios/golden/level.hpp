#pragma once

#include <cstdint>

#include "engine/core/enum_words.hpp"

namespace lrb::golden {

/// What of a run must be as approved.
enum class Level : std::uint8_t {
  answers,   ///< of each step: relation, pairs, whether interiors overlap, and what a coarse query proves
  events,    ///< bodies, request, poses, every event and every counter
  pictures,  ///< frames, within a tolerance
};
constexpr auto words_of(Level) {
  return std::to_array<EnumWord<Level>>(
      {{Level::answers, "answers"}, {Level::events, "events"}, {Level::pictures, "pictures"}});
}
inline constexpr int kLevels = 3;

}  // namespace lrb::golden

#pragma once

#include <optional>

namespace lrb::bench {

/// Returns how far out along a way two bodies first meet, coming in from `far`: tries one place every `step`
/// as long as it is beyond `near`, then halves. None: they meet nowhere there. meets(s): at s.
template <class Meets>
std::optional<double> first_meeting(double far, double near, double step, const Meets& meets) {
  constexpr int kHalvings = 40;
  double at = far;
  while (at > near && !meets(at)) at -= step;
  if (at <= near) return std::nullopt;
  for (int i = 0; i < kHalvings; ++i) {
    step /= 2;
    if (meets(at + step)) at += step;
  }
  return at;
}

}  // namespace lrb::bench

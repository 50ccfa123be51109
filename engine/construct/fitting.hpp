#pragma once
/// The schedule by which builders make hulls that fit.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/core/tolerances.hpp"

namespace lrb::construct {

/// What a pass asks of its caps.
struct CapGoal {
  double worth;    ///< the largest share of the faces it covers that a cap may have
  double off = 0;  ///< how far a cap may stand off the body, mesh's unit; 0: as far as it likes
};

/// Limits on a cap's distance from the body, as shares of its largest side: the first, the last, and the factor from
/// one to the next. Measured on six bodies: a start at 0.0003 takes three times as long and gains nothing from
/// 0.005 on; a step of 2 in place of 1.25 costs a sixth more faces.
inline constexpr double kFirstOff = 0.001, kLastOff = 0.1, kOffStep = 1.25;
/// A pass that leaves a larger share of the hull's faces is the last for its distance.
inline constexpr double kFitGain = 0.8;
inline constexpr int kPassesForOff = 8;
/// A cap that leaves x of the faces it covers costs x / (1 - x) faces for each that it saves. This is the largest
/// price accepted on the mesh itself; on simpler hulls it is divided by the square root of hull faces / real faces.
/// Larger: hulls fit better; smaller: fewer faces in all (0.74: 1.7 to 2 per real face on six bodies).
inline constexpr double kFitBudget = 0.74;
/// With such prices pseudo faces add up to a total times 1 - sqrt(hull faces / real faces). This is the total, per
/// real face, that a body may come to: where caps turned out cheaper, dearer ones are accepted, and the other way
/// round. kFitCorrection: by how much of the price for each pseudo face per real one that is left to be spent. On
/// nefertiti, which came to 0.81: 838 in place of 898 faces at a hundredth of its size, with 0.85.
inline constexpr double kFitTotal = 1.17, kFitCorrection = 2;
inline constexpr double kLeastCorrection = 0.5;

/// Returns the largest share of faces that a cap which fits may have, on a hull of so many, after so many pseudo faces.
inline double fitting_worth(std::size_t hull_faces, std::size_t real_faces, std::size_t pseudo_faces) {
  const double real = static_cast<double>(real_faces);
  const double root = std::sqrt(static_cast<double>(hull_faces) / real);
  const double left = kFitTotal * (1 - root) - static_cast<double>(pseudo_faces) / real;
  const double ratio = kFitBudget / root * std::max(kLeastCorrection, 1 + kFitCorrection * left);
  return std::min(kLastCapWorth, ratio / (1 + ratio));
}

/// Makes hulls that fit: what caps may be off grows from pass to pass, slowly enough that each distance gets about
/// the simplest hull that there is for it. `size`: the body's largest side. Calls pass(goal) for hulls of more
/// than `least` faces, which faces() counts; pseudo_faces() counts those of all caps made so far.
template <class Faces, class PseudoFaces, class Pass>
void fit_hulls(double size, std::size_t real_faces, std::uint32_t least, Faces faces,
               PseudoFaces pseudo_faces, Pass pass) {
  for (double off = kFirstOff * size; off < kLastOff * size; off *= kOffStep) {
    for (int i = 0; i < kPassesForOff; ++i) {
      const std::uint32_t before = faces();
      if (before <= least) return;
      pass(CapGoal{fitting_worth(before, real_faces, pseudo_faces()), off});
      if (faces() > kFitGain * before) break;
    }
  }
}

}  // namespace lrb::construct

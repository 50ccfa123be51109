#pragma once
/// The builder for 2D bodies, that for 3D bodies (build.cpp) in one dimension less; and the schedule of
/// passes of both.
///
/// A patch is a chain of segments, and its ring is the two ends of the chain. The cap is the chord between
/// them if the chain is behind it, otherwise two segments whose common vertex is in front of the lines of all
/// segments of the chain.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/core/tolerances.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// Builds an LRB-rep from a 2D mesh that is MeshReport::buildable() and oriented outward. `meeting`: the
/// faces that intersect others in more than shared vertices and edges, ascending.
LrbData build_by_chains(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options);

// The schedule of passes by which both builders make tightly fitting fronts.

/// Acceptance limits for the caps of a pass.
struct CapGoal {
  double worth;          ///< maximum ratio of a cap's faces to the faces it covers
  double deviation = 0;  ///< maximum deviation of a cap from the body, mesh units; 0: unlimited
};

/// Deviation limits of the passes, relative to the body's largest side: the first, the last, and the factor
/// between successive ones. Measured on six bodies: starting at 0.0003 takes three times as long and gains
/// nothing from 0.005 on; a factor of 2 instead of 1.25 costs a sixth more faces.
inline constexpr double kFirstOff = 0.001, kLastOff = 0.1, kOffStep = 1.25;
inline constexpr int kPassesForOff = 8;
/// A cap with a share x of the faces it covers costs x / (1 - x) pseudo faces for each face that it saves.
/// kFitBudget is the maximum price on the mesh itself; on simpler fronts it is divided by the square root of
/// front faces / real faces. Larger: tighter fronts; smaller: fewer faces in total (0.74: 1.7 to 2 per real
/// face on six bodies).
inline constexpr double kFitBudget = 0.74;
/// At these prices the pseudo faces add up to a total times 1 - sqrt(front faces / real faces). While fewer
/// pseudo faces were used than the total kFitTotal, per real face, allows, because caps were cheap, higher
/// prices are accepted: the price rises by kFitCorrection for each unused pseudo face per real face. In 3D
/// only.
inline constexpr double kFitTotal = 1.0, kFitCorrection = 2;

/// Returns sqrt(front faces / real faces), by which prices are divided.
inline double fitting_root(std::size_t front_faces, std::size_t real_faces) {
  return std::sqrt(static_cast<double>(front_faces) / static_cast<double>(real_faces));
}

/// Returns the factor for the price of caps on a front, given the number of pseudo faces so far.
inline double fitting_correction(std::size_t front_faces, std::size_t real_faces, std::size_t pseudo_faces) {
  const double planned = kFitTotal * (1 - fitting_root(front_faces, real_faces));
  const double left = planned - static_cast<double>(pseudo_faces) / static_cast<double>(real_faces);
  return 1 + kFitCorrection * std::max(0.0, left);
}

/// Returns the maximum ratio of faces (CapGoal::worth) of a fitting cap on a front of `front_faces` faces.
inline double fitting_worth(std::size_t front_faces, std::size_t real_faces, double budget = kFitBudget,
                            double correction = 1) {
  const double ratio = budget / fitting_root(front_faces, real_faces) * correction;
  return std::min(kLastCapWorth, ratio / (1 + ratio));
}

/// Builds tightly fitting fronts. The maximum deviation grows from pass to pass, slowly enough that each
/// front is about the simplest one possible at its deviation. `size`: the body's largest side. Calls
/// pass(front faces, deviation) while faces() returns more than `least`; a pass that leaves more than the
/// share `gain` of the faces is the last at its deviation.
template <class Faces, class Pass>
void fit_fronts(double size, std::uint32_t least, double gain, Faces faces, Pass pass) {
  for (double deviation = kFirstOff * size; deviation < kLastOff * size; deviation *= kOffStep) {
    for (int i = 0; i < kPassesForOff; ++i) {
      const std::uint32_t before = faces();
      if (before <= least) return;
      pass(before, deviation);
      if (faces() > gain * before) break;
    }
  }
}

}  // namespace lrb::construct

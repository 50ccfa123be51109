#pragma once
/// The builder for bodies in the plane: the idea of build_by_patches(), one dimension down.
///
/// A patch is a chain of segments, and its ring is the chain's two ends. The cap is the chord between them
/// where the chain lies behind it, else two segments whose common vertex lies in front of all the chain's
/// lines.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/core/tolerances.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// Builds an LRB-rep from a 2D mesh that is MeshReport::buildable() and not inside out. `meeting`: the mesh's
/// faces that meet others in more than they share, ascending.
LrbData build_by_chains(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options);

// The schedule by which builders make hulls that fit.

/// What a pass asks of its caps.
struct CapGoal {
  double worth;    ///< the largest share of the faces it covers that a cap may have
  double off = 0;  ///< how far a cap may stand off the body, mesh's unit; 0: as far as it likes
};

/// Limits on a cap's distance from the body, as shares of its largest side: the first, the last, and the
/// factor from one to the next. Measured on six bodies: a start at 0.0003 takes three times as long and gains
/// nothing from 0.005 on; a step of 2 in place of 1.25 costs a sixth more faces.
inline constexpr double kFirstOff = 0.001, kLastOff = 0.1, kOffStep = 1.25;
/// A pass that leaves a larger share of the hull's faces is the last for its distance.
inline constexpr double kFitGain = 0.8;
inline constexpr int kPassesForOff = 8;
/// A cap that leaves x of the faces it covers costs x / (1 - x) faces for each that it saves. This is the
/// largest price accepted on the mesh itself; on simpler hulls it is divided by the square root of
/// hull faces / real faces. Larger: hulls fit better; smaller: fewer faces in all (0.74: 1.7 to 2 per real
/// face on six bodies).
inline constexpr double kFitBudget = 0.74;
/// With such prices pseudo faces add up to a total times 1 - sqrt(hull faces / real faces). As long as there
/// are fewer than this total, per real face, allows, because caps turned out cheap, dearer ones are accepted:
/// by kFitCorrection of the price for each pseudo face per real one that is left. In space alone. On
/// nefertiti (0.82 pseudo faces per real one without) 766 in place of 898 faces at a hundredth of its size;
/// five smaller bodies come out as without, or better.
inline constexpr double kFitTotal = 1.1, kFitCorrection = 2;

/// Returns the share of a hull's faces in those of the body, under a root, as prices have it.
inline double fitting_root(std::size_t hull_faces, std::size_t real_faces) {
  return std::sqrt(static_cast<double>(hull_faces) / static_cast<double>(real_faces));
}

/// Returns by what to multiply the price of caps on a hull of so many faces, after so many pseudo faces.
inline double fitting_correction(std::size_t hull_faces, std::size_t real_faces, std::size_t pseudo_faces) {
  const double planned = kFitTotal * (1 - fitting_root(hull_faces, real_faces));
  const double left = planned - static_cast<double>(pseudo_faces) / static_cast<double>(real_faces);
  return 1 + kFitCorrection * std::max(0.0, left);
}

/// Returns the largest share of faces that a cap which fits may have, on a hull of so many.
inline double fitting_worth(std::size_t hull_faces, std::size_t real_faces, double correction = 1) {
  const double ratio = kFitBudget / fitting_root(hull_faces, real_faces) * correction;
  return std::min(kLastCapWorth, ratio / (1 + ratio));
}

/// Makes hulls that fit: what caps may be off grows from pass to pass, slowly enough that each distance gets
/// about the simplest hull that there is for it. `size`: the body's largest side. Calls pass(hull faces, off)
/// for hulls of more than `least` faces, which faces() counts.
template <class Faces, class Pass>
void fit_hulls(double size, std::uint32_t least, Faces faces, Pass pass) {
  for (double off = kFirstOff * size; off < kLastOff * size; off *= kOffStep) {
    for (int i = 0; i < kPassesForOff; ++i) {
      const std::uint32_t before = faces();
      if (before <= least) return;
      pass(before, off);
      if (faces() > kFitGain * before) break;
    }
  }
}

// The builder for bodies in space: patch caps on progressive hulls.
//
// It works on the *current hull*, at first the mesh itself. In each pass the hull is covered with patches,
// disks of a few dozen triangles (patch_grow.hpp); each is simplified outward into a cap on the same ring
// (patch_cap.hpp); the space between is a region, its floor the patch and its lids the cap
// (hull_update.hpp); the caps become part of the hull of the next pass. A cap stands only if it is proved,
// exactly, to meet nothing else (embed_check.hpp): then the new hull is embedded again and encloses the old
// one, and so all faces of the complex meet only in what they share. When passes no longer help, each
// component of the hull is simplified as a whole, and at last one wrapper of few faces is put around all of
// them (closing.hpp).

/// Builds an LRB-rep from a 3D mesh that is MeshReport::buildable() and not inside out. `meeting`: the mesh's
/// faces that meet others in more than they share, ascending; only the outermost region abstracts from these.
LrbData build_by_patches(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options);

}  // namespace lrb::construct

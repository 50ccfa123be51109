#pragma once
/// Outlines of faces that are to be seen through everything.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/core/ids.hpp"
#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "render/draw_list.hpp"

namespace lrb::run {

inline constexpr float kHalo = 1.5F;  ///< round lines and points that lie over others

/// Returns the corners of a simplex in the world.
std::vector<Eigen::Vector3d> corners_of(const LrbRep& rep, const Pose& pose, SimplexId s);

/// Draws a segment, or the outline of a polygon, over everything that hides it.
void outline(render::DrawList& list, const std::vector<Eigen::Vector3d>& corners, render::Rgba colour,
             float width, render::Rgba halo = render::kWhite);

/// Draws a point over everything that hides it. `radius`: pixels.
void add_mark(render::DrawList& list, const Eigen::Vector3d& x, render::Rgba colour, float radius,
              render::Rgba halo = render::kWhite);

/// A pair that another engine got wrong: it reported faces that do not meet, or missed faces that do.
struct WrongPair {
  SimplexPair pair;
  bool missed = false;
};

/// Draws the faces of pairs that another engine got wrong.
void add_wrong_pairs(render::DrawList& list, std::span<const WrongPair> pairs, const LrbRep& a,
                     const Pose& pose_a, const LrbRep& b, const Pose& pose_b, render::Rgba halo);

}  // namespace lrb::run

#pragma once

#include <span>
#include <string>

#include "engine/lrb/lrb_rep.hpp"
#include "scenarios/run/frame_spec.hpp"

namespace lrb::run {

/// A region to show, and what is to be said of it.
struct ShownRegion {
  RegionId region = 0;
  std::string caption;
};

/// Draws one picture of regions of a body: the body's real faces by a value in panel (a), then each region
/// close up, its lids see-through over its floor, with what is around it as a ghost. Panels have the size
/// that `frames` have; (a) is seen as by their first view, a region from where its lids look, unless `frames`
/// have a view. `values` (|real faces|) are called `name`.
void draw_region_sheet(const LrbRep& rep, std::span<const double> values, const std::string& name,
                       std::span<const ShownRegion> regions, const std::string& path,
                       const render::FrameSpec& frames);

/// Returns the mean direction in which a region's lids look; zero if they look all ways alike, and in 2D.
Eigen::Vector3d outlook(const LrbRep& rep, RegionId r);

/// Returns the corners of a region's faces.
std::vector<Eigen::Vector3d> points_of(const LrbRep& rep, RegionId r);

}  // namespace lrb::run

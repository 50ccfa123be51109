#pragma once

#include <span>
#include <string>

#include "render/pictures/frame_spec.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::run {

/// Draws one picture of a body: itself, some wrappers between, and its outermost wrapper, as panels (a), (b),
/// ... of the size that `frames` have, seen as by their first view.
void draw_body_sheet(const LrbRep& rep, const std::string& path, const render::FrameSpec& frames);

/// The size of a panel unless one is asked for.
inline constexpr int kBodySheetWidth = 640, kBodySheetHeight = 520;

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

/// Says what regions are: of one, its layer, lids, floor, parent and neighbours; of several, how many there
/// are. `owner`: behind a region's number, such as " of A".
std::string region_words(const LrbRep& rep, std::span<const RegionId> regions, const std::string& owner);

}  // namespace lrb::run

#pragma once
/// Draws what a distance or a clash found: the way between the nearest points, and the way out of an overlap.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/query/clash/clash.hpp"
#include "engine/query/walk/contact_region.hpp"
#include "render/palette.hpp"
#include "render/scene.hpp"
#include "render/style.hpp"

namespace lrb::run {

/// Colours of both on a screen, and of the marks before words that say what they are.
inline constexpr render::Rgba kGapColour = render::palette::kInk;
inline constexpr render::Rgba kWayOutColour = render::palette::kGreen;

/// A straight way in the world, with what is written beside it.
struct MarkedWay {
  Eigen::Vector3d from, to;
  std::string text;
};

/// Return the way between the nearest points of bodies that are apart, or the way of B out of A, through the
/// middle of the contacts; nothing if there is none. contacts: may be empty, and then the middle is that of
/// what the boxes of the bodies share.
std::optional<MarkedWay> gap_of(const ProvedInterval& distance, const Eigen::Vector3d& point_a,
                                const Eigen::Vector3d& point_b);
std::optional<MarkedWay> way_out_of(const std::optional<ProvedInterval>& depth,
                                    const Eigen::Vector3d& translation, const LrbRep& a, const Pose& pose_a,
                                    const LrbRep& b, const Pose& pose_b,
                                    std::span<const ContactRegion> contacts);

/// Add it to a scene, over everything that hides it, with its line in the key.
void add_gap(render::Scene& scene, const MarkedWay& gap, const render::Style& style);
void add_way_out(render::Scene& scene, const MarkedWay& way, int dim);

/// Returns an interval in words: "0.25", or "0.2 to 0.3" where four digits tell its ends apart.
std::string interval_words(double lower, double upper);
/// Returns the kind of contact as people say it: "A inside B", "touching in a face".
std::string kind_words(ClashKind kind);
/// Adds the reason of a kind that is undecided: "undecided: A intersects itself".
std::string kind_words(ClashKind kind, ClashReason reason);

}  // namespace lrb::run

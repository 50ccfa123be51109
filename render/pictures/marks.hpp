#pragma once
/// Draws what a distance or a clash found: the way between the nearest points, and the way out of an overlap.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/clash.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::run {

/// How the edges of a box look.
struct BoxLook {
  render::Rgba colour;
  float width = 1, dash = 0;
  bool through = false;  ///< seen through what hides it
};

/// Adds the twelve edges of a box in the world: four round each end, and four between. `half`: from the
/// centre to the middles of three sides.
void add_box(render::DrawList& list, const Eigen::Vector3d& centre,
             const std::array<Eigen::Vector3d, 3>& half, const BoxLook& look);

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

// Outlines of faces that are to be seen through everything.

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

// The boxes of a tree's nodes, for looking at.

struct TreeBox {
  std::uint32_t node = 0;   ///< index into ObbTree::nodes()
  std::uint32_t depth = 0;  ///< 0: the root
  Eigen::Vector3d centre;   ///< body frame
  Eigen::Matrix3d half;     ///< columns: from the centre to the middles of three sides
};

/// Returns the boxes of all nodes down to the greatest depth at which they are no more than `most`, by depth.
std::vector<TreeBox> tree_boxes(const ObbTree& tree, std::size_t most);

/// Returns how many nodes there are at each depth, from the root's on.
std::vector<std::uint32_t> nodes_by_depth(const ObbTree& tree);

/// Returns the boxes of nodes below a depth that lie on the ways from the root to some simplices, in the
/// order of these, no more than `most`.
std::vector<TreeBox> boxes_on_ways(const ObbTree& tree, std::uint32_t below, const std::vector<SimplexId>& to,
                                   std::size_t most);

}  // namespace lrb::run

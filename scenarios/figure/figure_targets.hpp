#pragma once
/// Faces, regions and contacts that a figure points out, by callouts with text and insets that enlarge them.
/// Lengths are in points, x to the right, y down.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "render/canvas.hpp"
#include "render/pictures/frame_spec.hpp"
#include "scenarios/figure/figure_layout.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::figure {

struct Target {
  enum class Kind : std::uint8_t { face, region, contact } kind = Kind::face;
  std::size_t body = 0;  ///< 0: A, 1: B
  std::uint32_t number = 0;
};

/// A target with a text beside it.
struct Callout {
  std::string option;  ///< as given, for messages
  std::string panel;   ///< letter; empty: all panels
  Target target;
  std::string text;  ///< empty: the target's name
};

/// A target that is shown enlarged below a panel.
struct Inset {
  std::string option;  ///< as given, for messages
  std::string panel;   ///< letter
  Target target;
  double magnification = 0;  ///< relative to the panel; 0: chosen by the target's size
};

/// Reads "[PANEL:]face:N[=TEXT]", or "region" instead of "face"; N is a number, or aN, bN. Throws InputError.
Callout parse_callout(const std::string& text);
/// Reads "PANEL:face:N[:MAGNIFICATION]", or "region", or "contact" without N. Throws InputError.
Inset parse_inset(const std::string& text);

/// Returns true if two segments intersect, also at their ends.
bool cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& d);

/// Throws InputError with the prefix `option` if the bodies have no such face or region.
void check_target(const std::string& option, const Target& target, std::span<const LrbRep* const> reps);

/// Returns "face 12", "region 3 of B", "contact".
std::string name_of(const Target& target, std::size_t bodies);

/// Returns the outline of a face, or the border of a region's lids (2D: the whole region), as chains of
/// points that close if the last is the first.
std::vector<std::vector<Eigen::Vector3d>> outlines(const Target& target, const LrbRep& rep, const Pose& pose);

/// Adds these outlines to a list, on top of all else, with a halo. `thin`: the width of a thin line.
void add_outlines(render::DrawList& list, const Target& target, const LrbRep& rep, const Pose& pose,
                  double thin, const render::Style& style);

/// Returns the boxes of an inset's target in a view. Contacts: those of the largest, from left to right; ones
/// that overlap are one. Of the others it returns none, because the insets would be too small. Throws
/// InputError if nothing is in view.
std::vector<Eigen::AlignedBox2d> target_boxes(const Inset& inset, const render::Projection& projection,
                                              const LrbRep& rep, const Pose& pose,
                                              std::span<const ContactRegion> contacts);

/// A panel of a figure, or an inset.
struct Piece {
  const pictures::FrameSpec::View* view;
  std::size_t moment;
  std::size_t block, panel;
  PanelPlace place;
  double scale;                  ///< points per unit of the view
  const Inset* inset = nullptr;  ///< null: a panel
  double magnification = 1;
  Eigen::AlignedBox2d shown = {};  ///< part of the view
  bool has_one_line = false;       ///< of an inset: to its frame
};

/// Returns the frame of an inset in its panel, and the two lines that connect both, which may be the same.
std::array<render::Canvas::Loop, 3> frame_of(const Piece& panel, const Piece& inset);

/// Exchanges the squares of a panel's insets so that the fewest lines to their frames cross. If some cross in
/// any order, each has one line instead of two.
void uncross(const Piece& panel, std::span<Piece> insets);

/// Returns the point of a face or region that a callout points to: the centroid of the face, or of the lid
/// closest to the lids' centre.
Eigen::Vector3d anchor(const Target& target, const LrbRep& rep, const Pose& pose);

/// A callout's text and leader in a panel, in points.
struct CalloutPlace {
  Eigen::Vector2d text{0, 0};    ///< centre
  Eigen::Vector2d leader{0, 0};  ///< end of the leader at the text; the other end is the anchor
  double covered = 0;            ///< share of the text that is over content
};

inline constexpr double kPlaceStep = 1.5;  ///< greatest step between places that are tried, points

/// Chooses places for texts in a box: beside the content, close to their anchors, without overlaps, and with
/// leaders that do not cross.
/// `content`: a picture of the part `panel` of the box, transparent where it is empty. `frames`: closed lines
/// that texts do not cover. `anchors`, `sizes`: one for each text. Each size must be smaller than the box.
std::vector<CalloutPlace> place_callouts(const Eigen::AlignedBox2d& box, const Eigen::AlignedBox2d& panel,
                                         const render::Image& content,
                                         const std::vector<std::vector<Eigen::Vector2d>>& frames,
                                         const std::vector<Eigen::Vector2d>& anchors,
                                         const std::vector<Eigen::Vector2d>& sizes);

}  // namespace lrb::figure

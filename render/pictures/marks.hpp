#pragma once
/// Marks of answers in a scene: closest points, separation vector, separating plane, faces, tree boxes.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "render/pictures/panel.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/self_intersections.hpp>

namespace lrb::pictures {

/// The style of the edges of a box.
struct BoxStyle {
  render::Rgba colour;
  float width = 1, dash = 0;
  bool through = false;  ///< visible through faces in front of it
};

/// Adds the twelve edges of a box in the world. `half`: from the centre to the centres of three sides.
void add_box(render::DrawList& list, const Eigen::Vector3d& centre,
             const std::array<Eigen::Vector3d, 3>& half, const BoxStyle& style);

/// Colours on a screen, also used for the marks before texts.
inline constexpr render::Rgba kGapColour = render::palette::kInk;
inline constexpr render::Rgba kSeparationColour = render::palette::kGreen;  ///< plane and vector

/// A segment in the world, and the text beside it.
struct MarkedSegment {
  Eigen::Vector3d from, to;
  std::string text;
};

/// Returns the segment between the closest points, or nullopt if the bodies are not separate.
std::optional<MarkedSegment> gap_of(const ProvedInterval& distance, const Eigen::Vector3d& point_a,
                                    const Eigen::Vector3d& point_b);
/// Returns the separation vector of B, centred at the contacts or, if there are none, at the intersection of
/// the bodies' boxes. Returns nullopt if there is no vector.
std::optional<MarkedSegment> separation_vector_of(const std::optional<ProvedInterval>& depth,
                                                  const Eigen::Vector3d& translation,
                                                  const PosedBodies& bodies,
                                                  std::span<const ContactRegion> contacts);

/// Moves the labels that lie on their points out of the bodies, and draws lines from the points to them.
/// `frame`: the part of the picture that is shown, in the projection's pixels.
render::DrawList with_leaders(render::DrawList list, const render::Projection& projection,
                              const Eigen::AlignedBox2d& frame);

/// Add the mark to a scene, visible through all faces, and its line to the key.
void add_gap(render::Scene& scene, const MarkedSegment& gap, const render::Style& style);
void add_separation_vector(render::Scene& scene, const MarkedSegment& vector, int dim,
                           const render::Style& style);

/// A pair of faces that are near: their closest points, which are equal if the faces intersect.
struct NearMark {
  std::array<Eigen::Vector3d, 2> points;
  bool intersects = false;
};
/// Adds a thin segment between the closest points of each pair, or a point where the faces intersect.
void add_near_pairs(render::Scene& scene, std::span<const NearMark> pairs, const render::Style& style);

/// A point and its closest point on a body. `side`: nullopt: without a side.
struct PointMark {
  Eigen::Vector3d point, closest;
  std::optional<Where> side;
};
/// Returns the name and the colour of points on a side.
render::LegendItem key_of_points(std::optional<Where> side);
/// Adds the points in the colours of their sides, each with a thin segment to its closest point.
void add_point_distances(render::Scene& scene, std::span<const PointMark> points, const render::Style& style);

/// Signed distances of points to a body: all are counted, and evenly chosen ones are kept to be shown.
class ShownPoints {
 public:
  static constexpr std::size_t kMaxShown = 2000;
  struct Shown {
    std::size_t number = 0;  ///< of the point, from 0
    Eigen::Vector3d point;
    PointDistance distance;
  };
  explicit ShownPoints(std::size_t total)
      : total_(total), every_(std::max<std::size_t>(1, (total + kMaxShown - 1) / kMaxShown)) {}
  /// Takes the next points, with their distances.
  void add(std::span<const Eigen::Vector3d> points, std::span<const PointDistance> distances);

  const std::vector<Shown>& shown() const { return shown_; }
  std::vector<PointMark> marks() const;
  std::size_t total() const { return total_; }
  bool all() const { return shown_.size() == total_; }
  /// Returns the number of points on a side; nullopt: those without a side.
  std::uint64_t count(std::optional<Where> side) const { return counts_[index(side)]; }
  /// The points with the smallest and the largest distance; the first ones of several.
  const Shown& smallest() const { return smallest_; }
  const Shown& largest() const { return largest_; }
  /// Numbers the sides as Where does; points without a side come last.
  static std::size_t index(std::optional<Where> side) {
    return side ? static_cast<std::size_t>(*side) : kEnumNames<Where>.size();
  }

 private:
  std::size_t total_, every_, seen_ = 0;
  std::vector<Shown> shown_;
  std::array<std::uint64_t, kEnumNames<Where>.size() + 1> counts_{};
  Shown smallest_, largest_;
};

/// Adds the segments in which a body intersects itself.
void add_self_intersections(render::Scene& scene, const SelfIntersections& found, const render::Style& style);
/// Returns the name and the colour of the segments of a kind.
render::LegendItem key_of(SelfContact kind);

/// A point of a contact manifold, on B's surface.
struct ContactMark {
  Eigen::Vector3d point, normal;
  double depth = 0;  ///< negative: a gap
};
/// Returns the lengths of the arrows for normals. The longest, at the deepest point, is as long as the
/// contact, within limits set by the size of the bodies.
std::vector<double> normal_lengths(std::span<const ContactMark> contacts, double size);
/// Adds the points with their normals as arrows. `margin`: of speculative contacts. `size`: of the bodies.
void add_contact_points(render::Scene& scene, std::span<const ContactMark> contacts, double margin,
                        double size, const render::Style& style);

/// Adds the separating plane, or otherwise the closest pair of separated boxes and a plane between them. Adds
/// nothing without plane and boxes. `through`: boxes are visible through faces in front of them.
void add_separating_plane(render::DrawList& list, const WalkExplanation& walk, const PosedBodies& bodies,
                          const render::Style& style, bool through = false);

/// Returns a short text with a lower bound on the distance of the surfaces: "by a plane, gap >= 0.12".
/// Returns an empty text without plane and boxes.
std::string separating_plane_text(const WalkExplanation& walk, const PosedBodies& bodies);

/// The corners of a square in the world. In 2D it is a segment between corners 0 and 1.
using Square = std::array<Eigen::Vector3d, 4>;
/// Returns a square in the middle of the gap at a separating plane, near the centre of the smaller body and
/// scaled to it.
Square separating_square(const SeparatingPlane& plane, const PosedBodies& bodies);
/// Returns a square in the gap between two boxes, scaled to the smaller one.
Square separating_square(const SeparatingBoxes& boxes, int dim);
/// Returns the square of the separating plane, or otherwise of the boxes. Returns nullopt if there is
/// neither.
std::optional<Square> separating_square(const WalkExplanation& walk, const PosedBodies& bodies);

/// Adds two boxes that are disjoint, as lines in their bodies' edge colours.
void add_boxes(render::DrawList& list, const SeparatingBoxes& disjoint, const render::Style& style,
               bool through);

/// Adds a translucent convex polygon in the colour of separating planes.
void add_sheet(render::DrawList& list, const std::vector<Eigen::Vector3d>& corners);

/// Returns an interval as text: "0.25", or "0.2 to 0.3" if its ends differ in four digits.
std::string interval_text(double lower, double upper);
/// Returns the kind of contact as text: "A inside B", "touching in faces".
std::string kind_text(ClashKind kind);
/// Appends the reason if the kind is undecided: "undecided: A intersects itself".
std::string kind_text(ClashKind kind, ClashReason reason);

// Outlines that are visible through all faces.

inline constexpr float kHalo = 1.5F;  ///< width of the halo around lines and points

/// Returns the corners of a simplex in the world.
std::vector<Eigen::Vector3d> corners_of(const LrbRep& rep, const Pose& pose, SimplexId s);

/// Adds a segment or the outline of a polygon.
void outline(render::DrawList& list, const std::vector<Eigen::Vector3d>& corners, render::Rgba colour,
             float width, render::Rgba halo = render::kWhite);

/// Adds a point. `radius`: pixels.
void add_mark(render::DrawList& list, const Eigen::Vector3d& x, render::Rgba colour, float radius,
              render::Rgba halo = render::kWhite);

/// Adds an arrow.
void add_arrow(render::DrawList& list, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
               render::Rgba colour);

/// A wrong pair in another engine's answer: disjoint faces that were reported, or intersecting faces that
/// were missed.
struct WrongPair {
  SimplexPair pair;
  bool missed = false;
};

/// Adds the outlines of the faces of wrong pairs.
void add_wrong_pairs(render::DrawList& list, std::span<const WrongPair> pairs, const PosedBodies& bodies,
                     render::Rgba halo);

// Boxes of tree nodes.

struct TreeBox {
  std::uint32_t node = 0;   ///< index into ObbTree::nodes()
  std::uint32_t depth = 0;  ///< 0: the root
  Eigen::Vector3d centre;   ///< body frame
  Eigen::Matrix3d half;     ///< columns: from the centre to the centres of three sides
};

/// Returns the boxes of all nodes by depth, down to the maximum depth with at most `most` boxes in total.
std::vector<TreeBox> tree_boxes(const ObbTree& tree, std::size_t most);

/// Returns the number of nodes at each depth, starting at the root.
std::vector<std::uint32_t> nodes_by_depth(const ObbTree& tree);

/// Returns the boxes of nodes deeper than `below` on the paths from the root to the given simplices, in the
/// order of the simplices, at most `most`.
std::vector<TreeBox> boxes_on_paths(const ObbTree& tree, std::uint32_t below,
                                    const std::vector<SimplexId>& to, std::size_t most);

}  // namespace lrb::pictures

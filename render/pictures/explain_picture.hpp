#pragma once
/// Draws what parts two bodies that are apart: a plane between them, else the nearest of the boxes that the
/// walk found apart.

#include <array>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <lrbscope/collide.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::run {

/// Draws two faces with the bodies about them: where they meet, or else the line between their nearest points
/// and a plane across it, which has them on different sides. Throws EnvironmentError if the file cannot be
/// written.
void draw_pair(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
               const PairExplanation& pair, const std::string& path);

/// The colour of the plane, and of the mark before words that say what it is.
inline constexpr render::Rgba kPartingColour = render::palette::kGreen;

/// Adds it. Adds nothing where neither was found. `through`: boxes are seen through what hides them.
void add_parting(render::DrawList& list, const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a,
                 const LrbRep& b, const Pose& pose_b, const render::Style& style, bool through = false);

/// Returns it in a few words, with a lower bound of the distance of the bodies' surfaces: "a plane parts
/// them, gap >= 0.12"; empty where neither was found.
std::string parting_words(const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                          const Pose& pose_b);

/// Draws both bodies with it into a picture: the whole, and beside it, where something was found, a close-up
/// along it.
void draw_parting(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const WalkExplanation& walk, const std::string& path);

/// Returns the corners of a square in the middle of the gap that a plane parts, as large as the smaller of
/// the two bodies, before its middle. World. In the plane (2D) it is a strip: corners 0 and 1 end its line.
using Square = std::array<Eigen::Vector3d, 4>;
Square parting_square(const PartingPlane& plane, const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                      const Pose& pose_b);

/// Returns the same for two boxes, as large as the smaller of them.
Square parting_square(const PartedBoxes& boxes, int dim);

/// Returns that of the plane that was found, else of the boxes; nothing where neither was.
std::optional<Square> parting_square(const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a,
                                     const LrbRep& b, const Pose& pose_b);

/// Draws two bodies that are apart under the wrappers that prove it: as they come in panel (a), refined as
/// far as was needed in panel (b).
void draw_separation(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const Separation& separation, const std::string& path);

}  // namespace lrb::run

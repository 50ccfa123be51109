#pragma once
/// Draws what parts two bodies that are apart: a plane between them, else the nearest of the boxes that the
/// walk found apart.

#include <string>

#include "engine/query/explain.hpp"
#include "render/palette.hpp"
#include "render/scene.hpp"

namespace lrb::run {

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

}  // namespace lrb::run

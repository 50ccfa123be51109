#pragma once
/// How pictures look as a whole: on a screen, on paper, on a dark slide. What is drawn means the same in
/// each; colour scales and categories are the palette's in all of them.

#include <array>
#include <cstdint>

#include "render/palette.hpp"

namespace lrb::render {

enum class StyleName : std::uint8_t { screen, print, dark };

struct Style {
  Rgba paper;                  ///< the background, and what pale colours fade towards
  Rgba ink, faint, rule;       ///< text; what is less important; thin frames
  std::array<Rgba, 2> bodies;  ///< A's and B's
  Rgba contact, refining, under_test;
  Rgba front, back;    ///< of faces that a picture of findings is not about
  Rgba edge_ink;       ///< what lines along bodies differ from them towards
  Rgba solid_ink;      ///< the same of solids under regions, in 2D
  double solid_share;  ///< how far those do
  double lid_pale;     ///< how far pseudo faces fade towards the paper
  float weight;        ///< factor of the widths of lines and points: paper shows finer ones than a screen

  /// Returns the colour of lines along what has colour `c`: outlines, and edges of what one sees through.
  /// (Edges on solid faces are palette::edge_of() in every style: a face is no paper.)
  constexpr Rgba edge_of(Rgba c) const { return mix(c, edge_ink, kEdgeShare); }
  /// Returns a colour faded by `share`.
  constexpr Rgba pale(Rgba c, double share) const { return mix(c, paper, share); }
  /// Returns the colour of a solid under pseudo faces in 2D, which stands out from the regions around it (the
  /// paper's figure 1).
  constexpr Rgba solid_2d(Rgba c) const { return mix(c, solid_ink, solid_share); }
  /// Returns the colour of a body.
  constexpr Rgba body(Side side) const { return bodies[static_cast<std::size_t>(side)]; }
  /// Returns the colour that this style has for one of the palette's kinds; any other colour as it is.
  Rgba of(Rgba kind) const;

 private:
  static constexpr double kEdgeShare = 0.72;
};

const Style& style_of(StyleName name);

}  // namespace lrb::render

#pragma once
/// How pictures look as a whole: on a screen, on paper, on a dark slide. What is drawn means the same in
/// each; colour scales and categories are the palette's in all of them.

#include <array>
#include <cstdint>

#include <lrbscope/ids.hpp>
#include <lrbscope/observe.hpp>

namespace lrb::render {

/// A colour in 8-bit sRGB with straight (not premultiplied) alpha.
struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  friend bool operator==(const Rgba&, const Rgba&) = default;
};

constexpr Rgba with_alpha(Rgba c, std::uint8_t a) {
  return {c.r, c.g, c.b, a};
}

/// Moves `c` towards `to` by t in [0, 1], channel by channel, alpha included.
constexpr Rgba mix(Rgba c, Rgba to, double t) {
  const auto channel = [t](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(x + (static_cast<double>(y) - x) * t + 0.5);
  };
  return {channel(c.r, to.r), channel(c.g, to.g), channel(c.b, to.b), channel(c.a, to.a)};
}

/// Returns x / 255 rounded to nearest, for a product x of two bytes.
constexpr int div255(int x) {
  return (x + 127) / 255;
}

/// Paints `top` over `below`, with `coverage` (0..255) as a further factor of its alpha. Computes in integers
/// only, so that every machine gives the same bytes.
constexpr Rgba over(Rgba top, Rgba below, int coverage = 255) {
  const int at = div255(top.a * coverage);
  if (at == 255) return top;
  if (at == 0) return below;
  const int ab = div255(below.a * (255 - at));
  const int a = at + ab;
  const auto channel = [&](int t, int b) { return static_cast<std::uint8_t>((t * at + b * ab + a / 2) / a); };
  return {channel(top.r, below.r), channel(top.g, below.g), channel(top.b, below.b),
          static_cast<std::uint8_t>(a)};
}

/// Returns the luma of Rec. 601, 0..255: how bright the colour is in a greyscale print.
constexpr double luma(Rgba c) {
  return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
}

inline constexpr Rgba kWhite{255, 255, 255};
inline constexpr Rgba kBlack{0, 0, 0};
inline constexpr Rgba kTransparent{0, 0, 0, 0};

}  // namespace lrb::render

namespace lrb::render::palette {

// The colours of all pictures; render/page_palette.hpp has those of pages. Categories are from Okabe and
// Ito's palette, which people with any common colour vision can tell apart (M. Okabe, K. Ito, "Color
// Universal Design", 2008); scalars are viridis. What must be told apart also differs in brightness, for
// print in grey.

inline constexpr Rgba kOrange{230, 159, 0};
inline constexpr Rgba kSkyBlue{86, 180, 233};
inline constexpr Rgba kGreen{0, 158, 115};
inline constexpr Rgba kYellow{240, 228, 66};
inline constexpr Rgba kBlue{0, 114, 178};
inline constexpr Rgba kVermillion{213, 94, 0};
inline constexpr Rgba kPurple{204, 121, 167};

/// Text, and what is less important.
inline constexpr Rgba kInk{28, 30, 34};
inline constexpr Rgba kFaint{110, 114, 120};
inline constexpr Rgba kRule{205, 208, 212};

/// Faces that the picture is not about: their fronts, and their backs.
inline constexpr Rgba kPaleFront{233, 235, 238};
inline constexpr Rgba kPaleBack{178, 170, 160};

/// Contacts: darker than vermillion, so that they stand out from both bodies also in grey.
inline constexpr Rgba kContact{196, 18, 48};
inline constexpr Rgba kWrong{255, 0, 0};  ///< what another engine got wrong: brighter than contacts
inline constexpr Rgba kRefining = kGreen;
inline constexpr Rgba kRefining2d = mix(kGreen, kWhite, 0.4);  ///< as a fill, under lines
inline constexpr Rgba kUnderTest = kYellow;

/// What edges and solids differ from their body's colour towards, and by how much.
inline constexpr Rgba kEdgeInk{18, 20, 24};
inline constexpr double kEdgeShare = 0.72;
inline constexpr Rgba kSolidInk{10, 14, 20};
inline constexpr double kSolidShare = 0.28;

/// How far faces fade towards the paper: pseudo faces, real faces beside coloured regions, and faces without
/// a value.
inline constexpr double kLidPale = 0.70;
inline constexpr double kGroundPale = 0.75;
inline constexpr double kNoValuePale = 0.78;

/// Returns the colour of a body: blue or orange, which differ in brightness too.
constexpr Rgba body(Side side) {
  return side == Side::a ? Rgba{52, 126, 190} : Rgba{236, 168, 52};
}
/// Returns the colour of real faces' edges: the body's, much darker.
constexpr Rgba edge_of(Rgba c) {
  return mix(c, kEdgeInk, kEdgeShare);
}
/// Returns the colour of a solid under pseudo faces in 2D: darker than the regions around it (the paper's
/// figure 1).
constexpr Rgba solid_2d(Rgba c) {
  return mix(c, kSolidInk, kSolidShare);
}
constexpr Rgba region_2d(Rgba c) {
  return mix(c, kWhite, 0.62);
}

/// Returns the colour of a kind of events.
constexpr Rgba event(EventKind kind) {
  switch (kind) {
    case EventKind::step:
      return kFaint;
    case EventKind::face_test:
      return kUnderTest;
    case EventKind::refine:
      return kRefining;
    case EventKind::coarsen:
      return kPurple;
    case EventKind::contact:
      return kContact;
    case EventKind::node_pair:
    case EventKind::plane_test:
    case EventKind::point:
      return kUnderTest;
    case EventKind::begin:
    case EventKind::end:
      return kFaint;
    case EventKind::cap:
      return kVermillion;
    case EventKind::patch:
      return kUnderTest;
    case EventKind::region:
    case EventKind::merged:
      return kRefining;
    case EventKind::pass:
    case EventKind::pass_end:
      return kBlue;
    case EventKind::result:
    case EventKind::closed:
      return kInk;
  }
  return kInk;
}

/// Maps t in [0, 1] to viridis, from dark blue to yellow, brighter all the way. Clamps t; a NaN counts as 0.
Rgba viridis(double t);

/// Returns a colour for each of many categories: hues go round by the golden angle, brightness in three
/// steps, so that close numbers get colours that are not close.
Rgba category(std::uint32_t index);

}  // namespace lrb::render::palette

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
  constexpr Rgba edge_of(Rgba c) const { return mix(c, edge_ink, palette::kEdgeShare); }
  /// Returns a colour faded by `share`.
  constexpr Rgba pale(Rgba c, double share) const { return mix(c, paper, share); }
  /// Returns the colour of a solid under pseudo faces in 2D, which stands out from the regions around it (the
  /// paper's figure 1).
  constexpr Rgba solid_2d(Rgba c) const { return mix(c, solid_ink, solid_share); }
  /// Returns the colour of a body.
  constexpr Rgba body(Side side) const { return bodies[static_cast<std::size_t>(side)]; }
  /// Returns the colour that this style has for one of the palette's kinds; any other colour as it is.
  Rgba of(Rgba kind) const;
};

const Style& style_of(StyleName name);

}  // namespace lrb::render

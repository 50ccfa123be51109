#pragma once
/// Picture styles: screen, paper, dark slide. Colours have the same meaning in each; colour scales and
/// categories are the palette's in all of them.

#include <array>
#include <cstdint>

#include <lrbscope/enum_names.hpp>
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

/// Moves `c` towards `to` by t in [0, 1], channel by channel, including alpha.
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

/// Blends `top` over `below`, with `coverage` (0..255) as a further factor of its alpha. Integer arithmetic
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

/// Returns the luma of Rec. 601, 0..255: the brightness of the colour in a greyscale print.
constexpr double luma(Rgba c) {
  return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
}

inline constexpr Rgba kWhite{255, 255, 255};
inline constexpr Rgba kBlack{0, 0, 0};
inline constexpr Rgba kTransparent{0, 0, 0, 0};

}  // namespace lrb::render

namespace lrb::render::palette {

// The colours of all pictures; render/page_palette.hpp has those of pages. Categories are Okabe and Ito's
// palette, distinguishable with any common colour vision (M. Okabe, K. Ito, "Color Universal Design", 2008);
// scalars go from pale to dark. Colours that must be distinguished also differ in brightness, for greyscale
// print.

inline constexpr Rgba kOrange{230, 159, 0};
inline constexpr Rgba kSkyBlue{86, 180, 233};
inline constexpr Rgba kGreen{0, 158, 115};
inline constexpr Rgba kYellow{240, 228, 66};
inline constexpr Rgba kBlue{0, 114, 178};
inline constexpr Rgba kVermillion{213, 94, 0};
inline constexpr Rgba kPurple{204, 121, 167};

/// Text, and secondary text.
inline constexpr Rgba kInk{28, 30, 34};
inline constexpr Rgba kFaint{110, 114, 120};
inline constexpr Rgba kRule{205, 208, 212};

/// Faces outside the picture's focus: fronts and backs.
inline constexpr Rgba kPaleFront{233, 235, 238};
inline constexpr Rgba kPaleBack{178, 170, 160};

/// Contacts: darker than vermillion, so that they contrast with both bodies in greyscale as well.
inline constexpr Rgba kContact{196, 18, 48};
inline constexpr Rgba kWrong{200, 0, 190};  ///< errors of another engine: not the red of contacts
inline constexpr Rgba kRefining = kGreen;
inline constexpr Rgba kUnderTest = kYellow;

/// The colour that edges and solids are mixed towards from their body's colour, and the mixing shares.
inline constexpr Rgba kEdgeInk{18, 20, 24};
inline constexpr double kEdgeShare = 0.72;
inline constexpr Rgba kSolidInk{10, 14, 20};
inline constexpr double kSolidShare = 0.28;

/// Shares by which faces fade towards the paper: pseudo faces, real faces beside coloured regions, and faces
/// without a value.
inline constexpr double kLidPale = 0.70;
inline constexpr double kGroundPale = 0.75;
inline constexpr double kNoValuePale = 0.78;

/// Returns the colour of a body: blue or orange, which also differ in brightness.
constexpr Rgba body(Side side) {
  return side == Side::a ? Rgba{52, 126, 190} : Rgba{236, 168, 52};
}
/// Returns the colour of real faces' edges: the body's, much darker.
constexpr Rgba edge_of(Rgba c) {
  return mix(c, kEdgeInk, kEdgeShare);
}
/// Returns the colour of a solid under pseudo faces in 2D: darker than the regions around it (figure 1 of the
/// paper).
constexpr Rgba solid_2d(Rgba c) {
  return mix(c, kSolidInk, kSolidShare);
}

/// Returns the colour of a kind of event.
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

/// Maps t in [0, 1] to a scale of purples that starts almost white and ends dark. Clamps t; NaN counts as 0.
Rgba heat(double t);

/// Returns a colour for each of many categories: hues advance by the golden angle, brightness in three steps,
/// so that consecutive numbers get distinct colours.
Rgba category(std::uint32_t index);

}  // namespace lrb::render::palette

namespace lrb::render {

enum class StyleName : std::uint8_t { screen, print, dark };
constexpr auto enum_names(StyleName) {
  using Word = StyleName;
  return std::to_array<EnumName<Word>>(
      {{Word::screen, "screen"}, {Word::print, "print"}, {Word::dark, "dark"}});
}

struct Style {
  Rgba paper;                  ///< the background, which pale colours are mixed towards
  Rgba ink, faint, rule;       ///< text; secondary text; thin frames
  std::array<Rgba, 2> bodies;  ///< A's and B's
  Rgba contact, refining, under_test;
  Rgba front, back;  ///< faces outside the focus of a picture of findings
  Rgba edge_ink;     ///< colour that lines along bodies are mixed towards
  Rgba solid_ink;    ///< colour that solids under regions are mixed towards, in 2D
  // Of A and B, which differ in lightness also where colours are pale or dark:
  std::array<double, 2> solid_share;  ///< mixing share of solid_ink
  std::array<double, 2> lid_pale;     ///< share by which pseudo faces fade towards the paper
  std::array<double, 2> edge_share;   ///< mixing share of edge_ink for lines along the body's wrapper
  float weight;  ///< factor of the widths of lines and points: paper resolves finer ones than a screen
  bool rising;   ///< colours of values get brighter with the value, on a dark background; else darker

  /// Returns the colour of lines along primitives of colour `c`: outlines, and edges of translucent faces.
  /// (Edges on solid faces are palette::edge_of() in every style, because they are not on paper.)
  constexpr Rgba edge_of(Rgba c) const { return mix(c, edge_ink, palette::kEdgeShare); }
  /// Returns a colour faded by `share`.
  constexpr Rgba pale(Rgba c, double share) const { return mix(c, paper, share); }
  /// Returns the colour of a solid under pseudo faces in 2D, which contrasts with the regions around it
  /// (figure 1 of the paper).
  constexpr Rgba solid_2d(Rgba c, Side side) const {
    return mix(c, solid_ink, solid_share[static_cast<std::size_t>(side)]);
  }
  /// Returns the colour of the wrapper's lines of a body of colour `c`.
  constexpr Rgba wrapper_edge(Rgba c, Side side) const {
    return mix(c, edge_ink, edge_share[static_cast<std::size_t>(side)]);
  }
  /// Returns the colour of a body.
  constexpr Rgba body(Side side) const { return bodies[static_cast<std::size_t>(side)]; }
  /// Returns the colour of a value at place t, in [0, 1], of a scale, of which the low end is near the paper.
  Rgba value(double t) const { return palette::heat(rising ? 1 - t : t); }
  /// Returns this style's colour for one of the palette's kinds; any other colour unchanged.
  Rgba of(Rgba kind) const;
};

const Style& style_of(StyleName name);

}  // namespace lrb::render

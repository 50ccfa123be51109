#pragma once
/// Every colour of the project, in one place. Categories are from Okabe and Ito's palette, which people with
/// any common colour vision can tell apart (M. Okabe, K. Ito, "Color Universal Design", 2008); scalars are
/// viridis. What must be told apart also differs in brightness, for print in grey.

#include <cstdint>

#include "engine/core/ids.hpp"
#include "engine/query/walk/probe.hpp"
#include "render/colour.hpp"

namespace lrb::render::palette {

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

/// Returns the colour of a body: blue or orange, which differ in brightness too.
constexpr Rgba body(Side side) {
  return side == Side::a ? Rgba{52, 126, 190} : Rgba{236, 168, 52};
}
/// Returns the colour of real faces' edges: the body's, much darker.
constexpr Rgba edge_of(Rgba c) {
  return mix(c, {18, 20, 24}, 0.72);
}
/// Returns the colour of a solid under pseudo faces in 2D: darker than the regions around it (the paper's
/// figure 1).
constexpr Rgba solid_2d(Rgba c) {
  return mix(c, {10, 14, 20}, 0.28);
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

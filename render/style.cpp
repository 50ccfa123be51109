#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <lrbscope/render/style.hpp>

namespace lrb::render::palette {

Rgba heat(double t) {
  // In hues that neither bodies nor events have; the lightness in Oklab falls from 0.94 to 0.27.
  static constexpr std::array<Rgba, 5> kStops = {
      {{238, 232, 243}, {205, 184, 221}, {166, 118, 190}, {122, 54, 149}, {66, 10, 92}}};
  const double at = (t > 0 ? std::min(t, 1.0) : 0.0) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  return mix(kStops[i], kStops[i + 1], at - static_cast<double>(i));
}

Rgba category(std::uint32_t index) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr std::array<double, 3> kLightness = {0.70, 0.80, 0.60};
  constexpr double kChroma = 0.115;
  const double hue = 2 * std::numbers::pi * std::fmod(0.08 + kGolden * index, 1.0);
  const double l = kLightness[index % kLightness.size()];
  const glm::dvec3 lab(l, kChroma * std::cos(hue), kChroma * std::sin(hue));
  // Oklab to linear RGB (B. Ottosson, "A perceptual color space for image processing", 2020). Matrices by
  // columns.
  constexpr glm::dmat3 kLabToRoots(1, 1, 1, 0.3963377774, -0.1055613458, -0.0894841775, 0.2158037573,
                                   -0.0638541728, -1.2914855480);
  constexpr glm::dmat3 kLmsToRgb(4.0767416621, -1.2684380046, -0.0041960863, -3.3077115913, 2.6097574011,
                                 -0.7034186147, 0.2309699292, -0.3413193965, 1.7076147010);
  const glm::dvec3 roots = kLabToRoots * lab;
  const glm::dvec3 rgb = kLmsToRgb * (roots * roots * roots);
  const auto byte = [](double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(255 * s + 0.5);
  };
  return {byte(rgb.r), byte(rgb.g), byte(rgb.b)};
}

}  // namespace lrb::render::palette

namespace lrb::render {
namespace {

constexpr Style kScreen = {.paper = kWhite,
                           .ink = palette::kInk,
                           .faint = palette::kFaint,
                           .rule = palette::kRule,
                           .bodies = {palette::body(Side::a), palette::body(Side::b)},
                           .contact = palette::kContact,
                           .refining = palette::kRefining,
                           .under_test = palette::kUnderTest,
                           .front = palette::kPaleFront,
                           .back = palette::kPaleBack,
                           .edge_ink = palette::kEdgeInk,
                           .solid_ink = palette::kSolidInk,
                           .solid_share = {palette::kSolidShare, palette::kSolidShare},
                           .lid_pale = {palette::kLidPale, palette::kLidPale},
                           .edge_share = {palette::kEdgeShare, palette::kEdgeShare},
                           .weight = 1,
                           .rising = false};

/// Black on white; kinds differ more in lightness than on a screen, for greyscale print. B is lighter than A
/// in everything: faces, pseudo faces and lines.
constexpr Style kPrint = {.paper = kWhite,
                          .ink = kBlack,
                          .faint = {84, 86, 90},
                          .rule = {170, 172, 176},
                          .bodies = {Rgba{82, 146, 206}, Rgba{240, 186, 84}},
                          .contact = {150, 0, 36},
                          .refining = {0, 116, 82},
                          .under_test = {248, 238, 120},
                          .front = {240, 241, 243},
                          .back = palette::kPaleBack,
                          .edge_ink = kBlack,
                          .solid_ink = palette::kSolidInk,
                          .solid_share = {0.48, 0.28},
                          .lid_pale = {0.80, 0.90},
                          .edge_share = {0.80, 0.50},
                          .weight = 0.7F,
                          .rising = false};

/// For slides: almost black background, light lines and texts.
constexpr Style kDark = {.paper = {20, 22, 27},
                         .ink = {236, 238, 241},
                         .faint = {160, 165, 173},
                         .rule = {70, 75, 83},
                         .bodies = {Rgba{48, 106, 168}, Rgba{232, 170, 66}},
                         .contact = {240, 56, 84},
                         .refining = {24, 172, 126},
                         .under_test = {248, 238, 110},
                         .front = {120, 124, 130},
                         .back = {78, 68, 60},
                         .edge_ink = {240, 242, 245},
                         .solid_ink = {240, 242, 245},
                         .solid_share = {0, 0},
                         .lid_pale = {0.25, 0.25},
                         .edge_share = {palette::kEdgeShare, palette::kEdgeShare},
                         .weight = 1.15F,
                         .rising = true};

}  // namespace

Rgba Style::of(Rgba kind) const {
  if (kind == palette::kInk) return ink;
  if (kind == palette::kFaint) return faint;
  if (kind == palette::kRule) return rule;
  if (kind == palette::kContact) return contact;
  if (kind == palette::kRefining) return refining;
  if (kind == palette::kUnderTest) return under_test;
  return kind;
}

const Style& style_of(StyleName name) {
  switch (name) {
    case StyleName::print:
      return kPrint;
    case StyleName::dark:
      return kDark;
    case StyleName::screen:
      break;
  }
  return kScreen;
}

}  // namespace lrb::render

#include "render/style.hpp"

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
                           .edge_ink = {18, 20, 24},
                           .solid_ink = {10, 14, 20},
                           .solid_share = 0.28,
                           .lid_pale = 0.70,
                           .weight = 1};

/// Black on white; kinds lie further apart in lightness than on a screen, for presses without colours.
constexpr Style kPrint = {.paper = kWhite,
                          .ink = kBlack,
                          .faint = {84, 86, 90},
                          .rule = {170, 172, 176},
                          .bodies = {Rgba{82, 146, 206}, Rgba{240, 186, 84}},
                          .contact = {150, 0, 36},
                          .refining = {0, 116, 82},
                          .under_test = {248, 238, 120},
                          .front = {240, 241, 243},
                          .back = {178, 170, 160},
                          .edge_ink = kBlack,
                          .solid_ink = {10, 14, 20},
                          .solid_share = 0.34,
                          .lid_pale = 0.70,
                          .weight = 0.7F};

/// For slides: nearly black behind, lines and texts light.
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
                         .solid_share = 0,
                         .lid_pale = 0.25,
                         .weight = 1.15F};

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

#pragma once
/// Puts pictures side by side in one image: figures with (a), (b), (c), or the whole beside a close-up.

#include <string>
#include <vector>

#include "render/image.hpp"
#include "render/style.hpp"

namespace lrb::render {

struct Panel {
  Image image;
  std::string caption;  ///< below the panel, after its letter; may be empty
};

struct MontageOptions {
  int columns = 0;      ///< 0: the number that brings the montage closest to 4:3
  int gutter = -1;      ///< between and around panels, pixels; -1: a twenty-fourth of a panel's smaller side
  bool letters = true;  ///< (a), (b), ... below each panel
  bool frame = false;   ///< a thin line round each panel
  float text_height = 0;  ///< pixels; 0: a twentieth of the panels' height, at least 12
  Rgba background = kWhite;
  StyleName style = StyleName::screen;  ///< of captions and frames
};

struct MontageLayout {
  int width = 0, height = 0;
  std::vector<PixelRect> panels;                ///< where the images go
  std::vector<PixelRect> captions;              ///< room below each
  std::vector<std::vector<std::string>> lines;  ///< their text, wrapped
  float text_height = 0;
};

/// Lays panels out row by row. Images of different sizes are centred in cells; a column has one width, a row
/// one height. Throws InputError without panels.
MontageLayout lay_out(const std::vector<Panel>& panels, const MontageOptions& options = {});
Image montage(const std::vector<Panel>& panels, const MontageOptions& options = {});

/// Returns "(a)" .. "(z)", "(aa)" ...
std::string panel_letter(std::size_t index);

}  // namespace lrb::render

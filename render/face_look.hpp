#pragma once
/// Colours of faces and edges, and widths of edges, as they are drawn: shaded, and faded where faces are
/// small on the screen. Rasterized and vector pictures use the same.

#include <cstdint>
#include <vector>

#include "render/edge_spacing.hpp"
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::render {

struct FaceLook {
  Rgba colour;                      ///< of opaque faces: with alpha 255
  Rgba edge_colour = kTransparent;  ///< to be blended over `colour`
  double edge_width = 0;            ///< pixels of the projection, over both faces of the edge
  std::uint8_t edges = 0;           ///< those of DrawTriangle::edges that are drawn
};

class FaceLooks {
 public:
  /// `scale`: pixels of the projection per unit of the list's widths. Other arguments as in
  /// make_screen_mesh(). Keeps references to list and projection.
  FaceLooks(const DrawList& list, const Projection& projection, double scale, const Lighting& lighting,
            bool even_edges);

  /// Returns the look of one of the list's triangles.
  FaceLook of(const DrawTriangle& t) const;

 private:
  /// Sets the edges: where the face is small on the screen they are fainter and thinner.
  void add_edges(const DrawTriangle& t, FaceLook& look) const;
  bool shows_back(const DrawTriangle& t) const;

  const DrawList& list_;
  const Projection& projection_;
  double scale_;
  Lighting lighting_;
  Lighting soft_;                           ///< of translucent faces: they should tint, not darken
  std::vector<double> spacing_;             ///< by triangle: see edge_spacing()
  std::vector<StyleSpacing> even_spacing_;  ///< by style; empty: edges fade individually
};

}  // namespace lrb::render

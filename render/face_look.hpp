#pragma once
/// Colours of faces and edges, and widths of edges, as they are drawn: shaded, and faded where faces are
/// small on the screen: otherwise dense meshes would turn black. Rasterized and vector pictures use the same.
/// And ambient occlusion: faces in creases and gaps get less light from the sky.

#include <cstdint>
#include <vector>

#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::render {

/// Returns for every triangle the smoothed altitude on the screen, in the projection's pixels: the mean over
/// its corners of the mean over the triangles that share the corner and the edge style. (A triangle's
/// altitude is its smallest.) Altitudes of single triangles vary abruptly, and edges that fade by them look
/// patchy; these means vary gradually. 0 for triangles without edges.
std::vector<double> edge_spacing(const DrawList& list, const Projection& projection);

/// The spacing of the edges of one style, in pixels.
struct StyleSpacing {
  double all = 0;  ///< median altitude of the triangles, weighted by area on the screen
  /// Mean spacing of borders alone: the altitude of equilateral triangles with as much edge length in the
  /// same area. Infinite: the style has none.
  double borders = 0;
};

/// Returns the spacing of each style, so that all edges of a style fade together.
std::vector<StyleSpacing> even_edge_spacing(const DrawList& list, const Projection& projection);

/// Rises smoothly from 0 at `gone` to 1 at `full`.
double fade_between(double x, double gone, double full);

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

/// Darkens each opaque lit triangle by the share of directions, weighted by the cosine to its normal, in
/// which opaque triangles hide the sky from its centroid. The result does not depend on a camera.
void add_ambient_occlusion(DrawList& list, Rasterizer& rasterizer);

}  // namespace lrb::render

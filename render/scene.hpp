#pragma once
/// Makes a draw list with its legend from LRB-reps, wrapper states, poses and what is to be pointed out. Pure
/// data in and out: no graphics library, no files.
///
/// 3D: real faces are solid, in full colour where the wrapper has come down to them and paler where it has
/// not; pseudo faces of the wrapper's boundary are translucent, with outlines. 2D: the solid is dark,
/// included regions are light (the paper's figure 1), the wrapper's boundary is a strong line.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/pose.hpp"
#include "engine/exact/simplex_test.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/lrb/wrapper.hpp"
#include "engine/query/walk/contact_region.hpp"
#include "render/draw_list.hpp"
#include "render/overlay.hpp"
#include "render/style.hpp"

namespace lrb::render {

struct SceneBody {
  const LrbRep* rep = nullptr;
  const Wrapper* wrapper = nullptr;  ///< null: the real faces alone are drawn
  Pose pose;
  std::span<const double> face_values;  ///< (|F|) for ColourBy::value; empty: none
  std::string name;                     ///< in the legend; empty: "A", "B"
  std::optional<Rgba> colour = {};      ///< nothing: the colour of the side
  /// (|real F|) or (|F|): faces whose entry is not 0 are drawn in the contacts' colour; empty: none. Includes
  /// pseudo faces where a wrapper is shown, even if it has been refined beyond them.
  std::span<const std::uint8_t> in_contact = {};
};

enum class ColourBy : std::uint8_t {
  kind,    ///< body colours; real and pseudo faces told apart
  layer,   ///< pseudo faces by the layer of the region they hide, viridis
  region,  ///< pseudo faces by the region they hide, a category each
  value,   ///< faces by SceneBody::face_values, viridis: face tests, refinements, ...
};

/// What the current event is about.
struct SceneHighlight {
  std::array<std::vector<RegionId>, 2> refining;       ///< of A and B
  std::optional<std::array<SimplexId, 2>> under_test;  ///< a simplex of A, one of B
  std::span<const ContactRegion> contacts;
  /// Regions of A that a construction has just made, ascending: in full colour with a rim, and those that it
  /// made before pale. Nothing: no construction is shown.
  std::optional<std::vector<RegionId>> built = {};
};

struct SceneOptions {
  ColourBy colour_by = ColourBy::kind;
  std::string value_name = "face tests";             ///< shown at the scale bar of ColourBy::value
  std::optional<std::array<double, 2>> value_range;  ///< nothing: from 0 to the largest value of the scene
  std::array<std::vector<RegionId>, 2>
      isolate;  ///< regions of A and B; if there are any, only these are shown, and the rest as ghosts
  bool ghost_rest = true;  ///< false: the rest is left out
  double explode = 0;      ///< included regions move outward by this share of their distance from the body's
                           ///< centre; 0: they stay in place, as lids
  bool real_edges = true;
  bool contact_rims = false;  ///< 3D: faces in contact get a rim that is seen through what lies in front
  float scale = 1;            ///< of line widths and points: for large pictures and print
  StyleName style = StyleName::screen;
};

struct Scene {
  DrawList list;
  std::vector<LegendItem> key;
  std::optional<ScaleBar> scale;
};

/// Builds the scene. Triangles and fills carry the id face_id() (fills of regions: region_id()). Throws
/// InputError if the bodies differ in dimension, or if a highlight names what is not there. Bodies from the
/// third on carry B's ids, and then no region or pair can be pointed out.
Scene build_scene(std::span<const SceneBody> bodies, const SceneHighlight& highlight = {},
                  const SceneOptions& options = {});

/// Returns the id of a face for the id pass: the top bit tells the body, the next one regions from faces.
constexpr std::uint32_t face_id(Side side, FaceId f) {
  return (side == Side::b ? 1U << 31 : 0U) | f;
}
constexpr std::uint32_t region_id(Side side, RegionId r) {
  return (side == Side::b ? 1U << 31 : 0U) | 1U << 30 | r;
}

/// Returns all points that a body can show in any wrapper state, posed. Cameras of a whole sequence should be
/// fitted to them.
std::vector<Eigen::Vector3d> body_points(const LrbRep& rep, const Pose& pose);

/// Returns how far SceneOptions::explode moves a region of a posed body away from the body's middle.
Eigen::Vector3d exploded_way(const LrbRep& rep, const Pose& pose, RegionId r, double explode);

/// Returns all points of the contact regions.
std::vector<Eigen::Vector3d> contact_points(std::span<const ContactRegion> contacts);

}  // namespace lrb::render

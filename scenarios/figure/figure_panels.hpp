#pragma once
/// Which states of a run a figure shows.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/frames/frames.hpp"
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>

namespace lrb::figure {

struct Choice {
  /// changes: where the picture changes. One body: in equal steps of the logarithm of the wrapper's faces;
  /// two: by time step, the first contact among them. layers: one body, once all regions of a layer are
  /// refined, and before. faces, events, steps: those nearest to, or of, the numbers given.
  enum class By : std::uint8_t { changes, layers, faces, events, steps } by = By::changes;
  std::vector<std::uint32_t> numbers;
  std::size_t panels = 0;  ///< the most for `changes`; 0: six of one body, four of two
};

/// The largest number of panels of a figure that chooses them itself.
inline constexpr std::size_t kMaxPanels = 26;

struct Chosen {
  std::vector<trace::EventId> events;  ///< after which the states stand, ascending, each once
  std::string left_out;                ///< what was asked for and is not among them; empty: nothing
};

/// Chooses the states. Of more than kMaxPanels layers it takes so many evenly, the first and the last among
/// them. Throws InputError for numbers that the run does not have, and for choices that it cannot offer.
Chosen choose(const run::RecordedRun& recorded, const Choice& choice);

// The camera of a figure's panels: fitted to everything once, in a square of its own units, of which panels
// show parts.

/// The side of the square that cameras are fitted to, in units of the view.
inline constexpr double kViewSide = 1000;

/// Returns the box of what is drawn of a list, inside the square; the whole square if something reaches
/// behind the camera, or nothing is seen.
Eigen::AlignedBox2d seen_box(const render::DrawList& list, const render::Camera& camera);

/// Returns the camera that shows the middle of the square, `height` units of it, at the same scale in a
/// picture of that height.
render::Camera middle_part(const render::Camera& camera, double height);

}  // namespace lrb::figure

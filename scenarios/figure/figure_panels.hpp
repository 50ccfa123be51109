#pragma once
/// Selects the states of a run that a figure shows.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/figure/figure_layout.hpp"
#include "scenarios/frames/frames.hpp"
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/image.hpp>

namespace lrb::figure {

struct Choice {
  /// changes: where the picture changes. One body: in equal steps of the logarithm of the wrapper's faces;
  /// two bodies: by time step, including the first contact. layers: one body, before and after all regions of
  /// a layer are refined. faces, events, steps: those nearest to, or of, the numbers given.
  enum class By : std::uint8_t { changes, layers, faces, events, steps } by = By::changes;
  std::vector<std::uint32_t> numbers;
  std::size_t panels = 0;  ///< the maximum for `changes`; 0: six of one body, four of two
};

/// The maximum number of panels of a figure that chooses them itself.
inline constexpr std::size_t kMaxPanels = 26;

struct Chosen {
  std::vector<trace::EventId> events;  ///< each panel shows the state after its event; ascending, unique
  std::string left_out;                ///< requested states that are not among them, as text; empty: none
};

/// Chooses the states. Of more than kMaxPanels layers it takes kMaxPanels, evenly spaced, with the first and
/// the last. Throws InputError for numbers that the run does not have, and for choices that it cannot offer.
Chosen choose(const frames::RecordedRun& recorded, const Choice& choice);

/// The resolution of the eye at reading distance, in pixels per inch.
inline constexpr double kEyeDpi = 150;

/// Returns the states whose panels can be distinguished in print from those of the state before; the first
/// and the last state stay. `seen`: by state, its panels in order of the views.
std::vector<std::size_t> distinct_states(const std::vector<std::vector<render::Image>>& seen);

/// Returns a caption without its redundant parts.
std::string shortened(std::string text);
/// Returns a caption for the narrow space below a panel: "step 12: 54 pairs", "step 12: touching, 2 pairs".
std::string title_of(std::string caption);

/// Returns the bounding box of a list's content, inside the square of kViewSide. Returns the whole square if
/// something reaches behind the camera, or nothing is visible.
Eigen::AlignedBox2d seen_box(const render::DrawList& list, const render::Camera& camera);

/// Returns the camera that shows a part of the square.
render::Camera part_of(const render::Camera& camera, const Eigen::AlignedBox2d& part);

}  // namespace lrb::figure

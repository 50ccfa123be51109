#pragma once

#include <string>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"
#include <lrbscope/trace/divergence.hpp>

namespace lrb::golden {

/// The two runs where they begin to differ: at the first event that differs, or at the end of the step that
/// does; the whole and a close-up, through the same cameras.
struct DivergencePictures {
  render::Image expected, actual;  ///< empty if there is nothing to draw
  std::string expected_caption, actual_caption;
  std::string note;  ///< why there is nothing to draw
};

DivergencePictures draw_divergence(const Golden& golden, const GoldenRun& run,
                                   const trace::Divergence& divergence);

}  // namespace lrb::golden

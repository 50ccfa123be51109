#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/play/frames.hpp"
#include "scenarios/play/recording.hpp"

namespace lrb {

/// A scenario, run and drawn as its golden is.
struct GoldenRun {
  Scenario scenario;
  Recording recording;
  std::vector<PaintedFrame> frames;
};

/// Always on the event clock, whatever the scenario says.
GoldenRun play_golden(Scenario scenario, const GoldenSpec& spec, const ProgressReport& progress);

Performance performance_of(const GoldenRun& run);

/// What an approved picture says about itself: scenario, event and camera, by which a later difference is
/// explained. No version and no folder: the same picture is the same file.
std::vector<PngText> golden_text(const GoldenRun& run, std::size_t frame);

inline const char* const kCameraText = "lrbscope:camera";
/// The cameras of a frame in words, a view after the other; "; " stands between the parts.
std::string camera_words(const std::vector<Camera>& cameras);

/// Size of a golden's pictures unless one is asked for: of the scenario's shape, small enough to be kept, and
/// large enough for their text.
void set_default_size(GoldenSpec& spec, const FrameSpec& frames);

}  // namespace lrb

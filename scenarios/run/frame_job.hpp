#pragma once

#include <string>
#include <vector>

#include "render/image.hpp"
#include "scenarios/run/framing.hpp"
#include "scenarios/run/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::run {

/// A recorded run as the renderer sees it; `render` makes one from a trace file, `run` from what it recorded.
struct RecordedRun {
  std::string title;
  std::string purpose;  ///< what the pictures are there to show; may be empty
  std::vector<const LrbRep*> reps;
  const trace::Trace* trace = nullptr;
  const std::vector<CollideResult>* results = nullptr;  ///< one a step, or none
  std::vector<trace::EventId> milestones;
};

/// In the output folder: the last certificate of separation of the run.
inline constexpr const char* kSeparationFile = "separation.png";

struct DrawnFrame {
  std::string file;  ///< relative to the output folder
  std::string caption;
  trace::EventId event = 0;
  std::uint32_t step = 0;
};

struct DrawnFrames {
  std::vector<DrawnFrame> frames;
  std::vector<std::string> montage;     ///< montage.png, montage.svg, caption.txt; none: no montage
  const trace::Step* proved = nullptr;  ///< whose certificate of separation is drawn; null: none
};

/// A frame that has not been written.
struct PaintedFrame {
  render::Image image;
  std::string caption;
  trace::EventId event = 0;
  std::vector<render::Camera> cameras;  ///< one a view
};

/// Throws InputError for frames of more pixels than can be drawn.
void check_frame_size(const spec::FrameSpec& spec);
/// Throws InputError for frames that cannot be drawn: of events that there are not, as SVG in 3D, too large.
void check_frames(const RecordedRun& performance, const spec::FrameSpec& spec);

/// The same frames as draw_frames() makes, in memory: no montage, no SVG. `framing`: what the cameras hold,
/// instead of what the performance itself shows.
std::vector<PaintedFrame> paint_frames(const RecordedRun& performance, const spec::FrameSpec& spec,
                                       const ProgressReport& progress, const Framing* framing = nullptr);

/// Draws into folder/frames/ and, if asked, folder/montage.png with folder/caption.txt; with certificates of
/// separation the last one into folder/separation.png. `text` goes into every frame.
DrawnFrames draw_frames(const RecordedRun& performance, const spec::FrameSpec& spec,
                        const std::string& folder,
                        const std::vector<std::pair<std::string, std::string>>& text,
                        const ProgressReport& progress);

}  // namespace lrb::run

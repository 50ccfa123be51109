#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "render/pictures/panel.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::frames {

/// A recorded run with its LRB-reps, the input of frames. `render` makes one from a trace file, `run` from
/// its recording.
struct RecordedRun {
  std::string title;
  std::string purpose;  ///< expected content of the pictures; may be empty
  std::vector<const LrbRep*> reps;
  const trace::Trace* trace = nullptr;
  const std::vector<CollideResult>* results = nullptr;      ///< one for each step, or null
  const std::vector<trace::TreeShape>* trees = nullptr;     ///< A's and B's, or null: as Recording::trees
  const std::vector<record::WrongAnswer>* wrong = nullptr;  ///< as Recording::wrong, or null
  /// Ends of the scale of colours by value; nullopt: as in the frame.
  std::optional<std::array<double, 2>> value_range = {};
  /// Values to colour A's and B's faces by, instead of those computed for FrameSpec::colour_by, and their
  /// name; null: compute them.
  const std::array<std::vector<double>, 2>* face_values = nullptr;
  std::string value_name = {};
  std::vector<std::size_t> close_up_steps = {};  ///< steps whose contacts a close-up shows; empty: all
};

/// Returns the caption to print below a figure: the purpose, then the texts of its panels.
std::string caption_of(const RecordedRun& recorded, const std::vector<std::string>& panels);

/// Returns the results of a run's steps; empty if they are not known.
const std::vector<CollideResult>& results_of(const RecordedRun& recorded);

/// File in the output folder with a picture of the run's last certificate of separation.
inline constexpr const char* kSeparationFile = "separation.png";

struct DrawnFrame {
  std::string file;  ///< relative to the output folder
  std::string caption;
  trace::EventId event = 0;
  std::uint32_t step = 0;
};

struct DrawnFrames {
  std::vector<DrawnFrame> frames;
  std::vector<std::string> montage;     ///< montage.png, montage.svg, caption.txt; empty: no montage
  const trace::Step* proved = nullptr;  ///< the step whose certificate of separation is drawn; null: none
};

/// A frame that has not been written to a file.
struct PaintedFrame {
  render::Image image;
  std::string caption;
  trace::EventId event = 0;
  std::vector<render::Camera> cameras;    ///< one for each view
  std::vector<render::PixelRect> places;  ///< of the views in the image
};

/// Throws InputError if frames exceed the maximum number of pixels.
void check_frame_size(const pictures::Look& spec);
/// Throws InputError for views that bodies of this dimension cannot have.
void check_views(const std::vector<pictures::Look::View>& views, int dim);
/// Throws InputError for frames that cannot be drawn: of events that do not exist, as SVG in 3D, or too
/// large.
void check_frames(const RecordedRun& recorded, const pictures::FrameSpec& spec);

/// Draws the same frames as draw_frames(), in memory, without montage or SVG. `framing` replaces the run's
/// own framing.
std::vector<PaintedFrame> paint_frames(const RecordedRun& recorded, const pictures::FrameSpec& spec,
                                       const record::ProgressReport& progress,
                                       const pictures::Framing* framing = nullptr);

/// Draws frames to folder/frames/ and, if requested, folder/montage.png with folder/caption.txt; if there are
/// certificates of separation, the last one to folder/separation.png. Writes `text` into every frame's file.
DrawnFrames draw_frames(const RecordedRun& recorded, const pictures::FrameSpec& spec,
                        const std::string& folder,
                        const std::vector<std::pair<std::string, std::string>>& text,
                        const record::ProgressReport& progress);

}  // namespace lrb::frames

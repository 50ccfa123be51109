#pragma once
/// Animations of frames, by ffmpeg.

#include <string>
#include <vector>

namespace lrb::run {

/// Returns true if ffmpeg, or the program named by $LRB_FFMPEG, is installed.
bool has_ffmpeg();
/// Throws InputError unless the name ends in .mp4, .gif or .webp, and EnvironmentError if ffmpeg is
/// missing.
void check_animation(const std::string& file);

/// Makes an animation of the frames in folder/frames, 12 per second. Throws EnvironmentError if ffmpeg fails;
/// an existing file is then unchanged.
void animate(const std::string& folder, const std::string& file);

}  // namespace lrb::run

#pragma once
/// Moving pictures of frames, by ffmpeg.

#include <string>
#include <vector>

namespace lrb::run {

/// Throws InputError unless the name ends in .mp4, .gif or .webp, and EnvironmentError if there is no ffmpeg
/// ($LRB_FFMPEG names another program).
void check_animation(const std::string& file);

/// Makes a moving picture of the frames in folder/frames, 12 a second. Throws EnvironmentError if ffmpeg
/// fails; the file is then as it was.
void animate(const std::string& folder, const std::string& file);

}  // namespace lrb::run

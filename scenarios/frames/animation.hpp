#pragma once
/// Animations of frames: animated PNG, or other formats by ffmpeg.

#include <string>
#include <vector>

namespace lrb::frames {

/// Returns true if ffmpeg, or the program named by $LRB_FFMPEG, is installed.
bool has_ffmpeg();
/// Throws InputError unless the name ends in .png, .apng, .mp4, .gif or .webp, and EnvironmentError if the
/// format needs ffmpeg and it is missing.
void check_animation(const std::string& file);

/// Returns an animated PNG of frames that are PNG files, 12 per second; the first and the last are held for
/// half a second and a second more. Frames equal to the one before extend it. Throws InputError if there are
/// none, or if they differ in size or kind.
std::string animated_png(const std::vector<std::string>& frames);

/// Makes an animation of the frames in folder/frames, as animated_png() does. Throws EnvironmentError if
/// ffmpeg fails; an existing file is then unchanged.
void animate(const std::string& folder, const std::string& file);

}  // namespace lrb::frames

#pragma once
/// Moving pictures of frames, by ffmpeg.

#include <string>
#include <vector>

namespace lrb::run {

/// Throws InputError unless the name ends in .mp4, .gif or .webp.
void check_animation(const std::string& file);

/// Returns the command, word by word, that makes a moving picture of the frames in folder/frames: 12 a
/// second.
std::vector<std::string> animation_command(const std::string& folder, const std::string& file);

/// Runs it. Returns false if there is no ffmpeg ($LRB_FFMPEG names another program). Throws EnvironmentError
/// if it fails; the file is then as it was.
bool animate(const std::string& folder, const std::string& file);

}  // namespace lrb::run

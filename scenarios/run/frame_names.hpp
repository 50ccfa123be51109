#pragma once
/// Names of a run's files of frames.

#include <cstddef>
#include <string>

namespace lrb::run {

/// Returns "frames/frame_0012", and the same with ".png".
std::string numbered_frame(std::size_t frame);
std::string frame_file(std::size_t frame);

/// Removes what an earlier run left: frames, montage and its caption, certificate of separation.
void remove_old_frames(const std::string& folder);

}  // namespace lrb::run

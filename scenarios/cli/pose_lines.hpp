#pragma once

#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/pose_file.hpp"

namespace lrb::cli {

/// The poses of a command, and where each stands in its file.
struct PoseLines {
  explicit PoseLines(const std::string& path)
      : file(printable_name(path)), poses(io::read_poses(path, &lines)) {}  // `lines` comes first

  /// Calls ask(), and puts the place of the pose before the message of an InputError.
  template <class Ask>
  auto at(std::size_t i, const Ask& ask) const {
    try {
      return ask();
    } catch (const InputError& e) {
      throw InputError(file + ":" + std::to_string(lines[i]) + ": " + e.what());
    }
  }

  std::string file;
  std::vector<std::size_t> lines;
  std::vector<Pose> poses;
};

}  // namespace lrb::cli

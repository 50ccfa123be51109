#pragma once
/// Lists of poses in files: lines of numbers, CSV and JSON, told apart by how the file's name ends.

#include <span>
#include <string>
#include <vector>

#include "engine/core/pose.hpp"

namespace lrb::io {

/// What the options that take such a file say of it.
inline constexpr const char* kPoseFileHelp =
    "File with poses: lines of 12 numbers (3x4, row by row), .csv or .json";

struct PoseList {
  std::vector<Pose> poses;
  std::vector<std::string> places;  ///< (|poses|) where each stands: "file:line", for messages
};

/// Reads a list of poses: FILE.csv by parse_pose_table(), FILE.json of at most 64 MiB (250,000 poses in full
/// precision) by parse_pose_json(), any other file by parse_poses(). Throws InputError.
PoseList open_poses(const std::string& path);

/// Reads poses from JSON: an array of poses, or an object with such an array as "poses". A pose is 12 numbers
/// (3x4, row by row), 16 (4x4, with the last row 0, 0, 0, 1), or the same as 3 or 4 rows. Other members of
/// the object are skipped. Throws InputError "name:line:column: ..." at the first mistake; nothing but poses
/// is kept in memory.
PoseList parse_pose_json(const std::string& text, const std::string& name);

/// Writes poses to a file that open_poses() reads back as the same numbers, in the form that its name ends
/// with.
void save_poses(const std::string& path, std::span<const Pose> poses);

}  // namespace lrb::io

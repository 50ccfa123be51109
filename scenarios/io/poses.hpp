#pragma once
/// Lists of poses in files: lines of numbers, CSV and JSON.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trace/json_read.hpp"
#include <lrbscope/pose.hpp>

namespace lrb::io {

/// Help text of the options that take such a file.
inline constexpr const char* kPoseFileHelp =
    "File with poses: lines of 12 numbers (3x4, row by row), .csv or .json";

struct PoseList {
  std::vector<Pose> poses;
  std::vector<std::string> places;  ///< (|poses|) location of each: "file:line", for messages
};

/// Reads a list of poses: FILE.json, or text that begins with [ or {, of at most 64 MiB (250,000 poses in
/// full precision) by parse_pose_json(); FILE.csv, or text that begins with names of columns, by
/// parse_pose_table(); any other file by parse_poses(). Throws InputError.
PoseList open_poses(const std::string& path);

/// Reads poses from JSON: an array of poses, or an object with such an array as "poses". A pose is 12 numbers
/// (3x4, row by row), 16 (4x4, with the last row 0, 0, 0, 1), or the same as 3 or 4 rows. Other members of
/// the object are skipped. Throws InputError "name:line:column: ..." at the first mistake. Only poses are
/// kept in memory.
PoseList parse_pose_json(const std::string& text, const std::string& name);

/// Writes poses to a file that open_poses() reads back as the same numbers, in the format of its extension.
void save_poses(const std::string& path, std::span<const Pose> poses);

/// Reads poses: 12 numbers on each line, a 3x4 matrix row by row (rotation and translation), separated by
/// spaces, tabs or commas; blank lines and text after a # are skipped. Throws InputError "name:line: ..." for
/// anything else, and for a file without poses. Stores the line number of each pose in `lines`, if given.
std::vector<Pose> parse_poses(const std::string& text, const std::string& name,
                              std::vector<std::size_t>* lines = nullptr);

/// Reads poses from a comma-separated table, as written by spreadsheets: 12 numbers on each line as in
/// parse_poses(), or 16, a 4x4 matrix whose last row is 0, 0, 0, 1. A first line with names identifies the
/// columns: kPoseColumns in any order; columns of other names are ignored. Throws InputError as parse_poses()
/// does.
std::vector<Pose> parse_pose_table(const std::string& text, const std::string& name,
                                   std::vector<std::size_t>* lines = nullptr);

/// The columns of a pose: its 3x4 matrix row by row.
inline constexpr std::array<std::string_view, 12> kPoseColumns = {"r00", "r01", "r02", "tx",  "r10", "r11",
                                                                  "r12", "ty",  "r20", "r21", "r22", "tz"};

/// The start and end poses of a motion, and their line number.
struct PosePair {
  Pose start, end;
  std::size_t line = 0;
};

/// Reads motions: 24 numbers on each line, two poses; otherwise as parse_poses().
std::vector<PosePair> parse_motions(const std::string& text, const std::string& name);
std::vector<PosePair> read_motions(const std::string& path);

/// Reads points: 3 numbers on each line; otherwise as parse_poses(). A first line with the names x, y and z
/// is skipped. `name`: for messages.
std::vector<Eigen::Vector3d> parse_points(const std::string& text, const std::string& name);
std::vector<Eigen::Vector3d> read_points(const std::string& path);

/// Reads three numbers "X,Y,Z"; `option` names them in the message. Throws InputError.
Eigen::Vector3d parse_vector(const std::string& text, const std::string& option);

}  // namespace lrb::io

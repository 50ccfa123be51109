#pragma once

#include <string>
#include <vector>

#include "engine/core/pose.hpp"

namespace lrb::io {

/// Poses from text: 12 numbers a line, row-major 3x4 (rotation and translation), between spaces, tabs or
/// commas; blank lines and what follows a # are passed over. Throws InputError "name:line: ..." for anything
/// else, and for a file without poses.
std::vector<Pose> parse_poses(const std::string& text, const std::string& name);
std::vector<Pose> read_poses(const std::string& path);

/// Three numbers "X,Y,Z". Throws InputError.
Eigen::Vector3d parse_vector(const std::string& text, const std::string& option);

}  // namespace lrb::io

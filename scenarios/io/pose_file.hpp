#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/core/pose.hpp"

namespace lrb::io {

/// Poses from text: 12 numbers a line, row-major 3x4 (rotation and translation), between spaces, tabs or
/// commas; blank lines and what follows a # are passed over. Throws InputError "name:line: ..." for anything
/// else, and for a file without poses. `lines`, if given, gets the number of each pose's line.
std::vector<Pose> parse_poses(const std::string& text, const std::string& name,
                              std::vector<std::size_t>* lines = nullptr);
std::vector<Pose> read_poses(const std::string& path, std::vector<std::size_t>* lines = nullptr);

/// Three numbers "X,Y,Z". Throws InputError.
Eigen::Vector3d parse_vector(const std::string& text, const std::string& option);

}  // namespace lrb::io

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/core/pose.hpp"

namespace lrb::io {

/// Reads poses: 12 numbers on each line, a 3x4 matrix row by row (rotation and translation), separated by
/// spaces, tabs or commas; blank lines and what follows a # are skipped. Throws InputError "name:line: ..."
/// for anything else, and for a file without poses. Puts the number of each pose's line into `lines`, if
/// given.
std::vector<Pose> parse_poses(const std::string& text, const std::string& name,
                              std::vector<std::size_t>* lines = nullptr);
std::vector<Pose> read_poses(const std::string& path, std::vector<std::size_t>* lines = nullptr);

/// The poses at which a motion begins and ends, and the number of their line.
struct PosePair {
  Pose start, end;
  std::size_t line = 0;
};

/// Reads motions: 24 numbers on each line, two poses; else as parse_poses().
std::vector<PosePair> parse_motions(const std::string& text, const std::string& name);
std::vector<PosePair> read_motions(const std::string& path);

/// Reads three numbers "X,Y,Z"; `option` names them in the message. Throws InputError.
Eigen::Vector3d parse_vector(const std::string& text, const std::string& option);

}  // namespace lrb::io

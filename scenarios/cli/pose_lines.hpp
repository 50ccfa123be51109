#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "scenarios/io/json/pose_list.hpp"

namespace lrb::cli {

/// The poses of a command, and where each stands in its file.
struct PoseLines {
  explicit PoseLines(const std::string& path) : PoseLines(io::open_poses(path)) {}
  explicit PoseLines(io::PoseList list) : poses(std::move(list.poses)), places(std::move(list.places)) {}

  /// Calls ask(), and puts the place of the pose before the message of an InputError.
  template <class Ask>
  auto at(std::size_t i, const Ask& ask) const {
    try {
      return ask();
    } catch (const InputError& e) {
      throw InputError(places[i] + ": " + e.what());
    }
  }

  /// Throws InputError unless the bodies can be asked about at every pose: before anything is printed.
  void check(const LrbRep& a, const LrbRep& b) const;

  std::vector<Pose> poses;
  std::vector<std::string> places;
};

/// Returns a picture's file: `path`, or with the number of the pose before its ending if there are several
/// poses.
std::string picture_name(const std::string& path, std::size_t pose, std::size_t poses);

}  // namespace lrb::cli

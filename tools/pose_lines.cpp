#include "tools/pose_lines.hpp"

#include <filesystem>

#include <lrbscope/collide.hpp>

namespace lrb::cli {

void PoseLines::check(const LrbRep& a, const LrbRep& b) const {
  check_query(a, Pose{}, b, Pose{});
  for (std::size_t i = 0; i < poses.size(); ++i) at(i, [&] { check_query(a, Pose{}, b, poses[i]); });
}

std::string picture_name(const std::string& path, std::size_t pose, std::size_t poses) {
  if (poses == 1) return path;
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + "-" + std::to_string(pose) + p.extension().string()))
      .string();
}

}  // namespace lrb::cli

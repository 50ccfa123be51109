#include "tools/pose_lines.hpp"

#include <filesystem>

#include <lrbscope/collide.hpp>

namespace lrb::cli {

PoseLines::PoseLines(const std::string& path) {
  io::PoseList list = path.empty() ? io::PoseList{{Pose{}}, {"B in place"}} : io::open_poses(path);
  poses = std::move(list.poses);
  places = std::move(list.places);
}

void PoseLines::check(const LrbRep& a, const LrbRep& b) const {
  check_query(a, Pose{}, b, Pose{});
  for (std::size_t i = 0; i < poses.size(); ++i) at(i, [&] { check_query(a, Pose{}, b, poses[i]); });
}

void add_posed_files(CLI::App& app, PosedFiles& files) {
  app.add_option("A", files.a, "Mesh or .lrb file; does not move")->required();
  app.add_option("B", files.b, "Mesh or .lrb file; moved to each pose")->required();
  app.add_option("--poses", files.poses, io::kPoseFileHelp + std::string(" [B stays in place]"));
}

std::array<bodies::LoadedBody, 2> load_noted(const std::string& a, const std::string& b,
                                             bodies::Corners corners, const Globals& globals) {
  std::array<bodies::LoadedBody, 2> out = bodies::load_faces_of_two(a, b, corners);
  for (const bodies::LoadedBody& body : out) note(globals, body.notes);
  return out;
}

std::string picture_name(const std::string& path, std::size_t pose, std::size_t poses) {
  if (poses == 1) return path;
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + "-" + std::to_string(pose) + p.extension().string()))
      .string();
}

}  // namespace lrb::cli

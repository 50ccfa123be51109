#include "scenarios/run/frame_names.hpp"

#include <filesystem>
#include <iomanip>
#include <sstream>
#include <system_error>

namespace lrb::run {

std::string numbered_frame(std::size_t frame) {
  std::ostringstream out;
  out << "frames/frame_" << std::setw(4) << std::setfill('0') << frame;
  return out.str();
}

std::string frame_file(std::size_t frame) {
  return numbered_frame(frame) + ".png";
}

void remove_old_frames(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/frames", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && (name.ends_with(".png") || name.ends_with(".svg")))
      std::filesystem::remove(entry.path(), error);
  }
  for (const char* file : {"/montage.png", "/montage.svg", "/caption.txt", "/separation.png"})
    std::filesystem::remove(folder + file, error);
}

}  // namespace lrb::run

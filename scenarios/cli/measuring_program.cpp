#include "scenarios/cli/measuring_program.hpp"

#include <filesystem>

namespace lrb::cli {

std::string measuring_program() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return (self.parent_path() / kMeasuringProgram).string();
}

}  // namespace lrb::cli

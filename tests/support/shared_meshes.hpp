#pragma once

#include <cstdlib>
#include <filesystem>

namespace lrb::test {

/// The directory of real models: LRB_MESHES, or ../shared/meshes beside the source; empty if there is none.
inline std::filesystem::path shared_meshes() {
  namespace fs = std::filesystem;
  if (const char* named = std::getenv("LRB_MESHES"))
    return fs::is_directory(named) ? fs::path(named) : fs::path();
  const fs::path beside = fs::path(LRB_SOURCE_DIR) / ".." / "shared" / "meshes";
  return fs::is_directory(beside) ? beside : fs::path();
}

}  // namespace lrb::test

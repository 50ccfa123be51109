#include "scenarios/files.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "engine/error.hpp"
#include "engine/mesh/atomic_file.hpp"

namespace lrb {
namespace fs = std::filesystem;

std::string read_text(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path + ": is a folder: expected a file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path + ": cannot be read (" + std::strerror(errno) + "): check the name");
  std::ostringstream text;
  if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (in.bad() || text.fail()) throw InputError(path + ": reading it failed");
  return std::move(text).str();
}

void make_folder(const std::string& path) {
  if (path.empty()) return;
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path, error))
    throw EnvironmentError(path + ": cannot be made a folder (" +
                           (error ? error.message() : "a file is in the way") + ")");
}

void write_text(const std::string& path, const std::string& text) {
  make_folder(fs::path(path).parent_path().string());
  write_file(path, text);
}

}  // namespace lrb

#include "scenarios/frames/animation.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

extern char** environ;

namespace lrb::run {
namespace {

std::string ending_of(const std::string& file) {
  return std::filesystem::path(file).extension().string();
}

std::string program() {
  const char* given = std::getenv("LRB_FFMPEG");
  return given != nullptr && *given != '\0' ? given : "ffmpeg";
}

std::vector<std::string> codec(const std::string& ending) {
  // GIF: a separate palette, because it has 256 colours. H.264: even sizes, and a pixel format that every
  // player supports.
  if (ending == ".gif") return {"-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse"};
  if (ending == ".webp") return {"-c:v", "libwebp", "-lossless", "1", "-loop", "0"};
  return {"-vf",    "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-c:v", "libx264", "-crf", "16", "-pix_fmt",
          "yuv420p"};
}

/// Returns true if a program exists, given by path or by name in one of the folders of PATH.
bool is_installed(const std::string& name) {
  if (name.find('/') != std::string::npos) return access(name.c_str(), X_OK) == 0;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access(((folder.empty() ? "." : folder) + "/" + name).c_str(), X_OK) == 0) return true;
  return false;
}

/// Runs a program with no input or output except stderr. Returns its exit code.
int run_program(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw EnvironmentError(words[0] + ": cannot start the program: " + std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

/// Returns the command, word by word, that makes an animation of the frames in folder/frames: 12 per second.
std::vector<std::string> animation_command(const std::string& folder, const std::string& file) {
  std::vector<std::string> out = {program(),
                                  "-y",
                                  "-loglevel",
                                  "error",
                                  "-framerate",
                                  "12",
                                  "-start_number",
                                  "0",
                                  "-i",
                                  folder + "/frames/frame_%04d.png"};
  const std::vector<std::string> how = codec(ending_of(file));
  out.insert(out.end(), how.begin(), how.end());
  out.insert(out.end(), {"-fflags", "+bitexact", "-flags:v", "+bitexact", file});
  return out;
}

}  // namespace

bool has_ffmpeg() {
  return is_installed(program());
}

void check_animation(const std::string& file) {
  const std::string ending = ending_of(file);
  if (ending != ".mp4" && ending != ".gif" && ending != ".webp")
    throw InputError("--animate: expected a .mp4, .gif or .webp file, found \"" + file + "\"");
  if (!has_ffmpeg())
    throw EnvironmentError("--animate: cannot find the program " + program() +
                           "; install ffmpeg, set LRB_FFMPEG to its path, or leave --animate out");
}

void animate(const std::string& folder, const std::string& file) {
  make_folder_of(file);
  const std::filesystem::path path(file);
  // Written under another name in the same folder, so that a partial file never appears under its final name.
  const std::string part =
      (path.parent_path() / ("." + path.stem().string() + ".part" + path.extension().string())).string();
  const int code = run_program(animation_command(folder, part));
  std::error_code error;
  if (code != 0) std::filesystem::remove(part, error);
  if (code != 0)
    throw EnvironmentError(file + ": ffmpeg cannot write the file (exit code " + std::to_string(code) + ")");
  std::filesystem::rename(part, path, error);
  if (error) throw EnvironmentError(file + ": cannot write the file: " + error.message());
}

}  // namespace lrb::run

#include "scenarios/frames/animation.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include <unistd.h>
#include <zlib.h>

#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::frames {
namespace {

constexpr std::uint32_t kFramesPerSecond = 12;
// How long the first and the last frame are held, in addition, so that an eye finds them when it repeats.
constexpr std::uint32_t kHoldFirst = kFramesPerSecond / 2, kHoldLast = kFramesPerSecond;

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
  const std::string hold = "tpad=start_mode=clone:start=" + std::to_string(kHoldFirst) +
                           ":stop_mode=clone:stop=" + std::to_string(kHoldLast);
  if (ending == ".gif") return {"-filter_complex", hold + ",split[a][b];[a]palettegen[p];[b][p]paletteuse"};
  if (ending == ".webp") return {"-vf", hold, "-c:v", "libwebp", "-lossless", "1", "-loop", "0"};
  return {"-vf",      hold + ",pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
          "-c:v",     "libx264",
          "-crf",     "16",
          "-pix_fmt", "yuv420p"};
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

/// Returns the command, word by word, that makes an animation of the frames in folder/frames: 12 per second.
std::vector<std::string> animation_command(const std::string& folder, const std::string& file) {
  std::vector<std::string> out = {program(),
                                  "-y",
                                  "-loglevel",
                                  "error",
                                  "-framerate",
                                  std::to_string(kFramesPerSecond),
                                  "-start_number",
                                  "0",
                                  "-i",
                                  folder + "/frames/frame_%04d.png"};
  const std::vector<std::string> how = codec(ending_of(file));
  out.insert(out.end(), how.begin(), how.end());
  out.insert(out.end(), {"-fflags", "+bitexact", "-flags:v", "+bitexact", file});
  return out;
}

// Animated PNG (PNG specification, third edition, chunks acTL, fcTL and fdAT): the pixels of the first frame
// are the picture that programs without animation show; those of the others are in chunks of their own.

/// Appends an integer of `bytes` bytes, the most significant first.
void put(std::string& out, std::uint32_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 255);
}

std::uint32_t get(std::string_view bytes) {
  std::uint32_t out = 0;
  for (const char c : bytes.substr(0, 4)) out = out << 8 | static_cast<unsigned char>(c);
  return out;
}

struct PngChunk {
  std::string_view type, data;
};

/// Appends a chunk with its length and check sum.
void put(std::string& out, const PngChunk& chunk) {
  put(out, static_cast<std::uint32_t>(chunk.data.size()), 4);
  const std::size_t start = out.size();
  out.append(chunk.type).append(chunk.data);
  const auto* bytes = reinterpret_cast<const Bytef*>(out.data() + start);
  put(out, static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(out.size() - start))), 4);
}

constexpr std::size_t kSignature = 8;  ///< length of the signature before the first chunk

std::vector<PngChunk> chunks_of(std::string_view png) {
  std::vector<PngChunk> out;
  for (std::size_t at = kSignature; at + 12 <= png.size();) {
    const std::size_t length = get(png.substr(at));
    if (length > png.size() - at - 12) throw InputError("animation: a frame is not a complete PNG");
    out.push_back({png.substr(at + 4, 4), png.substr(at + 8, length)});
    at += 12 + length;
  }
  if (out.empty() || out[0].type != "IHDR") throw InputError("animation: a frame is not a PNG");
  return out;
}

/// Returns the frames of a folder, as files.
std::vector<std::string> frames_in(const std::string& folder) {
  std::vector<std::string> out;
  for (;;) {
    char name[48];
    std::snprintf(name, sizeof name, "/frames/frame_%04zu.png", out.size());
    if (!std::filesystem::exists(folder + name)) return out;
    out.push_back(read_file(folder + name));
  }
}

bool is_png(const std::string& ending) {
  return ending == ".png" || ending == ".apng";
}

}  // namespace

std::string animated_png(const std::vector<std::string>& frames) {
  if (frames.empty()) throw InputError("animation: expected frames, found none");
  std::vector<std::pair<const std::string*, std::uint32_t>>
      runs;  // frames that differ, and how often each is shown
  for (const std::string& frame : frames) {
    if (!runs.empty() && *runs.back().first == frame)
      ++runs.back().second;
    else
      runs.emplace_back(&frame, 1);
  }
  if (runs.size() > 1) {
    runs.front().second += kHoldFirst;
    runs.back().second += kHoldLast;
  }
  const std::vector<PngChunk> first = chunks_of(frames[0]);
  std::string out = frames[0].substr(0, kSignature);
  std::uint32_t sequence = 0;  // of fcTL and fdAT chunks
  for (const auto& [frame, times] : runs) {
    const std::vector<PngChunk> chunks = chunks_of(*frame);
    if (chunks[0].data != first[0].data)
      throw InputError("animation: expected frames of one size and kind, found different ones");
    const bool is_first = frame == runs[0].first;
    if (is_first) {
      put(out, chunks[0]);
      std::string animation;
      put(animation, static_cast<std::uint32_t>(runs.size()), 4);
      put(animation, 0, 4);  // repeated without end
      put(out, PngChunk{"acTL", animation});
    }
    std::string control;
    put(control, sequence++, 4);
    control.append(chunks[0].data.substr(0, 8));  // width and height
    put(control, 0, 4);                           // position
    put(control, 0, 4);
    put(control, std::min(times, 0xFFFFU), 2);  // duration: a fraction of a second
    put(control, kFramesPerSecond, 2);
    put(control, 0, 2);  // the next frame replaces this one
    for (const PngChunk& chunk : chunks) {
      if (chunk.type == "IHDR" || chunk.type == "IEND") continue;
      if (chunk.type != "IDAT") {
        if (is_first) put(out, chunk);
        continue;
      }
      if (!control.empty()) put(out, PngChunk{"fcTL", control});
      control.clear();
      if (is_first) {
        put(out, chunk);
        continue;
      }
      std::string data;
      put(data, sequence++, 4);
      put(out, PngChunk{"fdAT", data.append(chunk.data)});
    }
  }
  put(out, PngChunk{"IEND", {}});
  return out;
}

bool has_ffmpeg() {
  return is_installed(program());
}

void check_animation(const std::string& file) {
  const std::string ending = ending_of(file);
  if (is_png(ending)) return;
  if (ending != ".mp4" && ending != ".gif" && ending != ".webp")
    throw InputError("--animate: expected a .png, .mp4, .gif or .webp file, found \"" + file + "\"");
  if (!has_ffmpeg())
    throw EnvironmentError("--animate: cannot find the program " + program() +
                           "; install ffmpeg, set LRB_FFMPEG to its path, or animate to a .png file");
}

void animate(const std::string& folder, const std::string& file) {
  make_folder_of(file);
  if (is_png(ending_of(file))) return write_file(file, animated_png(frames_in(folder)));
  const std::filesystem::path path(file);
  // Written under another name in the same folder, so that a partial file never appears under its final name.
  const std::string part =
      (path.parent_path() / ("." + path.stem().string() + ".part" + path.extension().string())).string();
  const io::Finished ran = io::run_program(animation_command(folder, part));
  if (!ran.not_started.empty())
    throw EnvironmentError(program() + ": cannot start the program: " + ran.not_started);
  std::fputs(ran.errors.c_str(), stderr);
  std::error_code error;
  if (ran.code != 0) {
    std::filesystem::remove(part, error);
    throw EnvironmentError(file + ": ffmpeg cannot write the file (exit code " + std::to_string(ran.code) +
                           ")");
  }
  std::filesystem::rename(part, path, error);
  if (error) throw EnvironmentError(file + ": cannot write the file: " + error.message());
}

}  // namespace lrb::frames

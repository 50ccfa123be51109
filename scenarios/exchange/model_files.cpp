#include "scenarios/exchange/model_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/files.hpp"

namespace lrb::exchange {
namespace {

struct Format {
  std::string_view ending;
  std::string (*bytes)(const Model&, const FileOptions&);
  bool ascii, regions;  ///< whether it knows these options
};
constexpr std::array kFormats = {
    Format{".ply", ply_bytes, true, false}, Format{".vtp", vtp_bytes, true, false},
    Format{".obj", obj_bytes, false, true}, Format{".glb", glb_bytes, false, true}};

const Format& format_of(const std::string& path, const FileOptions& options) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const auto format =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.ending == ending; });
  if (format == kFormats.end())
    throw InputError(printable_name(path) + ": expected a name that ends in .ply, .vtp, .glb or .obj");
  if (options.ascii && !format->ascii) throw InputError("--ascii: is for .ply and .vtp");
  if (options.regions && !format->regions) throw InputError("--regions: is for .glb and .obj");
  return *format;
}

}  // namespace

void save_model(const Model& model, const std::string& path, const FileOptions& options) {
  io::write_text(path, format_of(path, options).bytes(model, options));
}

void check_model_file(const std::string& path, const FileOptions& options) {
  format_of(path, options);
}

}  // namespace lrb::exchange

#include "scenarios/export/model.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::exchange {
namespace {

/// Returns the part with a subset of its cells, and the vertices that they use, in order.
Part some_cells(const Part& part, std::span<const std::size_t> cells) {
  constexpr std::uint32_t kUnused = ~0U;
  std::vector<std::uint32_t> number(part.vertices.size(), kUnused);
  for (const std::size_t c : cells)
    for (const std::uint32_t v : part.cell(c)) number[v] = 0;
  Part out;
  out.shape = part.shape;
  out.values.resize(part.values.size());
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kUnused) continue;
    number[v] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(part.vertices[v]);
  }
  std::vector<std::uint32_t> corners;
  std::vector<double> row(part.values.size());
  for (const std::size_t c : cells) {
    corners.clear();
    for (const std::uint32_t v : part.cell(c)) corners.push_back(number[v]);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = part.values[i][c];
    out.add_cell(corners, part.colours[c], row);
  }
  return out;
}

}  // namespace

void Part::add_cell(std::span<const std::uint32_t> at, render::Rgba colour, std::span<const double> row) {
  corners.insert(corners.end(), at.begin(), at.end());
  offsets.push_back(static_cast<std::uint32_t>(corners.size()));
  colours.push_back(colour);
  values.resize(row.size());
  for (std::size_t i = 0; i < row.size(); ++i) values[i].push_back(row[i]);
}

std::size_t Model::column(std::string_view name) const {
  const auto at =
      std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  if (at == columns.end()) throw std::logic_error("a model without the column " + std::string(name));
  return static_cast<std::size_t>(at - columns.begin());
}

std::vector<Part> split_by_region(const Model& model) {
  std::vector<Part> out;
  for (const Part& part : model.parts) {
    if (!part.in_regions) {
      out.push_back(part);
      continue;
    }
    const std::vector<double>& region = part.values[model.column("region")];
    std::map<double, std::vector<std::size_t>> cells;
    for (std::size_t c = 0; c < part.cell_count(); ++c) cells[region[c]].push_back(c);
    for (const auto& [number, of_region] : cells) {
      out.push_back(some_cells(part, of_region));
      out.back().name =
          part.name +
          (number < 0 ? "_no_region" : "_region_" + std::to_string(static_cast<std::uint64_t>(number)));
    }
  }
  return out;
}

namespace {

struct Format {
  std::string_view ending;
  std::string (*bytes)(const Model&, const FileOptions&);
  bool ascii, regions;  ///< whether the format supports these options
};
constexpr std::array kFormats = {
    Format{".ply", ply_bytes, true, false}, Format{".vtp", vtp_bytes, true, false},
    Format{".obj", obj_bytes, false, true}, Format{".glb", glb_bytes, false, true},
    Format{".stl", stl_bytes, true, false}};

const Format& format_of(const std::string& path, const FileOptions& options) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const auto format =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.ending == ending; });
  if (format == kFormats.end())
    throw InputError(printable_name(path) + ": expected a name that ends in .ply, .vtp, .glb, .obj or .stl");
  if (options.ascii && !format->ascii) throw InputError("--ascii: needs a .ply, .vtp or .stl file");
  if (options.regions && !format->regions) throw InputError("--regions: needs a .glb or .obj file");
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

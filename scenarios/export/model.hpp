#pragma once
/// What is written to files that other programs open: points, lines and polygons with a colour and a row of
/// numbers each.

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/render/style.hpp>

namespace lrb::exchange {

/// Appends a number's bytes, little-endian.
template <class T>
void append(std::string& out, T value) {
  static_assert(std::endian::native == std::endian::little, "swap the bytes first");
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

enum class Shape : std::uint8_t { points, lines, polygons };

/// The name of a number that every cell has. A number that a cell does not have is -1.
struct Column {
  std::string_view name;
  bool whole = true;  ///< its numbers are integers
};

/// Cells of one shape. Their corners are numbered within the part.
struct Part {
  std::string name;
  Shape shape = Shape::polygons;
  bool in_regions = true;                    ///< its cells are faces, which have regions
  std::vector<Eigen::Vector3d> vertices;     ///< world frame
  std::vector<std::uint32_t> offsets = {0};  ///< (cells + 1), into corners
  std::vector<std::uint32_t> corners;        ///< of a polygon counter-clockwise seen from outside
  std::vector<render::Rgba> colours;         ///< (cells)
  std::vector<std::vector<double>> values;   ///< (columns) x (cells)

  std::size_t cell_count() const { return offsets.size() - 1; }
  std::span<const std::uint32_t> cell(std::size_t i) const {
    return {corners.data() + offsets[i], offsets[i + 1] - offsets[i]};
  }
  void add_cell(std::span<const std::uint32_t> at, render::Rgba colour, std::span<const double> row);
};

struct Model {
  std::string title;            ///< what it shows, one line
  std::vector<Column> columns;  ///< the same for all parts
  std::string_view quality;     ///< the column by which programs are to colour; empty: none
  std::vector<Part> parts;      ///< none is empty

  std::size_t column(std::string_view name) const;  ///< Returns its index; the model must have it.
};

/// Returns the parts with the faces of each region apart, by the column "region": NAME_region_N, and
/// NAME_no_region for the rest.
std::vector<Part> split_by_region(const Model& model);

// Writes models in the formats of other programs. docs/formats.md tells what each holds.

struct FileOptions {
  bool ascii = false;    ///< numbers as text: PLY, VTP
  bool regions = false;  ///< a group or node for each region: OBJ, GLB
  int up = 2;            ///< the axis of the model that points up, for GLB, in which y does
};

/// Return the bytes of a file.
std::string ply_bytes(const Model& model, const FileOptions& options);
std::string vtp_bytes(const Model& model, const FileOptions& options);
std::string obj_bytes(const Model& model, const FileOptions& options);
std::string glb_bytes(const Model& model, const FileOptions& options);

/// Writes a model to FILE.ply, .vtp, .obj or .glb, whole or not at all. Throws InputError for other names,
/// and for options that the format does not know.
void save_model(const Model& model, const std::string& path, const FileOptions& options);
/// Throws as save_model() does, before there is a model.
void check_model_file(const std::string& path, const FileOptions& options);

}  // namespace lrb::exchange

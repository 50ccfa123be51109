#pragma once
/// Models for export to other programs: points, lines and polygons, each with a colour and numeric
/// attributes; of bodies, wrappers and contacts.

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>
#include <lrbscope/wrapper.hpp>

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

/// A number that every cell has. -1 if it does not apply to a cell.
struct Column {
  std::string_view name;
  bool whole = true;  ///< its numbers are integers
};

/// Cells of one shape. Their corners are numbered within the part.
struct Part {
  std::string name;
  Shape shape = Shape::polygons;
  std::vector<Eigen::Vector3d> vertices;     ///< world frame
  std::vector<std::uint32_t> offsets = {0};  ///< (cells + 1), into corners
  std::vector<std::uint32_t> corners;        ///< polygons counter-clockwise seen from outside
  std::vector<render::Rgba> colours;         ///< (cells)
  std::vector<std::vector<double>> values;   ///< (columns) x (cells)

  std::size_t cell_count() const { return offsets.size() - 1; }
  std::span<const std::uint32_t> cell(std::size_t i) const {
    return {corners.data() + offsets[i], offsets[i + 1] - offsets[i]};
  }
  void add_cell(std::span<const std::uint32_t> at, render::Rgba colour, std::span<const double> row);
};

struct Model {
  std::string title;            ///< description, one line
  std::vector<Column> columns;  ///< common to all parts
  std::string_view quality;     ///< the column that programs should colour by; empty: none
  std::vector<Part> parts;      ///< none is empty

  std::size_t column(std::string_view name) const;  ///< Returns its index; the model must have it.
};

// Writes models in the formats of other programs. docs/formats.md describes their contents.

/// Return the bytes of a file. `up`: the up axis of the model; GLB's own is y.
std::string ply_bytes(const Model& model);
std::string vtp_bytes(const Model& model);
std::string glb_bytes(const Model& model, int up);

/// Writes a model to FILE.ply, .vtp or .glb, completely or not at all. Throws InputError for other names.
void save_model(const Model& model, const std::string& path, int up = 2);
/// Throws as save_model() does, before a model is made.
void check_model_file(const std::string& path);

// Makes models.

/// One body in its state at a moment.
struct BodyMoment {
  const LrbRep* rep = nullptr;
  const Wrapper* wrapper = nullptr;  ///< null: not requested
  Pose pose;
  const trace::TreeShape* tree = nullptr;  ///< the traversed tree; null if not recorded
};

/// The content of a model, and its colouring.
struct Moment {
  std::string title;
  std::vector<BodyMoment> bodies;  ///< A and B, or A alone
  /// The events of the time step so far, used for counters; nullopt: no events, and no such columns.
  std::optional<std::span<const trace::Event>> events;
  std::span<const ContactRegion> contacts;
  pictures::FrameSpec::ColourBy colour_by = pictures::FrameSpec::ColourBy::kind;
  pictures::FrameSpec::ColourPer colour_per = pictures::FrameSpec::ColourPer::face;
};

struct Wanted {
  bool body = false, wrapper = false, contacts = false;
  bool side[2] = {true, true};  ///< of A's and B's
};

/// Returns the model of a moment. Its columns, -1 where not applicable:
/// - side: 0 A, 1 B; kind: 0 pseudo face, 1 real face, 2 contact
/// - face: its number in the LRB-rep; real faces are numbered as in the mesh's file
/// - region: the one behind a pseudo face, or around a real face; layer: the builder's pass that made it
/// - level: the number of regions between the face and the outside
/// - distance: proven maximum distance of the face's points from the body (the mesh's unit)
/// - with events: tests, hits, misses, refinements, contacts: as in trace::FaceCounts
/// - with a count to colour by: value, as it colours
/// - with contacts: contact, the number of the contact region, and its length, area and depth
Model make_model(const Moment& moment, const Wanted& wanted);

/// Returns the wrapper of the regions of the builder's first `layers` passes; 0: the body itself.
Wrapper wrapper_of_layers(const LrbRep& rep, std::uint32_t layers);

}  // namespace lrb::exchange

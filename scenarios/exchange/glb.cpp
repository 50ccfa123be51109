#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "scenarios/exchange/model.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::exchange {
namespace {

using Json = nlohmann::ordered_json;
using render::Rgba;

// Numbers of the glTF 2.0 specification.
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::array kMode = {0, 1, 4};  ///< points, lines, triangles; by Shape
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

enum Material : std::uint8_t { kOpaque, kTranslucent, kUnlit };

/// glTF vertex colours are linear.
std::uint16_t linear(std::uint8_t srgb) {
  constexpr double kMax = 65535;
  const double x = srgb / 255.0;
  return static_cast<std::uint16_t>(kMax * (x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4)) +
                                    0.5);
}

/// Geometry of one draw call: no two cells share corners, so that each cell has its own colour and is flat.
struct Primitive {
  std::vector<std::array<float, 3>> x;
  std::vector<Rgba> colours;
  std::vector<std::uint32_t> indices;
};

void add_cell(Primitive& out, const Part& part, std::size_t cell, const Eigen::Vector3d& centre) {
  const auto first = static_cast<std::uint32_t>(out.x.size());
  const std::span<const std::uint32_t> corners = part.cell(cell);
  for (const std::uint32_t v : corners) {
    const Eigen::Vector3f x = (part.vertices[v] - centre).cast<float>();
    out.x.push_back({x.x(), x.y(), x.z()});
    out.colours.push_back(part.colours[cell]);
  }
  const auto count = static_cast<std::uint32_t>(corners.size());
  if (part.shape == Shape::points) out.indices.push_back(first);
  if (part.shape == Shape::lines)
    for (std::uint32_t i = 0; i + 1 < count; ++i)
      out.indices.insert(out.indices.end(), {first + i, first + i + 1});
  if (part.shape != Shape::polygons) return;
  std::vector<Eigen::Vector3d> polygon;
  for (const std::uint32_t v : corners) polygon.push_back(part.vertices[v]);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  cut_polygon(polygon, triangles);
  for (const auto& t : triangles)
    for (const std::uint32_t i : t) out.indices.push_back(first + i);
}

class GlbOut {
 public:
  GlbOut(const Model& model, int up) : model_(model), up_(up) {
    Eigen::AlignedBox3d box;
    for (const Part& part : model.parts)
      for (const Eigen::Vector3d& x : part.vertices) box.extend(x);
    if (!box.isEmpty()) centre_ = box.min() / 2 + box.max() / 2;
  }

  std::string write() {
    json_["asset"] = {{"version", "2.0"}, {"generator", model_.title}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({Json{{"nodes", Json::array({0})}}});
    json_["nodes"].push_back(root());
    for (const Part& part : model_.parts) add_node(part);
    json_["buffers"] = Json::array({Json{{"byteLength", bin_.size()}}});
    return container();
  }

 private:
  /// Rotates the model's up axis to glTF's and translates to its centre; nodes below store floats relative to
  /// the centre.
  Json root() const {
    Json out = {{"name", "lrbscope"}, {"children", Json::array()}};
    const double h = std::sqrt(0.5);
    if (up_ == 2) out["rotation"] = Json::array({-h, 0.0, 0.0, h});
    if (up_ == 0) out["rotation"] = Json::array({0.0, 0.0, h, h});
    Eigen::Vector3d t = centre_;
    if (up_ == 2) t = {centre_.x(), centre_.z(), -centre_.y()};
    if (up_ == 0) t = {-centre_.y(), centre_.x(), centre_.z()};
    out["translation"] = Json::array({t.x(), t.y(), t.z()});
    return out;
  }

  /// Returns the index of a material, which is added on first use.
  std::size_t number_of(Material kind) {
    std::optional<std::size_t>& number = materials_[kind];
    if (number) return *number;
    constexpr std::array kNames = {"opaque", "translucent", "unlit"};
    Json material = {{"name", kNames[kind]},
                     {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}},
                     {"doubleSided", true}};
    if (kind == kTranslucent) material["alphaMode"] = "BLEND";
    if (kind == kUnlit) {
      material["extensions"] = {{"KHR_materials_unlit", Json::object()}};
      json_["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
    }
    number = json_["materials"].size();
    json_["materials"].push_back(std::move(material));
    return *number;
  }

  void add_node(const Part& part) {
    std::array<Primitive, 3> primitives;
    for (std::size_t c = 0; c < part.cell_count(); ++c) {
      const Material material = part.shape != Shape::polygons ? kUnlit
                                : part.colours[c].a < 255     ? kTranslucent
                                                              : kOpaque;
      add_cell(primitives[material], part, c, centre_);
    }
    Json mesh = {{"name", part.name}, {"primitives", Json::array()}};
    for (std::size_t m = 0; m < primitives.size(); ++m)
      if (!primitives[m].indices.empty())
        mesh["primitives"].push_back(primitive_json(primitives[m], static_cast<Material>(m), part.shape));
    const std::size_t node = json_["nodes"].size(), number = json_["meshes"].size();
    json_["nodes"][0]["children"].push_back(node);
    json_["nodes"].push_back({{"name", part.name}, {"mesh", number}, {"extras", extras(part)}});
    json_["meshes"].push_back(std::move(mesh));
  }

  /// Values common to all cells of a node, and sums over them.
  Json extras(const Part& part) const {
    Json out = {{"cells", part.cell_count()}};
    for (std::size_t i = 0; i < model_.columns.size(); ++i) {
      const std::vector<double>& values = part.values[i];
      const std::string name(model_.columns[i].name);
      const bool same =
          std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
      if (same && values.front() >= 0) out[name] = values.front();
      const bool counted = name == "tests" || name == "hits" || name == "misses" || name == "contacts";
      if (!counted || part.shape != Shape::polygons) continue;
      double sum = 0;
      for (const double x : values) sum += x;
      out[name] = sum;
    }
    return out;
  }

  Json primitive_json(const Primitive& p, Material material, Shape shape) {
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    std::string x, colours, indices;
    for (const std::array<float, 3>& v : p.x)
      for (std::size_t i = 0; i < 3; ++i) {
        append(x, v[i]);
        low[i] = std::min(low[i], v[i]);
        high[i] = std::max(high[i], v[i]);
      }
    for (const Rgba c : p.colours) {
      for (const std::uint8_t channel : {c.r, c.g, c.b}) append(colours, linear(channel));
      append(colours, static_cast<std::uint16_t>(c.a * 257));
    }
    for (const std::uint32_t i : p.indices) append(indices, i);
    Json positions = accessor(x, kArrayBuffer, kFloat, "VEC3", p.x.size());
    positions["min"] = low;
    positions["max"] = high;
    Json colour = accessor(colours, kArrayBuffer, kUnsignedShort, "VEC4", p.colours.size());
    colour["normalized"] = true;
    Json index = accessor(indices, kElementArrayBuffer, kUnsignedInt, "SCALAR", p.indices.size());
    return {{"attributes", {{"POSITION", add(positions)}, {"COLOR_0", add(colour)}}},
            {"indices", add(index)},
            {"material", number_of(material)},
            {"mode", kMode[static_cast<std::size_t>(shape)]}};
  }

  std::size_t add(const Json& accessor) {
    json_["accessors"].push_back(accessor);
    return json_["accessors"].size() - 1;
  }

  /// Adds bytes, whose length must be a multiple of 4, to the buffer.
  Json accessor(const std::string& bytes, int target, int component, const char* type, std::size_t count) {
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", bytes.size()}, {"target", target}});
    bin_ += bytes;
    return {{"bufferView", json_["bufferViews"].size() - 1},
            {"componentType", component},
            {"type", type},
            {"count", count}};
  }

  std::string container() const {
    std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    while (text.size() % 4 != 0) text += ' ';
    constexpr std::size_t kHeader = 12, kChunkHeader = 8;
    const std::size_t size = kHeader + kChunkHeader + text.size() + kChunkHeader + bin_.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw InputError("too large for GLB (at most 4 GB); use PLY or VTP, or fewer faces (--faces)");
    std::string out;
    append(out, kMagic);
    append(out, kVersion);
    append(out, static_cast<std::uint32_t>(size));
    append(out, static_cast<std::uint32_t>(text.size()));
    append(out, kJsonChunk);
    out += text;
    append(out, static_cast<std::uint32_t>(bin_.size()));
    append(out, kBinChunk);
    return out + bin_;
  }

  const Model& model_;
  int up_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  std::array<std::optional<std::size_t>, 3> materials_;  ///< by Material
  Json json_;
  std::string bin_;
};

}  // namespace

std::string glb_bytes(const Model& model, int up) {
  return GlbOut(model, up).write();
}

}  // namespace lrb::exchange

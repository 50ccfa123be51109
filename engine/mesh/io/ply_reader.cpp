#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "engine/core/file_bytes.hpp"
#include "engine/mesh/io/ply_header.hpp"
#include "engine/mesh/io/ply_source.hpp"
#include "engine/mesh/io/readers.hpp"

namespace lrb {
namespace {

const PlyElement* find_element(const PlyHeader& header, std::string_view name) {
  const auto& all = header.elements;
  const auto it = std::find_if(all.begin(), all.end(), [&](const PlyElement& e) { return e.name == name; });
  return it == all.end() ? nullptr : &*it;
}

std::ptrdiff_t find_property(const PlyElement& element, std::string_view name) {
  const auto& all = element.properties;
  const auto it = std::find_if(all.begin(), all.end(), [&](const PlyProperty& p) { return p.name == name; });
  return it == all.end() ? -1 : it - all.begin();
}

/// The elements and properties of the header that contain the mesh.
struct PlyLayout {
  const PlyElement* vertex = nullptr;
  const PlyElement* face = nullptr;
  std::array<std::ptrdiff_t, 3> xyz = {-1, -1, -1};  ///< properties of the vertex
  std::ptrdiff_t corners = -1;                       ///< property of the face
};

PlyLayout find_layout(const PlyHeader& header, std::string_view name) {
  static constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  const TextCursor text({}, name, {});
  PlyLayout layout{find_element(header, "vertex"), find_element(header, "face")};
  // Messages about missing elements name the last line of the header.
  const std::uint64_t last = header.data_line - 1;
  if (layout.vertex == nullptr)
    text.fail_at(last, "no element vertex in the header", "one with the properties x, y and z",
                 "export a mesh");
  for (std::size_t i = 0; i < 3; ++i) {
    layout.xyz[i] = find_property(*layout.vertex, kNames[i]);
    if (layout.xyz[i] < 0 || layout.vertex->properties[layout.xyz[i]].count_type)
      text.fail_at(layout.vertex->line, "a vertex without a number " + std::string(kNames[i]),
                   "the properties x, y and z", "export the mesh again");
  }
  if (layout.face == nullptr)
    text.fail_at(last, "no element face in the header", "one with a list vertex_indices",
                 "export faces: point clouds and triangle strips are not read");
  // Two names for the list of corners are in use.
  layout.corners = find_property(*layout.face, "vertex_indices");
  if (layout.corners < 0) layout.corners = find_property(*layout.face, "vertex_index");
  if (layout.corners < 0 || !layout.face->properties[layout.corners].count_type ||
      !is_integer(layout.face->properties[layout.corners].type))
    text.fail_at(layout.face->line, "a face without a list of integers vertex_indices (or vertex_index)",
                 "one", "export the mesh again");
  return layout;
}

template <class Source>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, Source source, std::string_view name)
      : header_(header), layout_(find_layout(header, name)), source_(source), name_(name) {}

  Mesh read() {
    // Elements in the order of the header. Those that are not needed are read past, since their size may
    // vary.
    for (const PlyElement& e : header_.elements) elements(e);
    source_.end_of_data();
    refuse_without_faces(mesh_, name_);
    check_index_limits(mesh_.vertices.size(), mesh_.face_vertices.size(), name_);
    return std::move(mesh_);
  }

 private:
  void elements(const PlyElement& e) {
    if (e.properties.empty()) return;  // such elements take no bytes, however many there are
    // Checked before memory is reserved: a damaged count must not exhaust it.
    if (!source_.has_room(e))
      source_.fail("fewer bytes than " + std::to_string(e.count) + " times " + in_quotes(e.name) + " need",
                   "as many as the header says",
                   "the file is cut short or its header wrong: export or copy it again");
    if (&e == layout_.vertex) mesh_.vertices.reserve(e.count);
    if (&e == layout_.face) mesh_.face_offsets.reserve(e.count + 1);
    for (std::uint64_t i = 0; i < e.count; ++i) {
      source_.begin(e, i);
      if (&e == layout_.vertex)
        vertex(e);
      else if (&e == layout_.face)
        face(e);
      else
        for (const PlyProperty& p : e.properties) skip(p);
      source_.end();
    }
  }

  void vertex(const PlyElement& e) {
    Eigen::Vector3d& v = mesh_.vertices.emplace_back();
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      // x, y and z may come in any order and between other properties.
      const auto which = std::find(layout_.xyz.begin(), layout_.xyz.end(), static_cast<std::ptrdiff_t>(k));
      if (which == layout_.xyz.end())
        skip(e.properties[k]);
      else
        v[which - layout_.xyz.begin()] = source_.real(e.properties[k]);
    }
  }

  void face(const PlyElement& e) {
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      if (static_cast<std::ptrdiff_t>(k) == layout_.corners)
        corners(e.properties[k]);
      else
        skip(e.properties[k]);
    }
  }

  void corners(const PlyProperty& p) {
    const std::int64_t count = source_.integer(*p.count_type, "the number of corners");
    if (count < 3)
      source_.fail("a face with " + std::to_string(count) + " corners", "at least 3", "correct the file");
    // Against the header's count, because faces may come before vertices.
    const auto vertices = static_cast<std::int64_t>(layout_.vertex->count);
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t v = source_.integer(p.type, p.name);
      if (v < 0 || v >= vertices)
        source_.fail("vertex index " + std::to_string(v),
                     "0 to " + std::to_string(vertices - 1) + " (" + std::to_string(vertices) + " vertices)",
                     "correct the file or export it again");
      mesh_.face_vertices.push_back(static_cast<VertexId>(v));
    }
    mesh_.face_offsets.push_back(static_cast<std::uint32_t>(mesh_.face_vertices.size()));
  }

  void skip(const PlyProperty& p) {
    // A scalar is skipped like a list of one value.
    std::int64_t count = 1;
    if (p.count_type) count = source_.integer(*p.count_type, p.name);
    if (count < 0) source_.fail("a list of length " + std::to_string(count), "0 or more", "correct the file");
    source_.skip(p.type, static_cast<std::uint64_t>(count), p.name);
  }

  const PlyHeader& header_;
  PlyLayout layout_;
  Source source_;
  std::string_view name_;
  Mesh mesh_;
};

}  // namespace

Mesh read_ply(std::string_view bytes, std::string_view name) {
  const PlyHeader header = read_ply_header(bytes, name);
  if (header.format == PlyFormat::ascii) {
    refuse_nul(bytes, name);
    const PlyText text(bytes.substr(header.data_offset), name, header.data_line);
    return PlyReader(header, text, name).read();
  }
  const std::endian order =
      header.format == PlyFormat::binary_big_endian ? std::endian::big : std::endian::little;
  return PlyReader(header, PlyBytes(bytes, header.data_offset, name, order), name).read();
}

}  // namespace lrb

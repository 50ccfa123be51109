#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "engine/mesh/io/formats.hpp"
#include "engine/mesh/io/scan.hpp"
#include "engine/mesh/vertex_groups.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

constexpr std::size_t kHeader = 80;          ///< bytes of a binary file's header, without meaning
constexpr std::size_t kStart = kHeader + 4;  ///< offset of the first triangle, after the number of triangles
constexpr std::size_t kTriangle = 12 * 4 + 2;  ///< normal, three corners, two bytes of attributes

std::uint64_t claimed_triangles(std::string_view bytes) {
  return load<std::uint32_t>(bytes.data() + kHeader, std::endian::little);
}

bool same_word(std::string_view token, std::string_view word) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  if (token.size() != word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (lower(token[i]) != word[i]) return false;
  return true;
}

class StlText {
 public:
  StlText(std::string_view bytes, std::string_view name) : text_(bytes, name, {}), name_(name) {}

  Mesh read() {
    std::string_view word = text_.any_token();
    // A file may contain several solids; they are combined in one mesh.
    do {
      if (!same_word(word, "solid")) unexpected(word, "solid");
      // The rest of the line is the solid's name, unless the file has no line breaks.
      if (!go_to_facet()) text_.next_line();
      solid();
      word = text_.any_token();
    } while (!word.empty());
    reject_without_faces(mesh_, name_);
    return std::move(mesh_);
  }

 private:
  void solid() {
    for (;;) {
      const std::string_view word = text_.any_token();
      if (same_word(word, "endsolid")) break;
      if (!same_word(word, "facet")) unexpected(word, "facet or endsolid");
      facet();
    }
    if (go_to_facet()) unexpected("facet", "the end of the line after endsolid");
    text_.next_line();
  }

  /// Advances to the first facet on this line. Returns false, and stays, if there is none.
  bool go_to_facet() {
    for (TextCursor at = text_, next = text_;; at = next) {
      const std::string_view word = next.token();
      if (word.empty()) return false;
      if (!same_word(word, "facet") || !same_word(TextCursor(next).token(), "normal")) continue;
      text_ = at;
      return true;
    }
  }

  void facet() {
    expect("normal");
    // Ignore the normal, because exporters write arbitrary ones for thin triangles. The order of the corners
    // defines the orientation.
    for (int i = 0; i < 3; ++i)
      if (text_.any_token().empty()) unexpected({}, "the normal's three numbers");
    expect("outer");
    expect("loop");
    std::array<VertexId, 3> corners;
    for (VertexId& c : corners) {
      expect("vertex");
      c = vertex();
    }
    expect("endloop");
    expect("endfacet");
    mesh_.add_face(corners);
  }

  VertexId vertex() {
    static constexpr std::array<std::string_view, 3> kWhat = {"coordinate x", "coordinate y", "coordinate z"};
    Eigen::Vector3d v;
    // STL repeats coordinates per triangle; equal points are merged to one vertex.
    for (int i = 0; i < 3; ++i) v[i] = text_.number(text_.any_token(), kWhat[i]);
    return merger_.id(v);
  }

  void expect(std::string_view word) {
    const std::string_view token = text_.any_token();
    if (!same_word(token, word)) unexpected(token, word);
  }

  [[noreturn]] void unexpected(std::string_view token, std::string_view word) const {
    text_.fail(text_.shown(token), "'" + std::string(word) + "'",
               token.empty() ? "the file is cut short: export or copy it again" : "correct the line");
  }

  TextCursor text_;
  std::string_view name_;
  Mesh mesh_;
  VertexMerger merger_{mesh_.vertices};
};

[[noreturn]] void reject_size(std::string_view bytes, std::string_view name) {
  const std::string size = std::to_string(bytes.size()) + " bytes";
  const std::string expected =
      bytes.size() < kStart ? "at least " + std::to_string(kStart) + " (the header of a binary STL file)"
                            : std::to_string(kStart + kTriangle * claimed_triangles(bytes)) + " for the " +
                                  std::to_string(claimed_triangles(bytes)) + " triangles of its header";
  throw InputError(printable_name(name) + ": found a binary STL file of " + size + ", expected " + expected +
                   "; the file is cut short or damaged: export or copy it again");
}

[[noreturn]] void reject_coordinate(std::string_view name, std::size_t triangle, std::size_t byte,
                                    float value) {
  throw InputError(printable_name(name) + ": triangle " + std::to_string(triangle) + " (byte " +
                   std::to_string(byte) + "): found the coordinate " + (std::isnan(value) ? "nan" : "inf") +
                   ", expected a finite number; export the mesh again");
}

}  // namespace

bool has_size_of_binary_stl(std::string_view bytes) {
  return bytes.size() >= kStart && bytes.size() == kStart + kTriangle * claimed_triangles(bytes);
}

Mesh read_stl_ascii(std::string_view bytes, std::string_view name) {
  reject_nul(bytes, name);
  return StlText(bytes, name).read();
}

Mesh read_stl_binary(std::string_view bytes, std::string_view name) {
  // Some exporters append other data. Further triangles mean that the count is wrong.
  const bool has_all =
      bytes.size() >= kStart && bytes.size() >= kStart + kTriangle * claimed_triangles(bytes);
  if (!has_all || (!has_size_of_binary_stl(bytes) && (bytes.size() - kStart) % kTriangle == 0))
    reject_size(bytes, name);
  // All reads below are within the file.
  const std::size_t count = claimed_triangles(bytes);
  check_index_limits(0, 3 * std::uint64_t{count}, name);
  Mesh mesh;
  mesh.face_offsets.reserve(count + 1);
  mesh.face_vertices.reserve(3 * count);
  VertexMerger merger(mesh.vertices);
  for (std::size_t t = 0; t < count; ++t) {
    std::size_t byte =
        // Skip the normal, because the order of the corners defines the orientation.
        kStart + t * kTriangle + 12;
    std::array<VertexId, 3> corners;
    for (VertexId& c : corners) {
      Eigen::Vector3d v;
      for (int i = 0; i < 3; ++i, byte += 4) {
        const float x = load<float>(bytes.data() + byte, std::endian::little);
        if (!std::isfinite(x)) reject_coordinate(name, t, byte, x);
        v[i] = x;
      }
      c = merger.id(v);
    }
    mesh.add_face(corners);
  }
  reject_without_faces(mesh, name);
  return mesh;
}

}  // namespace lrb

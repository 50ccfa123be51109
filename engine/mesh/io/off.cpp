#include <algorithm>
#include <string>
#include <utility>

#include "engine/mesh/io/formats.hpp"
#include "engine/mesh/io/scan.hpp"
#include <lrbscope/core/file.hpp>

namespace lrb {
namespace {

class OffReader {
 public:
  OffReader(std::string_view bytes, std::string_view name)
      : text_(bytes, name, {.hash_comments = true}), name_(name) {}

  Mesh read() {
    // The keyword is optional; without it the first token is a count.
    std::string_view first = text_.any_token();
    if (const std::size_t size = off_header_size(first)) {
      take_header(*parse_off_header(first.substr(0, size)), first);
      first.remove_prefix(size);
      if (first.empty()) first = text_.any_token();
    }
    counts(first);
    for (std::uint64_t i = 0; i < vertices_; ++i) vertex();
    for (std::uint64_t i = 0; i < faces_; ++i) face();
    // Remaining tokens mean that the counts are wrong.
    const std::string_view extra = text_.any_token();
    if (!extra.empty())
      text_.fail(in_quotes(extra), "the end of the file (all vertices and faces are read)",
                 "correct the counts");
    reject_without_faces(mesh_, name_);
    return std::move(mesh_);
  }

 private:
  void take_header(const OffHeader& header, std::string_view shown) {
    header_ = header;
    if (header.dimensions_differ)
      text_.fail("the header " + in_quotes(shown), "vertices in three dimensions (OFF, COFF, NOFF, STOFF)",
                 "export the mesh in 3D");
    // A copy of the cursor looks ahead without consuming the token.
    TextCursor ahead = text_;
    if (ahead.token() == "BINARY")
      text_.fail("a binary OFF file", "a text one", "export it as OFF text, or as PLY");
  }

  /// Reads the numbers of vertices, faces and edges (the last one is unused, and often wrong).
  void counts(std::string_view first) {
    vertices_ = count(first, "the number of vertices");
    faces_ = count(text_.token(), "the number of faces");
    const std::string_view edges = text_.token();
    if (!edges.empty()) text_.integer(edges, "the number of edges");
    end_of_line("the end of the line of counts");
    // Check before allocating: a vertex takes six bytes ("0 0 0" and a newline), a face eight ("3 0 1 2" and
    // a newline).
    static constexpr std::uint64_t kVertexBytes = 6, kFaceBytes = 8;
    // One more than the remaining bytes, because the last line may lack its newline.
    const std::uint64_t left = text_.bytes_left() + 1;
    if (vertices_ > left / kVertexBytes || faces_ > (left - vertices_ * kVertexBytes) / kFaceBytes)
      text_.fail(
          "counts of " + std::to_string(vertices_) + " vertices and " + std::to_string(faces_) + " faces",
          "no more than the file's " + std::to_string(left - 1) + " bytes left can hold",
          "the file is cut short or its counts wrong: export or copy it again");
    check_index_limits(vertices_, 0, name_);
    mesh_.vertices.reserve(vertices_);
    mesh_.face_offsets.reserve(faces_ + 1);
    mesh_.face_vertices.reserve(3 * faces_);
  }

  std::uint64_t count(std::string_view token, std::string_view what) const {
    const std::int64_t value = text_.integer(token, what);
    if (value < 0)
      text_.fail(in_quotes(token), "0 or more (" + std::string(what) + ")", "correct the counts");
    return static_cast<std::uint64_t>(value);
  }

  std::string_view first_of_line(std::string_view what) {
    const std::string_view token = text_.any_token();
    if (token.empty())
      text_.fail(text_.shown(token), what,
                 "the file is cut short or its counts wrong: export or copy it again");
    return token;
  }

  /// Reads x y z, then normal, colour and texture according to the header; plain OFF has no more.
  void vertex() {
    Eigen::Vector3d v;
    v.x() = text_.number(first_of_line("another vertex"), "coordinate x");
    v.y() = text_.number("coordinate y");
    v.z() = text_.number("coordinate z");
    mesh_.vertices.push_back(v);
    // Extra values must be numbers and are otherwise ignored.
    if (header_.has_extras) {
      skip_numbers();
    } else {
      end_of_line("the end of the line after x y z (colours need the header COFF, normals NOFF)");
    }
  }

  void face() {
    const std::int64_t corners = text_.integer(first_of_line("another face"), "the number of corners");
    if (corners < 3)
      text_.fail("a face with " + std::to_string(corners) + " corners", "at least 3", "correct the line");
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t v = text_.integer("a face's vertex index");
      // All vertices precede the faces, so indices are checked at once.
      if (v < 0 || v >= static_cast<std::int64_t>(vertices_))
        text_.fail("vertex index " + std::to_string(v),
                   "0 to " + std::to_string(static_cast<std::int64_t>(vertices_) - 1) + " (" +
                       std::to_string(vertices_) + " vertices)",
                   "OFF counts from 0: correct the line");
      mesh_.face_vertices.push_back(static_cast<VertexId>(v));
    }
    // After each face, because the offset stored below has 32 bits.
    check_index_limits(0, mesh_.face_vertices.size(), name_);
    mesh_.face_offsets.push_back(static_cast<std::uint32_t>(mesh_.face_vertices.size()));
    skip_numbers();  // a colour
  }

  void skip_numbers() {
    for (std::string_view t = text_.token(); !t.empty(); t = text_.token())
      text_.number(t, "colour, normal or texture");
  }

  void end_of_line(std::string_view expected) {
    const std::string_view extra = text_.token();
    if (!extra.empty()) text_.fail(in_quotes(extra), expected, "correct the line");
  }

  TextCursor text_;
  std::string_view name_;
  OffHeader header_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  Mesh mesh_;
};

}  // namespace

Mesh read_off(std::string_view bytes, std::string_view name) {
  reject_nul(bytes, name);
  return OffReader(bytes, name).read();
}

}  // namespace lrb

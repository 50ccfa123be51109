#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/mesh/io/formats.hpp"
#include "engine/mesh/io/scan.hpp"
#include <lrbscope/core/file.hpp>

namespace lrb {
namespace {

/// Statements that do not affect the shape: normals, texture, groups, materials, display.
constexpr std::array<std::string_view, 24> kIgnored = {
    "vn",         "vt",        "vp",     "p",      "o",     "g",        "s",        "mg",
    "usemtl",     "mtllib",    "usemap", "maplib", "bevel", "c_interp", "d_interp", "lod",
    "shadow_obj", "trace_obj", "ctech",  "stech",  "illum", "group",    "object",   "newmtl"};

/// Statements of free-form curves and surfaces, which have no polygons.
constexpr std::array<std::string_view, 22> kFreeForm = {
    "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
    "sp",     "end", "con",  "res",  "bzp",  "bsp",   "cdc",  "cdp",  "rat",  "call", "csh"};

template <std::size_t N>
bool holds(const std::array<std::string_view, N>& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// A vertex index beyond the vertices read so far. OBJ permits that for positive indices; the end of the file
/// shows whether the vertex follows.
struct ForwardReference {
  std::int64_t index;
  std::uint64_t line;
};

class ObjReader {
 public:
  ObjReader(std::string_view bytes, std::string_view name)
      : text_(bytes, name, {.hash_comments = true, .continuation = true}), name_(name) {
    // Vertex and face lines rarely have fewer bytes than this. The reservation avoids reallocation and is
    // bounded by the file size.
    static constexpr std::size_t kBytesPerLine = 24;
    mesh_.vertices.reserve(bytes.size() / kBytesPerLine / 3);
    mesh_.face_offsets.reserve(bytes.size() / kBytesPerLine / 3 * 2);
    mesh_.face_vertices.reserve(bytes.size() / kBytesPerLine * 2);
  }

  Mesh read() {
    // One statement per line. The cursor handles continuation lines and comments.
    do {
      const std::string_view word = text_.token();
      if (!word.empty()) statement(word);
    } while (text_.next_line());
    // Checks that need the entire file: indices, the meaning of line elements, limits.
    check_forward_references();
    take_segments();
    reject_without_faces(mesh_, name_);
    check_index_limits(mesh_.vertices.size(), mesh_.face_vertices.size(), name_);
    return std::move(mesh_);
  }

 private:
  void statement(std::string_view word) {
    // The most frequent statements first.
    if (word == "v") return vertex();
    if (word == "f") return face();
    if (word == "l") return polyline();
    if (word == "fo") return face();  // the old name of f
    if (holds(kIgnored, word)) return;
    // Free-form geometry is an error rather than ignored, because the body would have gaps.
    if (holds(kFreeForm, word))
      text_.fail("the free-form statement " + in_quotes(word), "polygons (f)",
                 "export the surface as polygons");
    text_.fail(in_quotes(word), "an OBJ statement (v, vt, vn, f, l, o, g, s, usemtl, mtllib or #)",
               "check that this is an OBJ file and not damaged");
  }

  /// Reads x y z, optionally followed by a weight, a colour, or both, which are ignored.
  void vertex() {
    static constexpr std::array<std::string_view, 3> kWhat = {"coordinate x", "coordinate y", "coordinate z"};
    Eigen::Vector3d& v = mesh_.vertices.emplace_back();
    for (int i = 0; i < 3; ++i)
      if (!text_.plain_number(v[i])) v[i] = text_.number(kWhat[i]);
    // Valid counts of extra numbers: 0, 1 (weight), 3 (colour), 4 (weight or alpha).
    int more = 0;
    for (std::string_view t = text_.token(); !t.empty(); t = text_.token(), ++more)
      text_.number(t, "weight or colour");
    if (more == 2 || more > 4)
      text_.fail(std::to_string(3 + more) + " numbers", "x y z, x y z w, x y z r g b or x y z r g b a",
                 "correct the line");
    // Stored, because only the end of the file decides whether the body is 2D.
    if (v.z() != 0 && line_off_plane_ == 0) line_off_plane_ = text_.line();
  }

  void face() {
    read_corners();
    if (corners_.size() < 3)
      text_.fail("a face with " + std::to_string(corners_.size()) + " corners", "at least 3",
                 "remove the line or correct it");
    mesh_.add_face(corners_);
  }

  /// Reads a polyline: each of its segments is an element of a 2D body.
  void polyline() {
    read_corners();
    if (corners_.size() < 2)
      text_.fail("a line with " + std::to_string(corners_.size()) + " corners", "at least 2",
                 "remove the line or correct it");
    for (std::size_t i = 0; i + 1 < corners_.size(); ++i)
      segments_.insert(segments_.end(), {corners_[i], corners_[i + 1]});
  }

  void read_corners() {
    corners_.clear();
    for (std::int64_t index = 0; text_.plain_index(index);) corners_.push_back(vertex_id({}, index));
    for (std::string_view t = text_.token(); !t.empty(); t = text_.token()) corners_.push_back(corner(t));
  }

  /// Reads v, v/vt, v//vn or v/vt/vn. Texture and normal must be integers and are otherwise ignored.
  VertexId corner(std::string_view token) {
    // The part before the first slash is the vertex; the rest is validated and ignored.
    const std::size_t slash = token.find('/');
    if (slash != std::string_view::npos) check_attributes(token, token.substr(slash + 1));
    return vertex_id(token, text_.integer(token.substr(0, slash), "a face's vertex index"));
  }

  void check_attributes(std::string_view token, std::string_view rest) {
    const std::size_t slash = rest.find('/');
    const std::string_view texture = rest.substr(0, slash);
    if (!texture.empty()) text_.integer(texture, "a face's texture index");
    if (slash == std::string_view::npos) return;
    const std::string_view normal = rest.substr(slash + 1);
    if (normal.find('/') != std::string_view::npos)
      text_.fail(in_quotes(token), "v, v/vt, v//vn or v/vt/vn", "correct the line");
    if (!normal.empty()) text_.integer(normal, "a face's normal index");
  }

  VertexId vertex_id(std::string_view token, std::int64_t index) {
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    // Positive indices count from 1, negative ones back from the last vertex; 0 is invalid.
    if (index == 0)
      text_.fail("vertex index 0 in " + in_quotes(token),
                 "an index from 1 (or negative: -1 is the vertex read last)",
                 "OBJ counts from 1: correct the exporter");
    if (index < 0 && index < -count)
      text_.fail("vertex index " + std::to_string(index),
                 "at least -" + std::to_string(count) + " (" + std::to_string(count) + " vertices so far)",
                 "correct the line");
    // Beyond the vertices so far: legal if the vertex follows.
    if (index > count) forward_.push_back({index, text_.line()});
    return static_cast<VertexId>(index < 0 ? count + index
                                           : index - 1);  // too large indices are rejected at the end
  }

  void check_forward_references() const {
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    for (const auto& [index, line] : forward_)
      if (index > count)
        text_.fail_at(line, "vertex index " + std::to_string(index),
                      "at most " + std::to_string(count) + ", the number of vertices in the file",
                      "correct the line or complete the file");
  }

  /// Uses the polylines as the body if there are no faces. Otherwise they are loose edges that bound nothing.
  void take_segments() {
    if (mesh_.face_count() > 0 || segments_.empty()) return;
    if (line_off_plane_ != 0)
      text_.fail_at(line_off_plane_, "a vertex with z other than 0 in a 2D body (l elements and no f)",
                    "z = 0", "flatten the polygon, or give the body faces (f)");
    mesh_.dim = 2;
    for (std::size_t i = 0; i < segments_.size(); i += 2)
      mesh_.add_face(std::span<const VertexId>(segments_).subspan(i, 2));
  }

  TextCursor text_;
  std::string_view name_;
  Mesh mesh_;
  std::vector<VertexId> corners_;   ///< corners of the element being read
  std::vector<VertexId> segments_;  ///< two corners for each segment
  std::vector<ForwardReference> forward_;
  std::uint64_t line_off_plane_ = 0;  ///< line of the first vertex with z other than 0; 0: none
};

}  // namespace

Mesh read_obj(std::string_view bytes, std::string_view name) {
  reject_nul(bytes, name);
  return ObjReader(bytes, name).read();
}

}  // namespace lrb

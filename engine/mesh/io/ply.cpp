#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/mesh/io/formats.hpp"
#include "engine/mesh/io/scan.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

// The header of a PLY file, which describes its data.

enum class PlyFormat : std::uint8_t { ascii, binary_little_endian, binary_big_endian };
enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

constexpr std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}
constexpr bool is_integer(PlyType type) {
  return type < PlyType::f32;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  std::optional<PlyType> count_type;  ///< for a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t line = 0;  ///< line of the header
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_offset = 0;  ///< number of bytes before the data
  std::uint64_t data_line = 0;  ///< line on which the data begins
};

// The data of a PLY file as a stream of values, from text or from bytes: two classes with the same interface.

/// Data as text: one element per line.
class PlyText {
 public:
  PlyText(std::string_view data, std::string_view name, std::uint64_t first_line)
      : text_(data, name, {}, first_line) {}

  /// Returns true if the data can contain the number of elements in the header. (Every value takes a
  /// character and a separator, which the last one may lack.)
  bool has_room(const PlyElement& e) const {
    return e.count <= (text_.bytes_left() + 1) / (2 * e.properties.size());
  }
  void begin(const PlyElement&, std::uint64_t) {
    waiting_ = text_.any_token();
    if (waiting_.empty()) next({});
  }
  void end() {
    const std::string_view extra = waiting_.empty() ? text_.token() : waiting_;
    if (!extra.empty())
      fail(in_quotes(extra), "the end of the line", "the header says how many values a line has");
  }
  double real(const PlyProperty& p) { return text_.number(next(p.name), p.name); }
  std::int64_t integer(PlyType, std::string_view what) { return text_.integer(next(what), what); }
  void skip(PlyType, std::uint64_t count, std::string_view what) {
    for (; count > 0; --count) next(what);
  }
  /// Checks that there is no data after the last element.
  void end_of_data() {
    const std::string_view extra = text_.any_token();
    if (!extra.empty())
      fail(in_quotes(extra), "the end of the file (all elements of the header are read)",
           "correct the header's counts");
  }
  [[noreturn]] void fail(std::string_view found, std::string_view expected, std::string_view advice) const {
    text_.fail(found, expected, advice);
  }

 private:
  std::string_view next(std::string_view what) {
    std::string_view token = waiting_;
    waiting_ = {};
    if (token.empty()) token = text_.token();
    if (token.empty())
      fail(text_.shown(token), what.empty() ? "another element" : "a value for " + in_quotes(what),
           "the file is cut short or its header wrong: export or copy it again");
    return token;
  }

  TextCursor text_;
  std::string_view waiting_;  ///< first token of a line, read to find the line
};

class PlyBytes {
 public:
  PlyBytes(std::string_view file, std::size_t data_offset, std::string_view name, std::endian order)
      : start_(file.data()),
        at_(start_ + data_offset),
        end_(start_ + file.size()),
        name_(name),
        order_(order) {}

  bool has_room(const PlyElement& e) const {
    std::uint64_t least = 0;
    for (const PlyProperty& p : e.properties) least += size_of(p.count_type.value_or(p.type));
    return e.count <= bytes_left() / least;
  }
  void begin(const PlyElement& e, std::uint64_t index) {
    element_ = &e;
    index_ = index;
  }
  void end() {}
  double real(const PlyProperty& p) {
    const double value =
        is_integer(p.type) ? static_cast<double>(integer(p.type, p.name)) : floating(p.type, p.name);
    if (!std::isfinite(value))
      fail(std::isnan(value) ? "nan" : "inf", "a finite number (" + p.name + ")", "export the mesh again");
    return value;
  }
  std::int64_t integer(PlyType type, std::string_view what) {
    const char* from = take(size_of(type), what);
    switch (type) {
      case PlyType::i8:
        return load<std::int8_t>(from, order_);
      case PlyType::u8:
        return load<std::uint8_t>(from, order_);
      case PlyType::i16:
        return load<std::int16_t>(from, order_);
      case PlyType::u16:
        return load<std::uint16_t>(from, order_);
      case PlyType::i32:
        return load<std::int32_t>(from, order_);
      default:
        return load<std::uint32_t>(from, order_);
    }
  }
  void skip(PlyType type, std::uint64_t count, std::string_view what) { take(count * size_of(type), what); }
  void end_of_data() {
    element_ = nullptr;
    if (bytes_left() > 0)
      fail(std::to_string(bytes_left()) + " bytes more than the header says", "the end of the file",
           "correct the header's counts or export the mesh again");
  }
  [[noreturn]] void fail(std::string_view found, std::string_view expected, std::string_view advice) const {
    std::string message = printable_name(name_) + ": byte " + std::to_string(at_ - start_);
    if (element_ != nullptr) message += ", " + in_quotes(element_->name) + " " + std::to_string(index_);
    message.append(": found ")
        .append(found)
        .append(", expected ")
        .append(expected)
        .append("; ")
        .append(advice);
    throw InputError(message);
  }

 private:
  std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_); }

  double floating(PlyType type, std::string_view what) {
    const char* from = take(size_of(type), what);
    return type == PlyType::f32 ? load<float>(from, order_) : load<double>(from, order_);
  }

  const char* take(std::uint64_t size, std::string_view what) {
    if (size > bytes_left())
      fail("the end of the file", "a value for " + in_quotes(what),
           "the file is cut short or its header wrong: export or copy it again");
    const char* from = at_;
    at_ += size;
    return from;
  }

  const char* start_;
  const char* at_;
  const char* end_;
  std::string_view name_;
  std::endian order_;
  const PlyElement* element_ = nullptr;  ///< the element being read
  std::uint64_t index_ = 0;
};

/// The types, with old and new names.
constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes = {{
    {"char", PlyType::i8},
    {"uchar", PlyType::u8},
    {"short", PlyType::i16},
    {"ushort", PlyType::u16},
    {"int", PlyType::i32},
    {"uint", PlyType::u32},
    {"float", PlyType::f32},
    {"double", PlyType::f64},
    {"int8", PlyType::i8},
    {"uint8", PlyType::u8},
    {"int16", PlyType::i16},
    {"uint16", PlyType::u16},
    {"int32", PlyType::i32},
    {"uint32", PlyType::u32},
    {"float32", PlyType::f32},
    {"float64", PlyType::f64},
}};

/// Reads the header. Throws InputError naming the line.
class PlyHeaderReader {
 public:
  PlyHeaderReader(std::string_view bytes, std::string_view name) : bytes_(bytes), text_(bytes, name, {}) {}

  PlyHeader read() {
    text_.any_token();  // "ply", by which the format was recognised
    end_of_line();
    // Statements until end_header. At the end of the file the word is empty, which statement() rejects.
    for (;;) {
      const std::string_view word = text_.any_token();
      if (word == "end_header") break;
      statement(word);
    }
    // Without a format the data cannot be interpreted.
    if (!has_format_)
      text_.fail("no format statement in the header", "'format ascii 1.0' or a binary one",
                 "export the mesh again");
    finish();
    return std::move(header_);
  }

 private:
  void statement(std::string_view word) {
    if (word == "comment" || word == "obj_info") {
      text_.next_line();
    } else if (word == "format") {
      format();
    } else if (word == "element") {
      element();
    } else if (word == "property") {
      property();
    } else {
      text_.fail(text_.shown(word), "format, element, property, comment, obj_info or end_header",
                 "the header is damaged: export or copy the file again");
    }
  }

  void format() {
    const std::string_view word = text_.token();
    if (word == "ascii")
      header_.format = PlyFormat::ascii;
    else if (word == "binary_little_endian")
      header_.format = PlyFormat::binary_little_endian;
    else if (word == "binary_big_endian")
      header_.format = PlyFormat::binary_big_endian;
    else
      text_.fail("format " + text_.shown(word), "ascii, binary_little_endian or binary_big_endian",
                 "export the mesh again");
    const std::string_view version = text_.token();
    if (version != "1.0") text_.fail("PLY version " + text_.shown(version), "1.0", "export the mesh again");
    if (has_format_) text_.fail("a second format statement", "one", "correct the header");
    has_format_ = true;
    end_of_line();
  }

  void element() {
    PlyElement& e = header_.elements.emplace_back();
    const std::string_view word = text_.token();
    if (word.empty()) text_.fail(text_.shown(word), "the element's name", "correct the header");
    e.name = word;
    // The line is stored for messages about missing properties.
    e.line = text_.line();
    const std::int64_t count = text_.integer("the number of elements");
    if (count < 0) text_.fail(std::to_string(count) + " elements", "0 or more", "correct the header");
    e.count = static_cast<std::uint64_t>(count);
    // Names identify elements, so they must be unique.
    const auto& all = header_.elements;
    if (std::any_of(all.begin(), all.end() - 1,
                    [&](const PlyElement& other) { return other.name == e.name; }))
      text_.fail("a second element " + in_quotes(e.name), "one of each name", "correct the header");
    end_of_line();
  }

  void property() {
    if (header_.elements.empty())
      text_.fail("a property before any element", "an element statement", "correct the header");
    // Either "property TYPE NAME" or "property list COUNT_TYPE TYPE NAME".
    PlyProperty p;
    std::string_view word = text_.token();
    if (word == "list") {
      p.count_type = type(text_.token());
      if (!is_integer(*p.count_type))
        text_.fail("a list whose length is a float", "an integer type", "export the mesh again");
      word = text_.token();
    }
    p.type = type(word);
    word = text_.token();
    if (word.empty()) text_.fail(text_.shown(word), "the property's name", "correct the header");
    p.name = word;
    auto& known = header_.elements.back().properties;
    if (std::any_of(known.begin(), known.end(),
                    [&](const PlyProperty& other) { return other.name == p.name; }))
      text_.fail("a second property " + in_quotes(p.name), "one of each name", "correct the header");
    known.push_back(std::move(p));
    end_of_line();
  }

  PlyType type(std::string_view word) const {
    for (const auto& [name, type] : kTypes)
      if (name == word) return type;
    text_.fail(text_.shown(word), "a type (char, uchar, short, ushort, int, uint, float, double)",
               "export the mesh again");
  }

  void end_of_line() {
    const std::string_view word = text_.token();
    if (!word.empty()) text_.fail(in_quotes(word), "the end of the line", "correct the header");
  }

  /// Finds the start of the data. Binary data starts directly after the line end, and may look like another
  /// line end: if the header's lines end with CR alone, an LF there is data.
  void finish() {
    end_of_line();
    // The cursor is at the line end after end_header. Skip exactly that line end.
    std::size_t at = bytes_.size() - text_.bytes_left();
    const std::size_t first_cr = bytes_.find('\r');
    const bool cr_alone = first_cr != std::string_view::npos && bytes_.substr(first_cr, 2) != "\r\n";
    if (at < bytes_.size() && bytes_[at] == '\r') {
      ++at;
      if (!cr_alone && at < bytes_.size() && bytes_[at] == '\n') ++at;
    } else if (at < bytes_.size()) {
      ++at;
    }
    header_.data_offset = at;
    header_.data_line = text_.line() + 1;
  }

  std::string_view bytes_;
  TextCursor text_;
  PlyHeader header_;
  bool has_format_ = false;
};

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
  // There are two common names for the list of corners.
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
    // Elements in the order of the header. Unneeded ones are parsed and discarded, because their size may
    // vary.
    for (const PlyElement& e : header_.elements) elements(e);
    source_.end_of_data();
    reject_without_faces(mesh_, name_);
    check_index_limits(mesh_.vertices.size(), mesh_.face_vertices.size(), name_);
    return std::move(mesh_);
  }

 private:
  void elements(const PlyElement& e) {
    if (e.properties.empty()) return;  // such elements take no bytes, regardless of their number
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
    // Against the header's count, because faces may precede vertices.
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
  const PlyHeader header = PlyHeaderReader(bytes, name).read();
  if (header.format == PlyFormat::ascii) {
    reject_nul(bytes, name);
    const PlyText text(bytes.substr(header.data_offset), name, header.data_line);
    return PlyReader(header, text, name).read();
  }
  const std::endian order =
      header.format == PlyFormat::binary_big_endian ? std::endian::big : std::endian::little;
  return PlyReader(header, PlyBytes(bytes, header.data_offset, name, order), name).read();
}

}  // namespace lrb

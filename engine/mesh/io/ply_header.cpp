#include "engine/mesh/io/ply_header.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/file_bytes.hpp"
#include "engine/mesh/io/text_scan.hpp"

namespace lrb {
namespace {

/// The types, under both generations of names.
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

class PlyHeaderReader {
 public:
  PlyHeaderReader(std::string_view bytes, std::string_view name) : bytes_(bytes), text_(bytes, name, {}) {}

  PlyHeader read() {
    text_.any_token();  // "ply", from which the format was recognised
    end_of_line();
    // Statements until end_header. The end of the file gives an empty word, which statement() rejects.
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
    // The line is kept for messages about missing properties.
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

  /// Finds where the data begins. Binary data begins right behind the end of the line, and may look like
  /// another line end: if the header ends its lines with CR alone, an LF there is data.
  void finish() {
    end_of_line();
    // The cursor is at the line end behind end_header. Skip exactly that line end.
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

}  // namespace

std::size_t size_of(PlyType type) {
  static constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(std::string_view bytes, std::string_view name) {
  return PlyHeaderReader(bytes, name).read();
}

}  // namespace lrb

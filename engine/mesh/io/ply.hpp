#pragma once
/// The header of a PLY file, which says what its data consists of.

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mesh/io/scan.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb {

enum class PlyFormat : std::uint8_t { ascii, binary_little_endian, binary_big_endian };
enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

std::size_t size_of(PlyType type);
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

/// Reads the header. Throws InputError naming the line.
PlyHeader read_ply_header(std::string_view bytes, std::string_view name);

// The data of a PLY file as a stream of values, from text or from bytes: two classes with the same
// functions.

/// Data as text: one element per line.
class PlyText {
 public:
  PlyText(std::string_view data, std::string_view name, std::uint64_t first_line)
      : text_(data, name, {}, first_line) {}

  /// Returns true if there can be as many elements as the header says. (Every value takes a character and a
  /// separator; the last one needs no separator.)
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
  /// Checks that nothing follows the last element.
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
  std::string_view waiting_;  ///< a line's first token, which was read to find the line
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

}  // namespace lrb

#pragma once
/// Writes JSON text into a buffer that is flushed to a sink. Builds no tree and does not allocate per value.

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <lrbscope/ids.hpp>

namespace lrb::trace {

/// Returns a number as 16 hexadecimal digits. Files use this for 64-bit hashes, because many readers parse
/// JSON numbers as doubles.
inline std::string to_hex(std::uint64_t value) {
  std::string out(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) out[i] = "0123456789abcdef"[value & 15];
  return out;
}

/// Parses the result of to_hex(). Returns nullopt unless the text is exactly 16 lower-case hexadecimal
/// digits.
inline std::optional<std::uint64_t> from_hex(std::string_view text) {
  if (text.size() != 16) return std::nullopt;
  std::uint64_t value = 0;
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit && (c < 'a' || c > 'f')) return std::nullopt;
    value = value << 4 | static_cast<std::uint64_t>(digit ? c - '0' : c - 'a' + 10);
  }
  return value;
}

/// Receives bytes: a file, a string, ...
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void write(std::string_view bytes) = 0;
};

class StringSink final : public ByteSink {
 public:
  void write(std::string_view bytes) override { text.append(bytes); }
  std::string text;
};

/// Writes values only; the caller writes brackets and commas. Used for events, because a trace can have
/// millions of them.
class JsonOut {
 public:
  explicit JsonOut(ByteSink& sink) : sink_(&sink), buffer_(kBuffer) {}
  JsonOut(const JsonOut&) = delete;
  JsonOut& operator=(const JsonOut&) = delete;

  void raw(std::string_view text) {
    if (text.size() > buffer_.size() - used_) {
      flush();
      if (text.size() > buffer_.size()) return sink_->write(text);
    }
    used_ += text.copy(buffer_.data() + used_, text.size());  // unlike memcpy, also from a null pointer
  }
  void raw(char c) { raw(std::string_view(&c, 1)); }

  void number(std::uint64_t value) {
    reserve_number();
    char* const begin = buffer_.data() + used_;
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + kNumber, value).ptr - begin);
  }

  /// Writes the shortest decimal that parses to the same double, or null if it is not finite (JSON has no
  /// such literal). The text always has a point or an exponent, so that -0.0 stays a double.
  void number(double value);

  /// As above for a float: the shortest decimal that parses to the same float.
  void number(float value);

  /// Writes a quoted, escaped string. Bytes that are not UTF-8 become U+FFFD.
  void string(std::string_view text);

  void flush() {
    sink_->write({buffer_.data(), used_});
    used_ = 0;
  }

 private:
  static constexpr std::size_t kBuffer = 1 << 16;
  static constexpr std::size_t kNumber = 32;  ///< to_chars needs at most 24 for a double, 20 for an integer

  template <class Floating>
  void floating(Floating value);
  void reserve_number() {
    if (buffer_.size() - used_ < kNumber) flush();
  }

  ByteSink* sink_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
};

/// Writes JSON with brackets, commas and line breaks. For metadata, summaries and answers.
class JsonWriter {
 public:
  /// Value of `broken_levels` for output on one line without spaces.
  static constexpr int kCompact = -1;

  /// Containers nested less than `broken_levels` deep get one line per member; deeper ones stay on one line.
  /// `indent` is the indentation of the outermost container, in levels.
  JsonWriter(JsonOut& out, int broken_levels, int indent = 0)
      : out_(&out), broken_levels_(broken_levels), indent_(indent) {}

  JsonWriter& begin_object() { return open('{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_array() { return open('['); }
  JsonWriter& end_array() { return close(']'); }
  JsonWriter& key(std::string_view name);

  /// Writes a boolean, a number, an id, a text, or a list of these.
  template <class T>
  JsonWriter& value(const T& v) {
    if constexpr (std::ranges::range<T> && !std::is_convertible_v<T, std::string_view>) {
      begin_array();
      for (const auto& x : v) value(x);
      return end_array();
    } else {
      separate();
      if constexpr (std::is_same_v<T, bool>)
        out_->raw(v ? "true" : "false");
      else if constexpr (std::is_floating_point_v<T>)
        out_->number(v);
      else if constexpr (std::is_unsigned_v<T>)
        out_->number(static_cast<std::uint64_t>(v));
      else
        out_->string(v);
      return *this;
    }
  }
  JsonWriter& null() { return json("null"); }
  /// Writes text that is already JSON, on one line.
  JsonWriter& json(std::string_view text) {
    separate();
    out_->raw(text);
    return *this;
  }
  template <class Kind>
  JsonWriter& value(Id<Kind> id) {
    return value(id.value());
  }
  template <class T>
  JsonWriter& member(std::string_view name, const T& v) {
    return key(name).value(v);
  }

 private:
  struct Level {
    bool empty = true;
    bool broken = false;
  };
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);
  void separate();
  void break_line(std::size_t depth);

  JsonOut* out_;
  int broken_levels_;
  int indent_;
  bool after_key_ = false;
  std::vector<Level> levels_;
};

/// Returns the output of write(writer), followed by a newline. indent: as in JsonWriter.
template <class Write>
std::string json_text(int indent, const Write& write) {
  StringSink sink;
  JsonOut out(sink);
  JsonWriter writer(out, indent);
  write(writer);
  out.raw('\n');
  out.flush();
  return std::move(sink.text);
}

}  // namespace lrb::trace

#include <cmath>

#include <lrbscope/core/strings.hpp>
#include <lrbscope/trace/json_write.hpp>

namespace lrb::trace {

template <class Floating>
void JsonOut::floating(Floating value) {
  // JSON has no infinity and no NaN.
  if (!std::isfinite(value)) return raw("null");
  reserve_number();
  char* const begin = buffer_.data() + used_;
  // Shortest form that parses to the same double. A fraction marks it as floating point.
  char* end = std::to_chars(begin, begin + kNumber, value).ptr;
  if (std::string_view(begin, static_cast<std::size_t>(end - begin)).find_first_of(".e") ==
      std::string_view::npos) {
    *end++ = '.';
    *end++ = '0';
  }
  used_ += static_cast<std::size_t>(end - begin);
}

void JsonOut::number(double value) {
  floating(value);
}
void JsonOut::number(float value) {
  floating(value);
}

void JsonOut::string(std::string_view text) {
  raw('"');
  while (!text.empty()) {
    const char c = text[0];
    // Invalid bytes become U+FFFD one by one, so the output is always valid UTF-8.
    const std::size_t length = io::utf8_length(text);
    if (length == 0) {
      raw("\xef\xbf\xbd");
    } else if (c == '"' || c == '\\') {
      const char escaped[] = {'\\', c};
      raw({escaped, 2});
    } else if (static_cast<unsigned char>(c) < 0x20) {
      const char escaped[] = {'\\', 'u', '0', '0', "01"[c >> 4], "0123456789abcdef"[c & 15]};
      raw({escaped, 6});
    } else {
      raw(text.substr(0, length));
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  raw('"');
}

void JsonWriter::break_line(std::size_t depth) {
  out_->raw('\n');
  for (std::size_t i = 0; i < static_cast<std::size_t>(indent_) + depth; ++i) out_->raw("  ");
}

void JsonWriter::separate() {
  if (after_key_ || levels_.empty()) {
    after_key_ = false;
    return;
  }
  Level& level = levels_.back();
  if (!level.empty) out_->raw(level.broken || broken_levels_ == kCompact ? "," : ", ");
  level.empty = false;
  if (level.broken) break_line(levels_.size());
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  out_->string(name);
  out_->raw(broken_levels_ == kCompact ? ":" : ": ");
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  out_->raw(bracket);
  levels_.push_back({.empty = true, .broken = static_cast<int>(levels_.size()) < broken_levels_});
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  const Level level = levels_.back();
  levels_.pop_back();
  if (level.broken && !level.empty) break_line(levels_.size());
  out_->raw(bracket);
  return *this;
}

}  // namespace lrb::trace

#include <cmath>

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

namespace {

/// Returns the length of the UTF-8 sequence at the start of `text`, or 0 if it is not valid (RFC 3629: no
/// surrogates, no overlong forms, nothing beyond U+10FFFF).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto within = [&](std::size_t i, unsigned low, unsigned high) {
    return i < text.size() && byte(i) >= low && byte(i) <= high;
  };
  const unsigned first = byte(0);
  // ASCII, then sequences of two, three and four bytes. The second byte's range excludes overlong forms and
  // surrogates.
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return within(1, 0x80, 0xbf) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    const unsigned low = first == 0xe0 ? 0xa0 : 0x80, high = first == 0xed ? 0x9f : 0xbf;
    return within(1, low, high) && within(2, 0x80, 0xbf) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    const unsigned low = first == 0xf0 ? 0x90 : 0x80, high = first == 0xf4 ? 0x8f : 0xbf;
    return within(1, low, high) && within(2, 0x80, 0xbf) && within(3, 0x80, 0xbf) ? 4 : 0;
  }
  return 0;
}

}  // namespace

void JsonOut::string(std::string_view text) {
  raw('"');
  while (!text.empty()) {
    const char c = text[0];
    // Invalid bytes become U+FFFD one by one, so the output is always valid UTF-8.
    const std::size_t length = utf8_length(text);
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

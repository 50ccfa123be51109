#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <lrbscope/core/strings.hpp>

namespace lrb::io {

std::string number_text(double x, int digits) {
  std::array<char, 64> text{};
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, digits).ptr};
}

std::string lower_text(double x, int digits) {
  std::string text = number_text(x, digits);
  double shown = 0;
  std::from_chars(text.data(), text.data() + text.size(), shown);
  if (!(shown > x)) return text;
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - digits + 1);  // unit of the last digit
  return number_text(x - unit / 2, digits);
}

std::string fixed_text(double x, int decimals) {
  std::array<char, 512> text{};  // a double has at most 309 digits before the point
  std::string out(
      text.data(),
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::fixed, decimals).ptr);
  if (out.find('.') == std::string::npos) return out;
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out;
}

std::string exact_text(double x) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

std::string in_words(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

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

std::string valid_utf8(std::string_view text) {
  std::string out;
  for (std::size_t length = 1; !text.empty(); text.remove_prefix(length)) {
    length = utf8_length(text);
    const std::string_view code = text.substr(0, length);
    out += length == 0 || code == "\xef\xbf\xbe" || code == "\xef\xbf\xbf" ? "\xef\xbf\xbd" : code;
    length = std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=./,:@%") == std::string::npos;
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string url_path(const std::string& path) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./~";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    if (kPlain.find(c) != std::string_view::npos) {
      out += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    out += '%';
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

}  // namespace lrb::io

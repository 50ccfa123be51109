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

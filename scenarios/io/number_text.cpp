#include "scenarios/io/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

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
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - digits + 1);  // of the last digit
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

}  // namespace lrb::io

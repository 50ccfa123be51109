#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <Eigen/Core>

namespace lrb::fuzz {

/// Reads bytes one after the other; 0 after the last.
class Choices {
 public:
  explicit Choices(std::string_view bytes) : bytes_(bytes) {}

  unsigned byte() { return at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0; }
  unsigned below(unsigned n) { return byte() % n; }
  double signed_unit() { return static_cast<std::int8_t>(byte()) / 128.0; }

  double number() {
    const unsigned how = byte();
    const double nice = (static_cast<double>(byte()) - 128) / 4;
    switch (how % 8) {
      case 0:
        return nice + std::ldexp(1.0, -static_cast<int>(below(60)));
      case 1:
        return nice - std::ldexp(1.0, -static_cast<int>(below(60)));
      case 2:
        return std::nextafter(nice, how & 8 ? 100.0 : -100.0);
      case 3:
        return std::ldexp(nice, 2 * static_cast<int>(byte()) - 256);
      case 4: {
        std::array<char, sizeof(double)> raw{};
        for (char& c : raw) c = static_cast<char>(byte());
        double x = 0;
        std::memcpy(&x, raw.data(), sizeof x);
        return std::abs(x) < 1e150 ? x : nice;
      }
      default:
        return nice;
    }
  }
  Eigen::Vector3d vector(int dim) {
    const double x = number(), y = number();
    return {x, y, dim == 2 ? 0 : number()};
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

inline void judge(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

}  // namespace lrb::fuzz

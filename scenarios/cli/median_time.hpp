#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace lrb::cli {

/// Returns the median time in microseconds of `repeat` calls of ask(); repeat > 0.
template <class Ask>
double median_us(std::uint32_t repeat, const Ask& ask) {
  std::vector<double> us;
  for (std::uint32_t i = 0; i < repeat; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    ask();
    us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
  }
  const std::size_t middle = us.size() / 2;
  std::nth_element(us.begin(), us.begin() + static_cast<std::ptrdiff_t>(middle), us.end());
  return us[middle];
}

}  // namespace lrb::cli

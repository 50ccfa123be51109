#include "scenarios/report/page/packed.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "engine/core/ids.hpp"

namespace lrb::report {
namespace {

void put(std::vector<std::uint8_t>& bytes, std::uint32_t number, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

}  // namespace

std::string packed(std::span<const std::uint32_t> numbers) {
  std::uint32_t largest = 0;
  for (const std::uint32_t n : numbers)
    if (n != kNull) largest = std::max(largest, n);
  const int size = largest < 0xFF ? 1 : largest < 0xFFFF ? 2 : 4;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size() * static_cast<std::size_t>(size));
  for (const std::uint32_t n : numbers) put(bytes, n, size);  // the low bytes of kNull are all ones
  return "u" + std::to_string(size) + ":" + base64(bytes.data(), bytes.size());
}

std::string packed(std::span<const float> numbers) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size() * 4);
  for (const float n : numbers) put(bytes, std::bit_cast<std::uint32_t>(n), 4);
  return "f4:" + base64(bytes.data(), bytes.size());
}

}  // namespace lrb::report

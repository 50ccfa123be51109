#pragma once
/// Counts that child processes send through a pipe, and their sums.

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>

namespace lrb::torture {

/// Has counts of 64 bits and no other members; differences() is the number of those that should be 0.
template <class T>
concept CountsOnly = requires(const T& t) {
  { t.differences() } -> std::same_as<std::uint64_t>;
};

template <CountsOnly T>
T& operator+=(T& sum, const T& part) {
  using Counts = std::array<std::uint64_t, sizeof(T) / sizeof(std::uint64_t)>;
  auto counts = std::bit_cast<Counts>(sum);
  const auto more = std::bit_cast<Counts>(part);
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += more[i];
  return sum = std::bit_cast<T>(counts);
}

}  // namespace lrb::torture

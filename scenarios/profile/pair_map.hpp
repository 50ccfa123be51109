#pragma once
/// A hash map of pairs of numbers, such as nodes of two trees.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lrbscope/ids.hpp>

namespace lrb::profile {

/// Maps pairs of 32-bit numbers to 32-bit numbers: open addressing with linear probing, without removal. The
/// pair (kNull, kNull) is reserved.
class PairMap {
 public:
  PairMap() { clear(); }

  void clear() {
    slots_.assign(kFirst, {});
    size_ = 0;
  }
  std::size_t size() const { return size_; }

  /// Returns the value of a pair, or nullptr without one. Valid until the next insertion.
  std::uint32_t* find(std::uint32_t a, std::uint32_t b) {
    Slot& slot = slots_[place_of(key_of(a, b))];
    return slot.key == kFree ? nullptr : &slot.value;
  }
  const std::uint32_t* find(std::uint32_t a, std::uint32_t b) const {
    const Slot& slot = slots_[place_of(key_of(a, b))];
    return slot.key == kFree ? nullptr : &slot.value;
  }
  /// Inserts a pair unless it exists. Returns its value.
  std::uint32_t& insert(std::uint32_t a, std::uint32_t b, std::uint32_t value) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    Slot& slot = slots_[place_of(key_of(a, b))];
    if (slot.key == kFree) {
      slot = {key_of(a, b), value};
      ++size_;
    }
    return slot.value;
  }

 private:
  static constexpr std::size_t kFirst = 64;  ///< a power of two
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kFree;
    std::uint32_t value = 0;
  };

  static std::uint64_t key_of(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

  /// Returns the slot of a key, or the free one where it belongs.
  std::size_t place_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    // Fibonacci hashing (Knuth, The Art of Computer Programming, volume 3, section 6.4), upper bits.
    std::size_t i = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> 32) & mask;
    while (slots_[i].key != kFree && slots_[i].key != key) i = (i + 1) & mask;
    return i;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key != kFree) slots_[place_of(slot.key)] = slot;
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace lrb::profile

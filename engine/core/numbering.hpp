#pragma once
/// Numbers keys in the order of their first use, with memory that is reused.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <lrbscope/ids.hpp>

namespace lrb {

/// Numbers distinct keys in the order of their first use: 0, 1, ... A hash table with open addressing that
/// keeps its memory; clearing it takes constant time.
template <std::size_t kWords>
class Numbering {
 public:
  using Key = std::array<std::uint64_t, kWords>;

  /// Removes all keys. `expected`: the number of keys that will follow; more are possible.
  void begin(std::size_t expected) {
    count_ = 0;
    resize(std::bit_ceil(2 * expected + 2));
    if (++epoch_ != 0) return;
    for (Slot& slot : slots_) slot.epoch = 0;
    epoch_ = 1;
  }

  /// Returns the number of a key, and true if the key is new.
  std::pair<std::uint32_t, bool> number(const Key& key) {
    Slot& slot = slots_[find(key)];
    if (slot.epoch == epoch_) return {slot.number, false};
    slot = {key, count_, epoch_};
    if (2 * ++count_ > capacity_) grow();
    return {count_ - 1, true};
  }

  bool contains(const Key& key) const { return slots_[find(key)].epoch == epoch_; }

 private:
  struct Slot {
    Key key{};
    std::uint32_t number = 0;
    std::uint32_t epoch = 0;  ///< the slot is used if it is the current epoch
  };

  /// Uses the first `capacity` slots, a power of two. The others are kept for later.
  void resize(std::size_t capacity) {
    capacity_ = capacity;
    shift_ = 64 - std::countr_zero(capacity);
    if (slots_.size() < capacity) slots_.resize(capacity);
  }

  /// Returns the slot of a key, or the free slot for it. At least half of the slots are free.
  std::size_t find(const Key& key) const {
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;  // multiplicative hashing
    std::uint64_t h = 0;
    for (const std::uint64_t word : key) h = ((h ^ h >> 32) + word) * kOdd;
    std::size_t i = static_cast<std::size_t>(h >> shift_);
    while (slots_[i].epoch == epoch_ && !are_equal(slots_[i].key, key)) i = (i + 1) & (capacity_ - 1);
    return i;
  }

  /// Compares without a call of memcmp(), as GCC 12 makes for ==.
  static bool are_equal(const Key& a, const Key& b) {
    bool equal = true;
    for (std::size_t i = 0; i < kWords; ++i) equal &= a[i] == b[i];
    return equal;
  }

  void grow() {
    std::vector<Slot> used;
    for (std::size_t i = 0; i < capacity_; ++i)
      if (slots_[i].epoch == epoch_) used.push_back(std::exchange(slots_[i], {}));
    resize(2 * capacity_);
    for (const Slot& slot : used) slots_[find(slot.key)] = slot;
  }

  std::vector<Slot> slots_;
  std::size_t capacity_ = 0;
  int shift_ = 0;
  std::uint32_t count_ = 0;
  std::uint32_t epoch_ = 0;
};

/// Numbers some of the ids 0, 1, ... in the order of their first use; forgetting them takes constant time.
class SparseNumbers {
 public:
  void begin(std::size_t ids) {
    if (entries_.size() < ids) entries_.resize(ids);
    count_ = 0;
    if (++epoch_ != 0) return;
    for (Entry& entry : entries_) entry.epoch = 0;
    epoch_ = 1;
  }
  /// Returns the number of an id, and true if the id is new.
  std::pair<std::uint32_t, bool> add(std::uint32_t id) {
    Entry& entry = entries_[id];
    if (entry.epoch == epoch_) return {entry.number, false};
    entry = {epoch_, count_};
    return {count_++, true};
  }
  /// Returns kNull if the id has no number.
  std::uint32_t operator()(std::uint32_t id) const {
    return entries_[id].epoch == epoch_ ? entries_[id].number : kNull;
  }
  std::uint32_t size() const { return count_; }

 private:
  struct Entry {
    std::uint32_t epoch = 0, number = 0;
  };
  std::vector<Entry> entries_;
  std::uint32_t epoch_ = 0, count_ = 0;
};

}  // namespace lrb

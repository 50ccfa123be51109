#include "engine/query/pair_order.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace lrb {
namespace {

/// Digits of the radix sort have at most so many bits: tables that fit the first cache. It is worth its
/// passes for more pairs than a digit has values.
constexpr unsigned kDigitBits = 11;
constexpr std::size_t kWorthDigits = std::size_t{1} << kDigitBits;
constexpr unsigned kMeetBits = 1;

/// Numbers that do not fit a key: bodies of billions of simplices.
void sort_by_comparing(CollideResult& result) {
  std::vector<std::pair<SimplexPair, exact::Meet>> found;
  for (std::size_t i = 0; i < result.pairs.size(); ++i) found.emplace_back(result.pairs[i], result.meets[i]);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  result.pairs.clear();
  result.meets.clear();
  for (const auto& [pair, meet] : found) {
    result.pairs.push_back(pair);
    result.meets.push_back(meet);
  }
}

}  // namespace

void PairOrder::sort(CollideResult& result) {
  SimplexPair all{0, 0};  // all bits that occur
  bool in_order = true;   // strictly: without repetitions
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    const SimplexPair p = result.pairs[i];
    in_order &= i == 0 || result.pairs[i - 1] < p;
    all = {all.a | p.a, all.b | p.b};
  }
  if (in_order) return;
  const auto bits_b = static_cast<unsigned>(std::bit_width(all.b));
  const unsigned key_bits = static_cast<unsigned>(std::bit_width(all.a)) + bits_b + kMeetBits;
  if (key_bits > 64) return sort_by_comparing(result);
  keys_.resize(result.pairs.size());
  for (std::size_t i = 0; i < keys_.size(); ++i)
    keys_[i] = (std::uint64_t{result.pairs[i].a} << bits_b | result.pairs[i].b) << kMeetBits |
               static_cast<std::uint64_t>(result.meets[i] == exact::Meet::cross);
  sort_keys(key_bits);
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  result.pairs.resize(keys_.size());
  result.meets.resize(keys_.size());
  const std::uint64_t b_only = (std::uint64_t{1} << bits_b) - 1;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const std::uint64_t pair = keys_[i] >> kMeetBits;
    result.pairs[i] = {static_cast<SimplexId>(pair >> bits_b), static_cast<SimplexId>(pair & b_only)};
    result.meets[i] = (keys_[i] & 1) != 0 ? exact::Meet::cross : exact::Meet::touch;
  }
}

void PairOrder::sort_keys(unsigned key_bits) {
  if (keys_.size() > kWorthDigits)
    sort_by_digits(key_bits);
  else
    std::sort(keys_.begin(), keys_.end());
}

/// The last digit first: each pass keeps the order of those before it. How a pair meets needs no order.
void PairOrder::sort_by_digits(unsigned key_bits) {
  const unsigned bits = key_bits - kMeetBits, passes = std::max(1u, (bits + kDigitBits - 1) / kDigitBits);
  const unsigned digit_bits = (bits + passes - 1) / passes;
  const std::size_t values = std::size_t{1} << digit_bits;
  const auto digit = [&](std::uint64_t key, unsigned pass) {
    return key >> (kMeetBits + pass * digit_bits) & (values - 1);
  };
  moved_.resize(keys_.size());
  places_.assign(passes * values, 0);
  for (const std::uint64_t key : keys_)
    for (unsigned pass = 0; pass < passes; ++pass) ++places_[pass * values + digit(key, pass)];
  for (unsigned pass = 0; pass < passes; ++pass) {
    std::uint32_t* const place = places_.data() + pass * values;
    std::uint32_t before = 0;
    for (std::size_t v = 0; v < values; ++v) before += std::exchange(place[v], before);
    for (const std::uint64_t key : keys_) moved_[place[digit(key, pass)]++] = key;
    keys_.swap(moved_);
  }
}

}  // namespace lrb

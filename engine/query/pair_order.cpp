#include "engine/query/pair_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace lrb {
namespace {

/// Digits of the radix sort: tables that fit the first cache. It is worth its passes for more pairs than
/// there are values of a digit.
constexpr unsigned kDigitBits = 11;
constexpr std::size_t kDigitValues = std::size_t{1} << kDigitBits;

}  // namespace

void PairOrder::sort(CollideResult& result) {
  SimplexPair most{0, 0};
  bool in_order = true;  // strictly: without repetitions
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    const SimplexPair p = result.pairs[i];
    in_order &= i == 0 || result.pairs[i - 1] < p;
    most = {std::max(most.a, p.a), std::max(most.b, p.b)};
  }
  if (in_order) return;
  found_.clear();
  for (std::size_t i = 0; i < result.pairs.size(); ++i) found_.push_back({result.pairs[i], result.meets[i]});
  if (found_.size() > kDigitValues)
    sort_by_digits(most.a, most.b);
  else
    std::sort(found_.begin(), found_.end(), [](const Found& x, const Found& y) { return x.pair < y.pair; });
  std::size_t kept = 0;
  for (const Found& f : found_) {
    if (kept > 0 && result.pairs[kept - 1] == f.pair) continue;
    result.pairs[kept] = f.pair;
    result.meets[kept++] = f.meet;
  }
  result.pairs.resize(kept);
  result.meets.resize(kept);
}

/// The last digit of the last number first: each pass keeps the order of those before it.
void PairOrder::sort_by_digits(SimplexId most_a, SimplexId most_b) {
  moved_.resize(found_.size());
  for (const auto& [id, most] : {std::pair{&SimplexPair::b, most_b}, std::pair{&SimplexPair::a, most_a}})
    for (unsigned shift = 0; shift < static_cast<unsigned>(std::bit_width(most)); shift += kDigitBits)
      sort_by_digit(id, shift);
}

void PairOrder::sort_by_digit(SimplexId SimplexPair::*id, unsigned shift) {
  std::array<std::uint32_t, kDigitValues> place{};
  const auto digit = [&](const Found& f) { return f.pair.*id >> shift & (kDigitValues - 1); };
  for (const Found& f : found_) ++place[digit(f)];
  std::uint32_t before = 0;
  for (std::uint32_t& p : place) before += std::exchange(p, before);
  for (const Found& f : found_) moved_[place[digit(f)]++] = f;
  found_.swap(moved_);
}

}  // namespace lrb

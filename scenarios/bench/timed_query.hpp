#pragma once
/// Asks the same again and again, to measure how long an answer takes.

#include <algorithm>

namespace lrb::bench {

/// Walks over more memory than most last-level caches hold: what a query needs is fetched again after it.
void sweep_caches();

struct QueryTimes {
  double cold_us = 0;  ///< of the first answer, after caches were swept
  double hot_us = 0;   ///< the best of a few more
};

/// Returns the first answer of query(), which has `microseconds`, and fills in the times.
template <class Query>
auto ask_again_and_again(const Query& query, QueryTimes& times) {
  constexpr int kMost = 25, kLeast = 3;
  constexpr double kEnough = 20e3, kLong = 300e3;  // microseconds
  sweep_caches();
  auto answer = query();
  times.cold_us = times.hot_us = answer.microseconds;
  double spent = 0;
  for (int i = 0; i < kMost && times.cold_us < kLong && (i < kLeast || spent < kEnough); ++i) {
    const double us = query().microseconds;
    times.hot_us = std::min(times.hot_us, us);
    spent += us;
  }
  return answer;
}

}  // namespace lrb::bench

#pragma once
/// Puts a data set's questions to one method, and measures the time. For worker programs.

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "bench/rivals/method.hpp"
#include "bench/speed/record.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::bench {

class BenchRunner {
 public:
  /// The method must be present. `keep`: the records hold pairs and points.
  BenchRunner(const methods::MethodEntry& entry, std::optional<double> setting, const DataSet& set,
              bool keep);

  /// Puts a question to the method. A refusal is an outcome, too. Throws InputError if there is no such
  /// question.
  Record ask(std::uint64_t question);

 private:
  struct Built {
    std::unique_ptr<methods::MethodBody> body;
    double seconds = 0, bytes = 0;
  };

  const Built& built(std::size_t body, std::size_t side);
  Reply ask(const Question& q, Mode mode);

  methods::MethodInfo info_;
  std::unique_ptr<methods::Method> method_;
  std::optional<double> setting_;
  const DataSet& set_;
  bool keep_;
  std::map<std::pair<std::size_t, std::size_t>, Built> built_;  ///< by body and side
};

/// Returns every pair of real triangles that meets: by a sweep over boxes in the world, and exact tests of
/// what is left. Shares with the query the predicates and the definition of world coordinates, and nothing
/// else.
std::vector<SimplexPair> exact_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                     const Pose& pose_b);

// Asks the same again and again, to measure how long an answer takes.

/// Walks over more memory than most last-level caches hold: what a query needs is fetched again after it.
void sweep_caches();

struct QueryTimes {
  double cold_us = 0;  ///< of the first answer, after caches were swept
  double hot_us = 0;   ///< the best of a few more
};

/// Returns the first answer of query(), which has `microseconds`, and fills in the times.
template <class Query>
auto ask_again_and_again(const Query& query, QueryTimes& times) {
  constexpr int kMax = 25, kLeast = 3;
  constexpr double kEnough = 20e3, kLong = 300e3;  // microseconds
  sweep_caches();
  auto answer = query();
  times.cold_us = times.hot_us = answer.microseconds;
  double spent = 0;
  for (int i = 0; i < kMax && times.cold_us < kLong && (i < kLeast || spent < kEnough); ++i) {
    const double us = query().microseconds;
    times.hot_us = std::min(times.hot_us, us);
    spent += us;
  }
  return answer;
}

}  // namespace lrb::bench

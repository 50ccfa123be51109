#pragma once
/// Runs one method on the queries of a data set, and measures the time. For worker programs.

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "bench/methods/method.hpp"
#include "bench/speed/data_set.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::speed {

class BenchRunner {
 public:
  /// The method must be present, and outlive this object. `judges`: records contain the errors of answers,
  /// which take longer to compute than the answers.
  BenchRunner(const methods::MethodEntry& entry, std::optional<double> setting, const DataSet& set,
              bool judges);

  /// Runs the method on a query. A rejection is a valid outcome. Throws InputError if there is no such query.
  Record ask(std::uint64_t question);

 private:
  struct Built {
    std::unique_ptr<methods::MethodBody> body;
    double seconds = 0, bytes = 0;
  };

  const Built& built(std::size_t body, std::size_t side);
  Reply ask(const Question& q, Mode mode, Errors* errors);
  void ask_number(const Question& q, Record& r) const;
  const LrbRep& rep(std::size_t body);

  const methods::MethodEntry& entry_;
  const methods::MethodInfo& info_;
  std::unique_ptr<methods::Method> method_;  ///< null for numbers
  std::optional<double> setting_;
  const DataSet& set_;
  bool judges_;
  std::map<std::pair<std::size_t, std::size_t>, Built> built_;  ///< by body and side
  std::map<std::size_t, LrbRep> reps_;                          ///< by body; for judging
};

/// Returns every pair of real triangles that intersect or are at most `within` apart, as brute_force() does.
std::vector<SimplexPair> exact_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                     double within = 0);

// Repeats a query, to measure the time of an answer.

/// Reads more memory than most last-level caches contain, so that the next query fetches its data again.
void sweep_caches();

/// Returns the number of bytes of the heap that are in use.
double heap_bytes();

struct QueryTimes {
  double cold_us = 0;  ///< of the first query, after caches were swept
  double hot_us = 0;   ///< minimum of some repetitions
};

/// Returns the first answer of query(), which has a member `microseconds`, and sets the times.
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

}  // namespace lrb::speed

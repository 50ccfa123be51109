#pragma once
/// Compares our method with its peers, from records: ratios, times and exactness.

#include <string>
#include <vector>

#include "bench/rivals/method.hpp"
#include "bench/speed/record.hpp"

namespace lrb::bench {

/// Returns what /proc/cpuinfo says: "2 cores of an AMD EPYC".
std::string machine();
/// Returns what all our code and others' headers were compiled with: "GCC 12.2, -O3 -march=native".
std::string build_flags();

/// One method on one class of poses of one data set, in one mode.
struct PeerCell {
  std::string set, method;
  PoseClass pose_class = PoseClass::apart;
  Mode mode = Mode::all_pairs;
  std::size_t questions = 0, answered = 0, crashed = 0, timed_out = 0;
  double hot = 0, hot_p95 = 0, cold = 0, cold_p95 = 0;  ///< microseconds: median and 95th percentile
  double ratio = 0, cold_ratio = 0;  ///< to ours: median over the questions; 0: no answer to compare
  double pairs = 0;                  ///< average number found
  std::uint64_t missed = 0, extra = 0;
};

struct PeerTable {
  std::vector<std::string> sets;             ///< names
  std::vector<methods::MethodInfo> methods;  ///< in the order of columns; ours first
  std::vector<PeerCell> cells;

  const PeerCell* find(const std::string& set, const std::string& method, PoseClass c, Mode mode) const;
};

/// Makes the table. Everything is compared with the method whose role is `ours`.
PeerTable peer_table(const std::vector<DataSet>& sets, const std::vector<methods::MethodInfo>& methods,
                     const std::vector<Record>& records);

/// Returns the text for stdout: ratios, their geometric means against what was aimed at, where a peer is
/// ahead, what exactness costs, and who answered exactly.
std::string in_brief(const PeerTable& table);
/// Returns a line for every cell, with all its numbers.
std::string in_full(const PeerTable& table);

}  // namespace lrb::bench

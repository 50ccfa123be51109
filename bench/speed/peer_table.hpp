#pragma once
/// Compares lrbscope with other engines, from records: ratios, times and exactness.

#include <string>
#include <vector>

#include "bench/methods/method.hpp"
#include "bench/speed/data_set.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::speed {

/// Returns the processor as in /proc/cpuinfo: "2 cores of an AMD EPYC".
std::string machine();
/// Returns the compiler and flags of lrbscope and of other engines' headers: "GCC 12.2, -O3 -march=native".
std::string build_flags();

/// A method on one class of poses of a data set, in one mode.
struct PeerCell {
  std::string set, method;
  PoseClass pose_class = PoseClass::apart;
  Mode mode = Mode::all_pairs;
  std::size_t questions = 0, answered = 0, crashed = 0, timed_out = 0;
  double hot = 0, hot_p95 = 0, cold = 0, cold_p95 = 0;  ///< microseconds: median and 95th percentile
  double ratio = 0, cold_ratio = 0;  ///< to lrbscope: median over the queries; 0: no answer
  double pairs = 0;                  ///< mean number found
  std::uint64_t missed = 0, extra = 0;
};

struct PeerTable {
  methods::Quantity quantity = methods::Quantity::pairs;
  std::vector<std::string> sets;             ///< names
  std::vector<PoseClass> classes;            ///< of poses
  std::vector<methods::MethodInfo> methods;  ///< in the order of columns; lrbscope first
  std::vector<PeerCell> cells;

  const PeerCell* find(const std::string& set, const std::string& method, PoseClass c, Mode mode) const;
};

/// Returns the table. All sets and methods are of one quantity: pairs, or distances, whose only mode is
/// all_pairs. Ratios are relative to the method whose role is `ours`.
PeerTable peer_table(const std::vector<DataSet>& sets, const std::vector<methods::MethodInfo>& methods,
                     const std::vector<Record>& records);

/// Returns the text for stdout: ratios, their geometric means, the methods that were exact, and where another
/// engine is faster.
std::string in_brief(const PeerTable& table);
/// Returns lrbscope's times in one mode, and the ratios of all other methods to them.
report::Table table_of_ratios(const PeerTable& table, Mode mode);
/// Returns a row for every cell, with all its numbers.
report::Table table_of_cells(const PeerTable& table);

}  // namespace lrb::speed

#pragma once
/// Runs every method on every query of some data sets, in processes that may crash or hang, and keeps the
/// records. They are appended to a file at once, so that an interrupted survey resumes where it stopped.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/speed/record.hpp"
#include "bench/workers/workers.hpp"

namespace lrb::bench {

/// A method at one setting of its parameter.
struct Contestant {
  workers::WorkerMethod method;
  std::optional<double> setting;
};

/// Returns the present methods, once per setting.
std::vector<Contestant> contestants(const std::vector<workers::WorkerMethod>& methods);

struct SurveyOptions {
  std::string folder;  ///< contains the data sets' files; records.jsonl is written there
  std::vector<DataSet> sets;
  std::vector<Contestant> contestants;
  double timeout = 20;  ///< time limit in seconds per query, including repetitions
  bool keep = false;    ///< stores pairs and points
};

using SurveyProgress = std::function<void(std::uint64_t done, std::uint64_t total, const std::string& what)>;

/// Returns all records, including earlier ones. Methods alternate per class of poses, so that other load on
/// the machine slows all of them alike. Runs one process at a time, because times are measured.
std::vector<Record> survey(const SurveyOptions& options, const SurveyProgress& progress);

}  // namespace lrb::bench

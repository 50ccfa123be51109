#pragma once
/// Puts every question of some data sets to every method, in processes that may die or hang, and keeps the
/// records. They are appended to a file as they come, so that a survey that was interrupted goes on where it
/// was.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/speed/record.hpp"
#include "bench/workers/workers.hpp"

namespace lrb::bench {

/// A method at one setting of its knob.
struct Contestant {
  workers::WorkerMethod method;
  std::optional<double> setting;
};

/// Returns the methods that are present, once for each of their settings.
std::vector<Contestant> contestants(const std::vector<workers::WorkerMethod>& methods);

struct SurveyOptions {
  std::string folder;  ///< holds the data sets' files; records.jsonl is written there
  std::vector<DataSet> sets;
  std::vector<Contestant> contestants;
  double timeout = 20;  ///< time in seconds for a question, with all repeats
  bool keep = false;    ///< keeps pairs and points
};

using SurveyProgress = std::function<void(std::uint64_t done, std::uint64_t total, const std::string& what)>;

/// Returns all records, including those from earlier. Methods take turns, class of poses by class, so that
/// whatever else the machine does slows all of them alike. Runs one process at a time, because they are being
/// timed.
std::vector<Record> survey(const SurveyOptions& options, const SurveyProgress& progress);

}  // namespace lrb::bench

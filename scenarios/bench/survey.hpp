#pragma once
/// Asks every method every question of some data sets, in processes that may die or hang, and keeps the
/// records: appended to a file as they come, so that a survey that was interrupted goes on where it was.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/bench/record.hpp"
#include "scenarios/workers/workers.hpp"

namespace lrb::bench {

/// A method at a setting of its knob.
struct Contestant {
  workers::WorkerMethod method;
  std::optional<double> setting;
};

/// Methods that are present, once for each of their settings.
std::vector<Contestant> contestants(const std::vector<workers::WorkerMethod>& methods);

struct SurveyOptions {
  std::string folder;  ///< with the data sets' files; records.jsonl is written there
  std::vector<DataSet> sets;
  std::vector<Contestant> contestants;
  double timeout = 20;  ///< seconds for a question, all repeats
  bool keep = false;    ///< pairs and points
};

using SurveyProgress = std::function<void(std::uint64_t done, std::uint64_t total, const std::string& what)>;

/// All records, those from earlier among them. Methods take turns, class of poses by class, so that what else
/// the machine does falls on all of them. One process at a time: they are being timed.
std::vector<Record> survey(const SurveyOptions& options, const SurveyProgress& progress);

}  // namespace lrb::bench

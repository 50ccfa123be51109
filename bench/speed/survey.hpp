#pragma once
/// Runs every method on every query of some data sets, in processes that may crash or hang, and keeps the
/// records. They are appended to a file at once, so that an interrupted survey resumes where it stopped.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/speed/data_set.hpp"
#include "bench/workers/workers.hpp"

namespace lrb::speed {

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
  bool judges = false;  ///< records contain the errors of answers
  unsigned rounds = 1;  ///< each method is timed again in each, after all others
};

using SurveyProgress = std::function<void(std::uint64_t done, std::uint64_t total, const std::string& what)>;

/// Returns all records, including earlier ones. Methods alternate per class of poses, and rounds follow each
/// other, so that other load on the machine slows all of them alike. Runs one process at a time, because
/// times are measured. Methods that crashed or timed out are not timed again.
std::vector<Record> survey(const SurveyOptions& options, const SurveyProgress& progress);

// The plan of a survey: the answers that it is to measure, so that charts of unfinished surveys name what is
// missing.

/// Number of answers of a data set that a survey is to measure, and that are missing.
struct Missing {
  std::string set;  ///< name
  std::uint64_t planned = 0, missing = 0;
};

/// Writes the plan to the survey's folder, merged with the plan of an earlier part of the survey.
void write_plan(const SurveyOptions& options, const std::vector<std::string>& sets);
/// Returns the missing answers of each data set of the plan, or an empty list for a finished survey and for
/// one without a plan.
std::vector<Missing> missing_answers(const std::string& folder, const std::vector<DataSet>& sets,
                                     const std::vector<Record>& records);
/// Returns a sentence that names them, or an empty string.
std::string missing_text(const std::vector<Missing>& missing);

}  // namespace lrb::speed

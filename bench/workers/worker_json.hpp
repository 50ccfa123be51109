#pragma once
/// A worker's lines: the description of its methods, one a line, and answers.

#include <exception>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/methods/method.hpp"
#include "bench/workers/workers.hpp"
#include "trace/json_records.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>

namespace lrb::workers {

/// Returns JSON as a line. Text that is not UTF-8 is replaced.
std::string line_of(const nlohmann::ordered_json& value);

nlohmann::ordered_json to_json(const methods::MethodInfo& info);
/// Reads a line. Throws InputError, which describes the error in the line, if it is invalid.
methods::MethodInfo method_info_from(const nlohmann::json& value);

/// Answers to cases and bodies; without what only data sets need.
nlohmann::ordered_json to_json(const methods::Answer& answer);
methods::Answer answer_from(nlohmann::json value);
/// Asks a worker. An answer that does not come has the outcome `crashed` or `timed_out`.
methods::Answer answer_of(Worker& worker, const nlohmann::ordered_json& question,
                          std::chrono::duration<double> limit);

// Outcome of a query that a method rejects, or that ends with an exception.

/// Calls ask(). Records an InputError as a rejection, and any other exception as a crash, with its message.
/// Record: an answer or a record of one.
template <class Record, class Ask>
void note_failures(Record& record, Ask ask) {
  using methods::Outcome;
  try {
    ask();
  } catch (const InputError& e) {
    record.outcome = Outcome::rejected;
    record.message = e.what();
  } catch (const std::exception& e) {
    record.outcome = Outcome::crashed;
    record.message = std::string("threw an exception: ") + e.what();
  }
}

/// Records that a worker did not answer.
template <class Record>
void note_failure(Record& record, const WorkerFailure& failure) {
  record.outcome = failure.timed_out ? methods::Outcome::timed_out : methods::Outcome::crashed;
  record.message = failure.message;
}

}  // namespace lrb::workers

// Pairs of simplices in JSON: one array of numbers, A's and B's of the first pair, then of the second, and so
// on.

template <>
struct lrb::io::JsonOf<std::vector<lrb::SimplexPair>> {
  static nlohmann::ordered_json write(const std::vector<SimplexPair>& pairs) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const SimplexPair& p : pairs) {
      out.push_back(p.a.value());
      out.push_back(p.b.value());
    }
    return out;
  }
  static std::vector<SimplexPair> read(const nlohmann::json& flat) {
    std::vector<SimplexPair> out;
    for (std::size_t i = 0; i + 1 < flat.size(); i += 2)
      out.push_back({SimplexId(flat[i].get<std::uint32_t>()), SimplexId(flat[i + 1].get<std::uint32_t>())});
    return out;
  }
};

namespace lrb::workers {
using PairsJson = io::JsonOf<std::vector<SimplexPair>>;
}  // namespace lrb::workers

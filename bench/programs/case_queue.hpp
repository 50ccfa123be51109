#pragma once
/// The cases that a worker runs, as selected on its command line.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bench/methods/method.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/stability_experiment.hpp"
#include <lrbscope/error.hpp>

namespace lrb::worker_programs {

// The lines of JSON that a worker writes to stdout.

/// lrbscope's lines have a separate channel; libraries that print to stdout print to stderr instead.
class Lines {
 public:
  Lines() : out_(fdopen(dup(STDOUT_FILENO), "w")) { dup2(STDERR_FILENO, STDOUT_FILENO); }
  void say(const std::string& line) {
    if (out_ == nullptr || std::fputs(line.c_str(), out_) < 0 || std::fflush(out_) != 0)
      std::_Exit(1);  // the reader has closed the channel
  }

 private:
  std::FILE* out_;
};

inline std::string dump(const nlohmann::ordered_json& value) {
  return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Cases begin to end - 1 of a family: `cases` for each difficulty.
struct CaseQueue {
  bool list = false;  ///< no cases: list the worker's methods
  std::string family, method, expected;
  std::uint64_t seed = 1, cases = 1, begin = 0, end = 0;
};

inline void add_options(CLI::App& app, CaseQueue& queue) {
  app.add_flag("--list", queue.list);
  app.add_option("--family", queue.family);
  app.add_option("--method", queue.method);
  app.add_option("--seed", queue.seed);
  app.add_option("--cases", queue.cases)->check(CLI::PositiveNumber);
  app.add_option("--begin", queue.begin);
  app.add_option("--end", queue.end);
  app.add_option("--expected", queue.expected);
}

/// Throws InputError if the family is unknown.
inline const cases::Family& family_of(const CaseQueue& queue) {
  const cases::Family* family = cases::find_family(queue.family);
  if (family == nullptr) throw InputError("unknown family '" + queue.family + "'");
  return *family;
}

inline cases::Case make(const cases::Family& family, const CaseQueue& queue, std::uint64_t number) {
  return cases::make_case(family, queue.seed, static_cast<int>(number / queue.cases), number % queue.cases);
}

/// Returns the record of a case, before it is answered.
inline stability::Record record_of(const CaseQueue& queue, std::uint64_t number) {
  stability::Record record;
  record.family = queue.family;
  record.method = queue.method;
  record.difficulty = static_cast<int>(number / queue.cases);
  record.case_index = number % queue.cases;
  record.seed = queue.seed;
  return record;
}

/// Correct answers from a file, starting at the first requested case.
class KnownAnswers {
 public:
  /// Throws InputError if a file is given and ends before that case.
  explicit KnownAnswers(const CaseQueue& queue) {
    if (queue.expected.empty()) return;
    in_.open(queue.expected);
    std::string line;
    for (std::uint64_t k = 0; k < queue.begin; ++k) std::getline(in_, line);
    if (!in_) throw InputError(queue.expected + ": has too few lines");
  }
  /// Returns the next answer, or nullopt without a file or at its end.
  std::optional<stability::RightAnswer> next() {
    std::string line;
    if (!in_.is_open() || !std::getline(in_, line)) return std::nullopt;
    return stability::expected_from(line);
  }

 private:
  std::ifstream in_;
};

/// Calls work(lines). Returns the exit code: 2, after a line with the error, if it throws.
template <class Work>
int run_worker(Work work) {
  constexpr int kOk = 0, kBadInput = 2;
  Lines out;
  try {
    work(out);
    return kOk;
  } catch (const std::exception& e) {
    out.say(dump({{"error", e.what()}}));
    return kBadInput;
  }
}

}  // namespace lrb::worker_programs

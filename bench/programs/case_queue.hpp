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

void add_options(CLI::App& app, CaseQueue& queue);

/// Throws InputError if the family is unknown.
const cases::Family& family_of(const CaseQueue& queue);
cases::Case make(const cases::Family& family, const CaseQueue& queue, std::uint64_t number);
/// Returns the record of a case, before it is answered.
stability::Record record_of(const CaseQueue& queue, std::uint64_t number);

/// Correct answers from a file, starting at the first requested case.
class KnownAnswers {
 public:
  /// Throws InputError if a file is given and ends before that case.
  explicit KnownAnswers(const CaseQueue& queue);
  /// Returns the next answer, or nullopt without a file or at its end.
  std::optional<stability::RightAnswer> next();

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

// Methods that misbehave, to test the handling of failures. They are listed only if the environment has
// LRBSCOPE_FAKE_METHODS.

/// Returns the fake methods. All answer correctly if there is no contact. Otherwise "fake-crash" aborts,
/// "fake-hang" never returns, "fake-refuse" rejects the query, "fake-throw" throws, and "fake-miss" omits the
/// first pair. "fake-absent" is absent. Returns an empty list if "ours", which they imitate, is not among the
/// program's methods.
std::vector<methods::MethodEntry> fake_methods(const std::vector<methods::MethodEntry>& methods);

}  // namespace lrb::worker_programs

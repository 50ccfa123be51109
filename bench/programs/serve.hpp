#pragma once
/// The protocol of worker programs. A worker is started with
///   --list [--quantity Q]           prints its methods, a line of JSON each
///   [--method M] [--quantity Q]     answers each line of file descriptor 3, until its end, with a line on
///   stdout
/// Questions and answers are JSON objects. Without a method, answers are the right ones. An answer
/// {"error": "..."} ends the worker with exit code 2. Questions (bench/programs/methods.cpp and
/// quantities.cpp):
///   {"family", "seed", "difficulty", "case", ["right": FILE, "line"], ["pairs"]}
///                         a stability::Record; FILE has a right answer in each line, which is computed
///                         without it; with pairs also the list of pairs. Without a method, a
///                         stability::RightAnswer
///   {"saved": FILE, ...}  the same for the case of a file (bench/stability/case_meshes.hpp)
///   {"set": FILE, "question": K, ["setting"], ["errors"]}
///                         a bench::Record for a query of a data set; with errors also those of the answer
///   {"build": FILE.lrb}   a bench::BuildTime; the method may also be one of bench::own_structures()
///   {"bodies": [A, B], ["b": POSE, "tests", "list"]}
///                         reads and builds two bodies of files; at a pose of B, the time of the query, its
///                         number of pairs, and tests and pairs on request (bench/engines/engine.hpp)

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bench/stability/case_meshes.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/stability_experiment.hpp"
#include "bench/workers/worker_json.hpp"
#include <lrbscope/error.hpp>

namespace lrb::worker_programs {

using nlohmann::json;
using nlohmann::ordered_json;

/// The words on a worker's command line.
struct Call {
  bool list = false;
  std::string method, quantity = "pairs";
};

inline std::optional<double> setting_of(const json& question) {
  return question.contains("setting") ? std::optional<double>(question.at("setting")) : std::nullopt;
}

/// Right answers from files, which are read once if their lines are requested in order.
class KnownAnswers {
 public:
  /// Returns the answer to a question, or nullopt if it names no file.
  std::optional<stability::RightAnswer> find(const json& question) {
    if (!question.contains("right")) return std::nullopt;
    const std::string file = question.at("right");
    const std::uint64_t line = question.at("line");
    if (file != file_ || line < next_) {
      in_ = std::ifstream(file);
      file_ = file;
      next_ = 0;
    }
    std::string text;
    for (; next_ <= line; ++next_) std::getline(in_, text);
    if (!in_) throw InputError(file + ": has too few lines");
    return stability::expected_from(text);
  }

 private:
  std::string file_;
  std::ifstream in_;
  std::uint64_t next_ = 0;
};

/// Answers a question about a case. right(case): the right answer. judge(family, case, right answer, record)
/// asks the method, judges its answer, and returns its pairs, if there are any.
template <class Right, class Judge>
ordered_json about_case(const json& question, const std::string& method, KnownAnswers& known,
                        const Right& right, const Judge& judge) {
  static const cases::Family kNoFamily = {"", "", nullptr};
  const cases::Family* family = &kNoFamily;
  stability::Record record;
  record.method = method;
  if (!question.contains("saved")) {
    record.family = question.at("family");
    record.difficulty = question.at("difficulty");
    record.case_index = question.at("case");
    record.seed = question.at("seed");
    family = cases::find_family(record.family);
    if (family == nullptr) throw InputError("unknown family '" + record.family + "'");
  }
  const cases::Case c = question.contains("saved")
                            ? stability::read_case(question.at("saved"))
                            : cases::make_case(*family, record.seed, record.difficulty, record.case_index);
  if (method.empty()) return stability::to_json(right(c));
  const std::optional<stability::RightAnswer> read = known.find(question);
  const std::optional<std::vector<SimplexPair>> pairs = judge(*family, c, read ? *read : right(c), record);
  ordered_json out = stability::to_json(record);
  if (question.value("pairs", false) && pairs) out["answered_pairs"] = workers::PairsJson::write(*pairs);
  return out;
}

/// Runs a worker: `list` returns the methods of a call, `answer` the answer to a question. Returns the exit
/// code. lrbscope's lines have a separate channel; libraries that print to stdout print to stderr instead.
inline int serve(int argc, char** argv,
                 const std::function<std::vector<methods::MethodInfo>(const Call&)>& list,
                 const std::function<std::function<ordered_json(const json&)>(const Call&)>& prepare) {
  constexpr int kOk = 0, kBadInput = 2;
  std::FILE* out = fdopen(dup(STDOUT_FILENO), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  const auto say = [out](const ordered_json& value) {
    const std::string line = value.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
    if (out == nullptr || std::fputs(line.c_str(), out) < 0 || std::fflush(out) != 0)
      std::_Exit(1);  // the reader has closed the channel
  };
  try {
    Call call;
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--list")
        call.list = true;
      else if (word == "--method" && i + 1 < argc)
        call.method = argv[++i];
      else if (word == "--quantity" && i + 1 < argc)
        call.quantity = argv[++i];
      else
        throw InputError("unknown option '" + word + "'; see bench/programs/serve.hpp");
    }
    if (call.list) {
      for (const methods::MethodInfo& m : list(call)) say(workers::to_json(m));
      return kOk;
    }
    const auto answer = prepare(call);
    std::ifstream questions("/proc/self/fd/3");
    for (std::string line; std::getline(questions, line);) say(answer(json::parse(line)));
    return kOk;
  } catch (const std::exception& e) {
    say({{"error", e.what()}});
    return kBadInput;
  }
}

}  // namespace lrb::worker_programs

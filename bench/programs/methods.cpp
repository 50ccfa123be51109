/// The worker: a program beside lrbscope that answers questions with methods that are not linked into
/// lrbscope and may crash or hang. It is started with
///   --list [--quantity Q]           prints its methods, a line of JSON each
///   [--method M] [--quantity Q]     answers each line of file descriptor 3, until its end, with a line on
///   stdout
/// Questions and answers are JSON objects. An answer {"error": "..."} ends the worker with exit code 2.
/// Questions:
///   {"family", "seed", "difficulty", "case"}
///                         a methods::Answer; without a method, the stability::RightAnswer
///   {"saved": FILE}       the same for the case of a file (bench/stability/case_meshes.hpp)
///   {"set": FILE, "question": K, ["setting"], ["errors"]}
///                         a speed::Record for a query of a data set; with errors also those of the answer
///   {"build": FILE.lrb}   a speed::BuildTime; the method may also be one of speed::own_structures()
///   {"bodies": [A, B], ["b": POSE, "tests", "list"]}
///                         reads and builds two bodies of files; at a pose of B, a methods::Answer with the
///                         number of pairs, and tests and pairs on request (bench/engines/engine.hpp)

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bench/methods/method.hpp"
#include "bench/quantities/truth.hpp"
#include "bench/speed/bench_runner.hpp"
#include "bench/speed/build_times.hpp"
#include "bench/stability/case_meshes.hpp"
#include "bench/stability/stability_experiment.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

using methods::Quantity;
using nlohmann::json;
using nlohmann::ordered_json;

// Methods that misbehave, to test the handling of failures. They are listed only if the environment has
// LRBSCOPE_FAKE_METHODS.

using methods::Answer;
using methods::Method;
using methods::MethodBody;

enum class Vice { crash, hang, reject, raise, miss };

std::unique_ptr<Method> (*make_honest)() = nullptr;  // set before the first is made

class Fake : public Method {
 public:
  explicit Fake(Vice vice) : vice_(vice), honest_(make_honest()) {}
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override { return honest_->build(rep); }

  Answer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
               Mode mode) override {
    Answer answer = honest_->query(a, pose_a, b, pose_b, mode);
    if (!answer.contact) return answer;
    if (vice_ == Vice::crash) std::abort();
    while (vice_ == Vice::hang) pause();
    if (vice_ == Vice::reject) throw InputError("the fake does not like contacts");
    if (vice_ == Vice::raise) throw std::logic_error("the fake is at its wits' end");
    answer.pairs.erase(answer.pairs.begin());
    return answer;
  }

 private:
  Vice vice_;
  std::unique_ptr<Method> honest_;
};

template <Vice vice>
methods::MethodEntry fake(const char* name, methods::MethodEntry entry) {
  entry.info.name = entry.info.title = name;
  entry.make = []() -> std::unique_ptr<Method> { return std::make_unique<Fake>(vice); };
  return entry;
}

/// Returns the fake methods. All answer correctly if there is no contact. Otherwise "fake-crash" aborts,
/// "fake-hang" never returns, "fake-refuse" rejects the query, "fake-throw" throws, and "fake-miss" omits the
/// first pair. "fake-absent" is absent. Returns an empty list if "ours", which they imitate, is not among the
/// program's methods.
std::vector<methods::MethodEntry> fake_methods(const std::vector<methods::MethodEntry>& methods) {
  const auto ours = std::find_if(methods.begin(), methods.end(),
                                 [](const methods::MethodEntry& e) { return e.info.name == "ours"; });
  if (ours == methods.end()) return {};
  make_honest = ours->make;
  return {fake<Vice::crash>("fake-crash", *ours),
          fake<Vice::hang>("fake-hang", *ours),
          fake<Vice::reject>("fake-refuse", *ours),
          fake<Vice::raise>("fake-throw", *ours),
          fake<Vice::miss>("fake-miss", *ours),
          methods::entry_of<class Nothing>({.name = "fake-absent", .title = "fake-absent"}, "nothing")};
}

/// The answers of one method, which keeps bodies between questions.
class Answers {
 public:
  /// `method`: empty for right answers.
  Answers(std::string method, Quantity quantity, const std::vector<methods::MethodEntry>& entries)
      : method_(std::move(method)), quantity_(quantity), entries_(entries) {}

  ordered_json operator()(const json& question) {
    if (question.contains("build")) return build(question.at("build"));
    if (question.contains("bodies")) return about_bodies(question);
    if (question.contains("set")) return about_set(question);
    if (question.contains("saved")) {
      cases_.reset();  // so that the answer does not depend on earlier cases
      return about_case(stability::read_case(question.at("saved")), false);
    }
    const cases::Family* family = cases::find_family(question.at("family"));
    if (family == nullptr)
      throw InputError("unknown family '" + question.at("family").get<std::string>() + "'");
    return about_case(
        cases::make_case(*family, question.at("seed"), question.at("difficulty"), question.at("case")),
        family->both_ways);
  }

 private:
  const methods::MethodEntry& entry(Quantity quantity) const {
    return methods::find_method(entries_, method_, quantity);
  }

  ordered_json build(const std::string& file) const {
    const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const methods::MethodEntry& e) {
      return e.info.name == method_ && e.make != nullptr;
    });
    return to_json(speed::time_build(known == entries_.end() ? nullptr : &*known, method_, file));
  }

  ordered_json about_case(const cases::Case& c, bool both_ways) {
    if (method_.empty())
      return to_json(quantity_ == Quantity::pairs ? stability::expected_answer(c)
                                                  : quantities::true_number(quantity_, c));
    if (quantity_ != Quantity::pairs) return workers::to_json(quantities::ask_number(entry(quantity_), c));
    if (!cases_) cases_.emplace(entry(Quantity::pairs));
    return workers::to_json(cases_->ask(c, both_ways));
  }

  ordered_json about_set(const json& question) {
    if (!set_) {
      set_ = speed::read_data_set(question.at("set"));
      const auto setting =
          question.contains("setting") ? std::optional<double>(question.at("setting")) : std::nullopt;
      queries_.emplace(entry(set_->quantity), setting, *set_, question.value("errors", false));
    }
    return to_json(queries_->ask(question.at("question")));
  }

  ordered_json about_bodies(const json& question) {
    if (!method_of_bodies_) {
      const auto loaded = bodies::load_faces_of_two(question.at("bodies").at(0), question.at("bodies").at(1));
      method_of_bodies_ = entry(Quantity::pairs).make();
      for (std::size_t i = 0; i < 2; ++i) bodies_[i] = method_of_bodies_->build(loaded[i].rep);
    }
    if (!question.contains("b")) return ordered_json::object();
    const Pose pose = io::pose_of(question.at("b").get<std::array<double, 12>>());
    methods::Answer answer;
    workers::note_failures(answer, [&] {
      answer = method_of_bodies_->query(*bodies_[0], Pose{}, *bodies_[1], pose, Mode::all_pairs);
      answer.count = answer.pairs.size();
      if (!question.value("list", false)) answer.pairs.clear();
      if (!question.value("tests", false)) return;
      answer.kinds = method_of_bodies_->count_tests(*bodies_[0], Pose{}, *bodies_[1], pose);
      if (answer.kinds) answer.tests = answer.kinds->boxes + answer.kinds->faces;
    });
    return workers::to_json(answer);
  }

  std::string method_;
  Quantity quantity_;
  const std::vector<methods::MethodEntry>& entries_;
  std::optional<stability::StabilityRunner> cases_;
  std::optional<speed::DataSet> set_;
  std::optional<speed::BenchRunner> queries_;
  std::unique_ptr<Method> method_of_bodies_;
  std::array<std::unique_ptr<MethodBody>, 2> bodies_;
};

/// Returns the exit code.
int run_worker(int argc, char** argv) {
  constexpr int kOk = 0, kBadInput = 2;
  // Lines have a separate channel; libraries that print to stdout print to stderr instead.
  std::FILE* out = fdopen(dup(STDOUT_FILENO), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  const auto write_line = [out](const ordered_json& value) {
    if (out == nullptr || std::fputs(workers::line_of(value).c_str(), out) < 0 || std::fflush(out) != 0)
      std::_Exit(1);  // the reader has closed the channel
  };
  try {
    std::vector<methods::MethodEntry> entries = methods::registered_methods();
    if (std::getenv("LRBSCOPE_FAKE_METHODS") != nullptr)
      for (methods::MethodEntry& fake : fake_methods(entries)) entries.push_back(std::move(fake));
    bool list = false;
    std::string method, quantity = "pairs";
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--list")
        list = true;
      else if (word == "--method" && i + 1 < argc)
        method = argv[++i];
      else if (word == "--quantity" && i + 1 < argc)
        quantity = argv[++i];
      else
        throw InputError("unknown option '" + word + "'; see bench/programs/methods.cpp");
    }
    const auto requested = from_name<Quantity>(quantity);
    if (!requested) throw InputError("unknown quantity '" + quantity + "'");
    if (list) {
      for (const methods::MethodEntry& e : entries)
        if (e.info.quantity == *requested) write_line(workers::to_json(e.info));
      return kOk;
    }
    Answers answers(method, *requested, entries);
    std::ifstream questions("/proc/self/fd/3");
    for (std::string line; std::getline(questions, line);) write_line(answers(json::parse(line)));
    return kOk;
  } catch (const std::exception& e) {
    write_line({{"error", e.what()}});
    return kBadInput;
  }
}

}  // namespace
}  // namespace lrb

// The main() of every worker program; programs differ in the linked methods (bench/methods/methods.cmake).
int main(int argc, char** argv) {
  return lrb::run_worker(argc, argv);
}

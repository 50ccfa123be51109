/// The worker: a program beside lrbscope that runs cases with methods that are not linked into lrbscope and
/// may crash or hang.
///
/// It writes its output as JSON lines to stdout:
///   --list                its methods
///   --family F --seed S --cases N --begin K --end L
///                         the correct answers (RightAnswer) to cases K .. L - 1; case k is number k % N at
///                         difficulty k / N
///   ... --method M [--expected FILE] [--pairs]
///                         a record for each; the correct answers are read from the file (one line per
///                         case, from case 0 on) or computed; with --pairs also the lists of pairs
///   --questions FILE --method M [--setting X] [--errors] --begin K --end L
///                         a bench::Record for each of a data set's queries K .. L - 1; with --errors also
///                         the errors of its answers
///   --build FILE.lrb --method M
///                         a bench::BuildTime for each of the rounds K .. L - 1; M may also be one of
///                         bench::own_structures()
///   --saved --method M    a record, with the list of pairs, for each case whose file is named by a line of
///   file
///                         descriptor 3, until its end (bench/stability/case_meshes.hpp)
///   --bodies A B --method M [--no-join]
///                         a reply for each request in file descriptor 3, until its end
///                         (bench/tails/engine.hpp)
/// Exit codes: 0, or 2 with the line {"error": "..."}.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "bench/methods/method.hpp"
#include "bench/programs/case_queue.hpp"
#include "bench/speed/bench_runner.hpp"
#include "bench/speed/build_times.hpp"
#include "bench/stability/case_meshes.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/stability_experiment.hpp"
#include "bench/tails/engine.hpp"
#include "bench/workers/worker_json.hpp"
#include <lrbscope/error.hpp>

namespace lrb::worker_programs {
namespace {

using nlohmann::ordered_json;

// Methods that misbehave, to test the handling of failures. They are listed only if the environment has
// LRBSCOPE_FAKE_METHODS.

using methods::Method;
using methods::MethodAnswer;
using methods::MethodBody;

enum class Vice { crash, hang, reject, raise, miss };

std::unique_ptr<Method> (*make_honest)() = nullptr;  // set before the first is made

class Fake : public Method {
 public:
  explicit Fake(Vice vice) : vice_(vice), honest_(make_honest()) {}
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override { return honest_->build(rep); }

  MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                     Mode mode) override {
    MethodAnswer answer = honest_->query(a, pose_a, b, pose_b, mode);
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
  return {fake<Vice::crash>("fake-crash", *ours),   fake<Vice::hang>("fake-hang", *ours),
          fake<Vice::reject>("fake-refuse", *ours), fake<Vice::raise>("fake-throw", *ours),
          fake<Vice::miss>("fake-miss", *ours),     methods::absent("fake-absent", "fake-absent", "nothing")};
}

struct WorkerOptions {
  CaseQueue queue;
  bool pairs = false, errors = false;
  std::string questions, build;
  std::optional<double> setting;
  std::vector<std::string> bodies;
  bool no_join = false, saved = false;
};

void list_methods(const std::vector<methods::MethodEntry>& entries, Lines& out) {
  for (const methods::MethodEntry& e : entries) out.say(dump(workers::to_json(e.info)));
}

void say_expected(const CaseQueue& queue, Lines& out) {
  const cases::Family& family = family_of(queue);
  for (std::uint64_t k = queue.begin; k < queue.end; ++k)
    out.say(stability::to_line(stability::expected_answer(make(family, queue, k))));
}

void say_records(const WorkerOptions& o, const methods::MethodEntry& entry, Lines& out) {
  const cases::Family& family = family_of(o.queue);
  stability::StabilityRunner runner(entry);
  KnownAnswers known(o.queue);
  for (std::uint64_t k = o.queue.begin; k < o.queue.end; ++k) {
    const cases::Case c = make(family, o.queue, k);
    const std::optional<stability::RightAnswer> read = known.next();
    stability::Record record = record_of(o.queue, k);
    runner.ask(family, c, read ? *read : stability::expected_answer(c), record);
    ordered_json value = stability::to_json(record);
    if (o.pairs && runner.pairs()) value["answered_pairs"] = workers::PairsJson::write(*runner.pairs());
    out.say(dump(value));
  }
}

void work(const WorkerOptions& o, const std::vector<methods::MethodEntry>& entries, Lines& out) {
  if (o.queue.list) return list_methods(entries, out);
  if (o.queue.method.empty()) return say_expected(o.queue, out);
  if (!o.build.empty()) {
    const auto known = std::find_if(entries.begin(), entries.end(), [&](const methods::MethodEntry& e) {
      return e.info.name == o.queue.method;
    });
    const methods::MethodEntry* entry = known == entries.end() ? nullptr : &*known;
    for (std::uint64_t k = o.queue.begin; k < o.queue.end; ++k)
      out.say(dump(to_json(bench::time_build(entry, o.queue.method, o.build))));
    return;
  }
  const methods::MethodEntry& entry = methods::find_method(entries, o.queue.method);
  if (o.saved) {
    std::ifstream requests("/proc/self/fd/3");
    return stability::serve_cases(entry, requests, [&](const std::string& line) { out.say(line); });
  }
  if (!o.bodies.empty()) {
    std::ifstream requests("/proc/self/fd/3");
    return tails::serve(
        entry, {o.bodies[0], o.bodies[1], o.no_join ? bodies::Corners::apart : bodies::Corners::joined},
        requests, [&](const std::string& line) { out.say(line); });
  }
  if (o.questions.empty()) return say_records(o, entry, out);
  const bench::DataSet set = bench::read_data_set(o.questions);
  bench::BenchRunner runner(entry, o.setting, set, o.errors);
  for (std::uint64_t k = o.queue.begin; k < o.queue.end; ++k) out.say(dump(to_json(runner.ask(k))));
}

int worker_main(int argc, char** argv, std::vector<methods::MethodEntry> entries) {
  if (std::getenv("LRBSCOPE_FAKE_METHODS") != nullptr)
    for (methods::MethodEntry& fake : fake_methods(entries)) entries.push_back(std::move(fake));
  WorkerOptions o;
  CLI::App app("Runs cases on collision engines, for lrbscope stability; see bench/programs/methods.cpp.");
  add_options(app, o.queue);
  app.add_flag("--pairs", o.pairs);
  app.add_flag("--errors", o.errors);
  app.add_option("--questions", o.questions);
  app.add_option("--build", o.build);
  app.add_option("--setting", o.setting);
  app.add_option("--bodies", o.bodies)->expected(2);
  app.add_flag("--no-join", o.no_join);
  app.add_flag("--saved", o.saved);
  CLI11_PARSE(app, argc, argv);
  return run_worker([&](Lines& out) { work(o, entries, out); });
}

}  // namespace
}  // namespace lrb::worker_programs

// The main() of every worker program; programs differ in the linked methods (bench/methods/methods.cmake).

int main(int argc, char** argv) {
  return lrb::worker_programs::worker_main(argc, argv, lrb::methods::registered_methods());
}

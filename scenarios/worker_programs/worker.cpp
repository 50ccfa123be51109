#include "scenarios/worker_programs/worker.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

#include "engine/core/error.hpp"
#include "scenarios/bench/bench_runner.hpp"
#include "scenarios/stability/record_json.hpp"
#include "scenarios/stability/stability_runner.hpp"
#include "scenarios/worker_programs/fake_methods.hpp"
#include "scenarios/worker_programs/lines.hpp"
#include "scenarios/workers/method_json.hpp"
#include "scenarios/workers/pairs_json.hpp"

namespace lrb::worker_programs {
namespace {

using nlohmann::ordered_json;

struct WorkerOptions {
  bool list = false, pairs = false;
  std::string family, method, expected, questions;
  std::optional<double> setting;
  std::uint64_t seed = 1, cases = 1, begin = 0, end = 0;
};

void list_methods(const std::vector<methods::MethodEntry>& entries, Lines& out) {
  for (const methods::MethodEntry& e : entries) out.say(dump(workers::to_json(e.info)));
}

const cases::Family& family_of(const WorkerOptions& o) {
  const cases::Family* family = cases::find_family(o.family);
  if (family == nullptr) throw InputError("there is no family '" + o.family + "'");
  return *family;
}

cases::Case make(const cases::Family& family, const WorkerOptions& o, std::uint64_t k) {
  return cases::make_case(family, o.seed, static_cast<int>(k / o.cases), k % o.cases);
}

void say_expected(const WorkerOptions& o, Lines& out) {
  const cases::Family& family = family_of(o);
  for (std::uint64_t k = o.begin; k < o.end; ++k)
    out.say(stability::to_line(stability::expected_answer(make(family, o, k))));
}

/// Opens the file of right answers and skips to the line of case `begin`.
std::ifstream open_expected(const WorkerOptions& o) {
  std::ifstream in(o.expected);
  std::string line;
  for (std::uint64_t k = 0; k < o.begin; ++k) std::getline(in, line);
  if (!in) throw InputError(o.expected + ": has too few lines");
  return in;
}

void say_records(const WorkerOptions& o, const methods::MethodEntry& entry, Lines& out) {
  const cases::Family& family = family_of(o);
  stability::StabilityRunner runner(entry);
  std::ifstream known;
  if (!o.expected.empty()) known = open_expected(o);
  for (std::uint64_t k = o.begin; k < o.end; ++k) {
    const cases::Case c = make(family, o, k);
    std::string line;
    const bool read = !o.expected.empty() && std::getline(known, line);
    const stability::Expected expected =
        read ? stability::expected_from(line) : stability::expected_answer(c);
    stability::Record record;
    record.family = o.family;
    record.method = o.method;
    record.dial = static_cast<int>(k / o.cases);
    record.case_index = k % o.cases;
    record.seed = o.seed;
    runner.ask(family, c, expected, record);
    ordered_json value = stability::to_json(record);
    if (o.pairs && runner.pairs()) value["answered_pairs"] = workers::PairsJson::write(*runner.pairs());
    out.say(dump(value));
  }
}

void work(const WorkerOptions& o, const std::vector<methods::MethodEntry>& entries, Lines& out) {
  if (o.list) return list_methods(entries, out);
  if (o.method.empty()) return say_expected(o, out);
  const methods::MethodEntry& entry = methods::find_method(entries, o.method);
  if (o.questions.empty()) return say_records(o, entry, out);
  const bench::DataSet set = bench::read_data_set(o.questions);
  bench::BenchRunner runner(entry, o.setting, set, o.pairs);
  for (std::uint64_t k = o.begin; k < o.end; ++k) out.say(dump(to_json(runner.ask(k))));
}

}  // namespace

int worker_main(int argc, char** argv, std::vector<methods::MethodEntry> entries) {
  static constexpr int kOk = 0, kBadInput = 2;
  if (std::getenv("LRBSCOPE_FAKE_METHODS") != nullptr)
    for (methods::MethodEntry& fake : fake_methods(entries)) entries.push_back(std::move(fake));
  WorkerOptions o;
  CLI::App app(
      "Puts cases to collision engines, for lrbscope stability; see scenarios/worker_programs/worker.hpp.");
  app.add_flag("--list", o.list);
  app.add_option("--family", o.family);
  app.add_option("--method", o.method);
  app.add_option("--seed", o.seed);
  app.add_option("--cases", o.cases)->check(CLI::PositiveNumber);
  app.add_option("--begin", o.begin);
  app.add_option("--end", o.end);
  app.add_option("--expected", o.expected);
  app.add_flag("--pairs", o.pairs);
  app.add_option("--questions", o.questions);
  app.add_option("--setting", o.setting);
  CLI11_PARSE(app, argc, argv);
  Lines out;
  try {
    work(o, entries, out);
    return kOk;
  } catch (const std::exception& e) {
    out.say(dump({{"error", e.what()}}));
    return kBadInput;
  }
}

}  // namespace lrb::worker_programs

#include "bench/programs/asked_cases.hpp"

#include <lrbscope/error.hpp>

namespace lrb::worker_programs {

void add_options(CLI::App& app, AskedCases& asked) {
  app.add_flag("--list", asked.list);
  app.add_option("--family", asked.family);
  app.add_option("--method", asked.method);
  app.add_option("--seed", asked.seed);
  app.add_option("--cases", asked.cases)->check(CLI::PositiveNumber);
  app.add_option("--begin", asked.begin);
  app.add_option("--end", asked.end);
  app.add_option("--expected", asked.expected);
}

const cases::Family& family_of(const AskedCases& asked) {
  const cases::Family* family = cases::find_family(asked.family);
  if (family == nullptr) throw InputError("there is no family '" + asked.family + "'");
  return *family;
}

cases::Case make(const cases::Family& family, const AskedCases& asked, std::uint64_t number) {
  return cases::make_case(family, asked.seed, static_cast<int>(number / asked.cases), number % asked.cases);
}

stability::Record record_of(const AskedCases& asked, std::uint64_t number) {
  stability::Record record;
  record.family = asked.family;
  record.method = asked.method;
  record.dial = static_cast<int>(number / asked.cases);
  record.case_index = number % asked.cases;
  record.seed = asked.seed;
  return record;
}

KnownAnswers::KnownAnswers(const AskedCases& asked) {
  if (asked.expected.empty()) return;
  in_.open(asked.expected);
  std::string line;
  for (std::uint64_t k = 0; k < asked.begin; ++k) std::getline(in_, line);
  if (!in_) throw InputError(asked.expected + ": has too few lines");
}

std::optional<stability::RightAnswer> KnownAnswers::next() {
  std::string line;
  if (!in_.is_open() || !std::getline(in_, line)) return std::nullopt;
  return stability::expected_from(line);
}

}  // namespace lrb::worker_programs

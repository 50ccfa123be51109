#include "bench/programs/asked_cases.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include <unistd.h>

#include <lrbscope/error.hpp>

namespace lrb::worker_programs {

void add_options(CLI::App& app, CaseQueue& asked) {
  app.add_flag("--list", asked.list);
  app.add_option("--family", asked.family);
  app.add_option("--method", asked.method);
  app.add_option("--seed", asked.seed);
  app.add_option("--cases", asked.cases)->check(CLI::PositiveNumber);
  app.add_option("--begin", asked.begin);
  app.add_option("--end", asked.end);
  app.add_option("--expected", asked.expected);
}

const cases::Family& family_of(const CaseQueue& asked) {
  const cases::Family* family = cases::find_family(asked.family);
  if (family == nullptr) throw InputError("unknown family '" + asked.family + "'");
  return *family;
}

cases::Case make(const cases::Family& family, const CaseQueue& asked, std::uint64_t number) {
  return cases::make_case(family, asked.seed, static_cast<int>(number / asked.cases), number % asked.cases);
}

stability::Record record_of(const CaseQueue& asked, std::uint64_t number) {
  stability::Record record;
  record.family = asked.family;
  record.method = asked.method;
  record.difficulty = static_cast<int>(number / asked.cases);
  record.case_index = number % asked.cases;
  record.seed = asked.seed;
  return record;
}

KnownAnswers::KnownAnswers(const CaseQueue& asked) {
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

namespace {

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

}  // namespace

std::vector<methods::MethodEntry> fake_methods(const std::vector<methods::MethodEntry>& methods) {
  const auto ours = std::find_if(methods.begin(), methods.end(),
                                 [](const methods::MethodEntry& e) { return e.info.name == "ours"; });
  if (ours == methods.end()) return {};
  make_honest = ours->make;
  return {fake<Vice::crash>("fake-crash", *ours),   fake<Vice::hang>("fake-hang", *ours),
          fake<Vice::reject>("fake-refuse", *ours), fake<Vice::raise>("fake-throw", *ours),
          fake<Vice::miss>("fake-miss", *ours),     methods::absent("fake-absent", "fake-absent", "nothing")};
}

}  // namespace lrb::worker_programs

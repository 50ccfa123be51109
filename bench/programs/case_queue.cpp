#include "bench/programs/case_queue.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include <unistd.h>

#include <lrbscope/error.hpp>

namespace lrb::worker_programs {

void add_options(CLI::App& app, CaseQueue& queue) {
  app.add_flag("--list", queue.list);
  app.add_option("--family", queue.family);
  app.add_option("--method", queue.method);
  app.add_option("--seed", queue.seed);
  app.add_option("--cases", queue.cases)->check(CLI::PositiveNumber);
  app.add_option("--begin", queue.begin);
  app.add_option("--end", queue.end);
  app.add_option("--expected", queue.expected);
}

const cases::Family& family_of(const CaseQueue& queue) {
  const cases::Family* family = cases::find_family(queue.family);
  if (family == nullptr) throw InputError("unknown family '" + queue.family + "'");
  return *family;
}

cases::Case make(const cases::Family& family, const CaseQueue& queue, std::uint64_t number) {
  return cases::make_case(family, queue.seed, static_cast<int>(number / queue.cases), number % queue.cases);
}

stability::Record record_of(const CaseQueue& queue, std::uint64_t number) {
  stability::Record record;
  record.family = queue.family;
  record.method = queue.method;
  record.difficulty = static_cast<int>(number / queue.cases);
  record.case_index = number % queue.cases;
  record.seed = queue.seed;
  return record;
}

KnownAnswers::KnownAnswers(const CaseQueue& queue) {
  if (queue.expected.empty()) return;
  in_.open(queue.expected);
  std::string line;
  for (std::uint64_t k = 0; k < queue.begin; ++k) std::getline(in_, line);
  if (!in_) throw InputError(queue.expected + ": has too few lines");
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

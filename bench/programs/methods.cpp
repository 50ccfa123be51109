/// The worker: a program beside lrbscope that answers questions (serve.hpp) with methods that are not linked
/// into lrbscope and may crash or hang.

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <vector>

#include <unistd.h>

#include "bench/methods/method.hpp"
#include "bench/programs/serve.hpp"
#include "bench/speed/bench_runner.hpp"
#include "bench/speed/build_times.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/stability_experiment.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/error.hpp>

namespace lrb::worker_programs {
namespace {

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
  Answers(std::string method, const std::vector<methods::MethodEntry>& entries)
      : method_(std::move(method)), entries_(entries) {}

  ordered_json operator()(const json& question) {
    if (question.contains("build")) return build(question.at("build"));
    if (question.contains("bodies")) return about_bodies(question);
    if (question.contains("set")) return about_set(question);
    return about_case(question, method_, known_, stability::expected_answer,
                      [&](const cases::Family& family, const cases::Case& c,
                          const stability::RightAnswer& right, stability::Record& record) {
                        // A saved case has a new runner, so that its answer does not depend on earlier cases.
                        if (!cases_ || question.contains("saved")) cases_.emplace(entry());
                        cases_->ask(family, c, right, record);
                        return cases_->pairs();
                      });
  }

 private:
  const methods::MethodEntry& entry() const { return methods::find_method(entries_, method_); }

  ordered_json build(const std::string& file) const {
    const auto known = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const methods::MethodEntry& e) { return e.info.name == method_; });
    return to_json(bench::time_build(known == entries_.end() ? nullptr : &*known, method_, file));
  }

  ordered_json about_set(const json& question) {
    if (!set_) {
      set_ = bench::read_data_set(question.at("set"));
      queries_.emplace(entry(), setting_of(question), *set_, question.value("errors", false));
    }
    return to_json(queries_->ask(question.at("question")));
  }

  ordered_json about_bodies(const json& question) {
    if (!method_of_bodies_) {
      const auto loaded = bodies::load_faces_of_two(question.at("bodies").at(0), question.at("bodies").at(1));
      method_of_bodies_ = entry().make();
      for (std::size_t i = 0; i < 2; ++i) bodies_[i] = method_of_bodies_->build(loaded[i].rep);
    }
    if (!question.contains("b")) return ordered_json::object();
    const Pose pose = io::pose_of(question.at("b").get<std::array<double, 12>>());
    try {
      const MethodAnswer found =
          method_of_bodies_->query(*bodies_[0], Pose{}, *bodies_[1], pose, Mode::all_pairs);
      ordered_json out = {{"us", found.microseconds}, {"pairs", found.pairs.size()}};
      if (question.value("tests", false))
        if (const auto tests = method_of_bodies_->count_tests(*bodies_[0], Pose{}, *bodies_[1], pose)) {
          out["boxes"] = tests->boxes;
          out["faces"] = tests->faces;
        }
      if (question.value("list", false)) out["list"] = workers::PairsJson::write(found.pairs);
      return out;
    } catch (const std::exception& e) {
      return {{"failure", e.what()}};
    }
  }

  std::string method_;
  const std::vector<methods::MethodEntry>& entries_;
  KnownAnswers known_;
  std::optional<stability::StabilityRunner> cases_;
  std::optional<bench::DataSet> set_;
  std::optional<bench::BenchRunner> queries_;
  std::unique_ptr<Method> method_of_bodies_;
  std::array<std::unique_ptr<MethodBody>, 2> bodies_;
};

}  // namespace
}  // namespace lrb::worker_programs

// The main() of every worker program; programs differ in the linked methods (bench/methods/methods.cmake).

int main(int argc, char** argv) {
  using namespace lrb;
  using namespace lrb::worker_programs;
  std::vector<methods::MethodEntry> entries = methods::registered_methods();
  if (std::getenv("LRBSCOPE_FAKE_METHODS") != nullptr)
    for (methods::MethodEntry& fake : fake_methods(entries)) entries.push_back(std::move(fake));
  return serve(
      argc, argv,
      [&](const Call&) {
        std::vector<methods::MethodInfo> out;
        for (const methods::MethodEntry& e : entries) out.push_back(e.info);
        return out;
      },
      [&](const Call& call) {
        const auto answers = std::make_shared<Answers>(call.method, entries);
        return [answers](const json& question) { return (*answers)(question); };
      });
}

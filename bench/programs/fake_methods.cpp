#include "bench/programs/fake_methods.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include <unistd.h>

#include <lrbscope/error.hpp>

namespace lrb::worker_programs {
namespace {

using methods::Method;
using methods::MethodAnswer;
using methods::MethodBody;

enum class Vice { crash, hang, refuse, raise, miss };

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
    if (vice_ == Vice::refuse) throw InputError("the fake does not like contacts");
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
          fake<Vice::refuse>("fake-refuse", *ours), fake<Vice::raise>("fake-throw", *ours),
          fake<Vice::miss>("fake-miss", *ours),     methods::absent("fake-absent", "fake-absent", "nothing")};
}

}  // namespace lrb::worker_programs

#include "tests/bench/sweep_methods.hpp"

#include "engine/collide/collide_into.hpp"
#include "engine/motion/contact_search.hpp"
#include "tests/bench/timing.hpp"

namespace lrb::bench {
namespace {

SweepMethod ours(const std::string& name, double tolerance) {
  const auto make = [tolerance](const SweptFamily& family) -> SweepAsker {
    auto context = std::make_shared<FirstContactContext>();
    FirstContactRequest request;
    request.tolerance = tolerance;
    request.relation = false;
    return [&family, context, request](const SweptMotion& m) {
      const auto start = std::chrono::steady_clock::now();
      const FirstContactResult r =
          first_contact(family.a, Motion::still({}), family.b, m.motion, request, *context);
      return SweepAnswer{r.is_contact(), r.outcome == MotionOutcome::undecided, r.t0, r.t1,
                         1e6 * seconds_since(start)};
    };
  };
  return {name, false, make};
}

/// Asks the exact query at n equal times, until it finds a contact.
SweepMethod sampled(int n) {
  const auto make = [n](const SweptFamily& family) -> SweepAsker {
    auto context = std::make_shared<QueryContext>();
    return [&family, context, n](const SweptMotion& m) {
      CollideRequest any;
      any.mode = Mode::any_pair;
      NullProbe probe;
      SweepAnswer answer;
      const auto start = std::chrono::steady_clock::now();
      for (int i = 0; i < n && !answer.contact; ++i) {
        answer.t = answer.t0 = static_cast<double>(i) / (n - 1);
        answer.contact =
            !collide(family.a, Pose{}, family.b, m.motion.at(answer.t), any, *context, probe).pairs.empty();
      }
      answer.microseconds = 1e6 * seconds_since(start);
      return answer;
    };
  };
  return {"sampled, " + std::to_string(n), false, make};
}

}  // namespace

std::vector<SweepMethod> own_sweep_methods() {
  return {ours("first_contact", 1e-9), ours("first_contact, 1e-4", 1e-4), sampled(10), sampled(100),
          sampled(1000)};
}

}  // namespace lrb::bench

#include "scenarios/stability/stability_runner.hpp"

#include "engine/core/error.hpp"
#include "scenarios/methods/body_parts.hpp"
#include "scenarios/stability/judge.hpp"
#include "scenarios/workers/note_failures.hpp"

namespace lrb::stability {

StabilityRunner::Posed StabilityRunner::place(const LrbRep& rep, const Pose& pose, int side) {
  if (!info_.moves_exactly) return {method_->build(methods::at_pose(rep, pose)), Pose{}};
  static constexpr std::size_t kMostKept = 200;
  if (kept_.size() > kMostKept) kept_.clear();
  BodyPointer& body = kept_[{rep.hash(), side}];
  if (!body) body = method_->build(rep);
  return {body, pose};
}

void StabilityRunner::ask(const cases::Family& family, const cases::Case& c, const RightAnswer& expected,
                          Record& record) {
  pairs_.reset();
  const Mode mode = info_.pairs ? Mode::all_pairs : Mode::first_pair;
  record.expected = expected.pairs.size();
  workers::note_failures(record, [&] {
    if (c.a->dim() == 2 && !info_.plane)
      throw InputError("a 2D body: not asked, because it answers for 3D bodies only");
    if (!expected.refusal.empty() && !info_.moves_exactly) throw InputError(expected.refusal + ": not asked");
    const Posed a = place(*c.a, c.pose_a, 0), b = place(*c.b, c.pose_b, 1);
    methods::MethodAnswer answer = method_->query(*a.body, a.pose, *b.body, b.pose, mode);
    record.microseconds = answer.microseconds;
    if (family.both_ways) {
      const bool several = c.a->component_vertices().size() > 1 && c.b->component_vertices().size() > 1;
      judge_swapped(record, info_, answer, method_->query(*b.body, b.pose, *a.body, a.pose, mode), several);
    } else {
      judge(record, info_, answer, expected);
    }
    if (info_.pairs) pairs_ = std::move(answer.pairs);
  });
}

}  // namespace lrb::stability

#include "scenarios/worker_programs/number_questions.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "scenarios/bench/timed_query.hpp"
#include "scenarios/methods/body_parts.hpp"
#include "scenarios/workers/note_failures.hpp"

namespace lrb::worker_programs {
namespace {

using bench::DataSet, bench::Question;
using stability::Asked, stability::NumberAnswer, stability::NumberMethod;

const Question& question_of(const DataSet& set, std::uint64_t k) {
  if (k >= set.questions.size())
    throw InputError("question " + std::to_string(k) + ": the data set has only " +
                     std::to_string(set.questions.size()));
  return set.questions[k];
}

Asked asked_of(const DataSet& set, const Question& q) {
  const auto placed = [&](std::size_t body, const Pose& pose) {
    return methods::at_pose(load_lrb(set.folder + "/" + set.bodies.at(body).file), pose);
  };
  return {placed(q.a, q.pose_a), placed(q.b, q.pose_b), q.from, q.to, set.diagonal};
}

bool says_contact(methods::Quantity quantity, const NumberAnswer& answer) {
  if (quantity == methods::Quantity::first_contact) return answer.lower < stability::kNever;
  return quantity == methods::Quantity::depth ? answer.upper > 0 : answer.upper <= 0;
}

}  // namespace

bench::Record bench_record(const NumberMethod& method, std::optional<double> setting, const DataSet& set,
                           std::uint64_t question) {
  const Question& q = question_of(set, question);
  bench::Record r;
  r.set = set.name;
  r.method = method.info.name;
  r.setting = setting;
  r.question = question;
  r.pose_class = q.pose_class;
  workers::note_failures(r, [&] {
    const Asked asked = asked_of(set, q);
    bench::QueryTimes times;
    const NumberAnswer answer = bench::ask_again_and_again([&] { return method.ask(asked, setting); }, times);
    r.all.cold_us = times.cold_us;
    r.all.hot_us = times.hot_us;
    r.all.lower = answer.lower;
    r.all.upper = answer.upper;
    r.all.contact = says_contact(method.quantity, answer);
    if (method.proves) r.all.error_bound = answer.upper - answer.lower;
  });
  return r;
}

nlohmann::ordered_json known_number(const NumberMethod& method, const DataSet& set, std::uint64_t question) {
  const std::vector<double>& settings = method.info.settings;
  const Question& q = question_of(set, question);
  try {
    const NumberAnswer answer = method.ask(
        asked_of(set, q), settings.empty() ? std::nullopt : std::optional<double>(settings.back()));
    return {{"least", answer.lower}, {"most", answer.upper}};
  } catch (const InputError& e) {
    return {{"refusal", e.what()}};
  }
}

}  // namespace lrb::worker_programs

/// lrbscope-quantities: a worker (serve.hpp) for methods that return a number or another list than that of
/// intersecting pairs. Without a method, the answer to a query of a data set is lrbscope's at its finest
/// setting.

#include <optional>

#include "bench/methods/triangles.hpp"
#include "bench/programs/serve.hpp"
#include "bench/quantities/number_method.hpp"
#include "bench/speed/bench_runner.hpp"
#include "bench/speed/data_set.hpp"
#include "bench/speed/metrics.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/workers/worker_json.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::worker_programs {
namespace {

using bench::DataSet, bench::Question;
using stability::NumberQuery, stability::NumberAnswer, stability::NumberMethod;

NumberQuery query_of(const DataSet& set, const Question& q) {
  const auto placed = [&](std::size_t body, const Pose& pose) {
    return methods::at_pose(load_lrb(set.folder + "/" + set.bodies.at(body).file), pose);
  };
  return {placed(q.a, q.pose_a),
          placed(q.b, q.pose_b),
          q.from,
          q.to,
          set.diagonal,
          bench::within_of(q.pose_class) * set.diagonal};
}

bool says_contact(methods::Quantity quantity, const NumberAnswer& answer) {
  if (methods::is_list(quantity)) return !answer.pairs.empty();
  if (quantity == methods::Quantity::first_contact) return answer.lower < stability::kNever;
  return quantity == methods::Quantity::depth ? answer.upper > 0 : answer.upper <= 0;
}

/// Runs a query with a method at a parameter value. A rejection is a valid outcome. Throws InputError if the
/// query does not exist.
bench::Record bench_record(const NumberMethod& method, std::optional<double> setting, const DataSet& set,
                           std::uint64_t question, bool judges) {
  bench::Record r = bench::blank_record(set, question, method.info.name, setting);
  const Question& q = set.questions[question];
  workers::note_failures(r, [&] {
    const NumberQuery query = query_of(set, q);
    bench::QueryTimes times;
    const NumberAnswer answer = bench::ask_again_and_again([&] { return method.ask(query, setting); }, times);
    r.all.cold_us = times.cold_us;
    r.all.hot_us = times.hot_us;
    if (methods::is_list(method.quantity)) {
      r.all.count = answer.pairs.size();
      if (judges) r.errors = bench::errors_of_near(set, q, query.a, query.b, answer.pairs, answer.distances);
    } else {
      r.all.lower = answer.lower;
      r.all.upper = answer.upper;
    }
    r.all.contact = says_contact(method.quantity, answer);
    if (method.proves) r.all.error_bound = answer.upper - answer.lower;
  });
  return r;
}

/// Returns a method's answer at its finest setting, as {"least": .., "most": ..}, or {"refusal": "why"}.
nlohmann::ordered_json known_number(const NumberMethod& method, const DataSet& set, std::uint64_t question) {
  const std::vector<double>& settings = method.info.settings;
  try {
    const NumberAnswer answer =
        method.ask(query_of(set, set.questions.at(question)),
                   settings.empty() ? std::nullopt : std::optional<double>(settings.back()));
    return {{"least", answer.lower}, {"most", answer.upper}};
  } catch (const InputError& e) {
    return {{"refusal", e.what()}};
  }
}

using stability::Quantity;

Quantity quantity_of(const Call& call) {
  const auto q = from_name<Quantity>(call.quantity);
  if (!q || *q == Quantity::pairs) throw InputError("unknown quantity '" + call.quantity + "'");
  return *q;
}

NumberMethod method_of(Quantity quantity, const std::string& name) {
  for (NumberMethod& m : stability::number_methods())
    if (m.quantity == quantity && m.info.name == name) return m;
  throw InputError("unknown method '" + name + "' for this quantity");
}

ordered_json about_number(const Call& call, const json& question, KnownAnswers& known) {
  const Quantity quantity = quantity_of(call);
  return about_case(
      question, call.method, known, [&](const cases::Case& c) { return stability::true_number(quantity, c); },
      [&](const cases::Family&, const cases::Case& c, const stability::RightAnswer& right,
          stability::Record& record) {
        auto answer = ask_number(method_of(quantity, call.method), c, right, record);
        return answer && methods::is_list(quantity) ? std::optional(std::move(answer->pairs)) : std::nullopt;
      });
}

ordered_json about_set(const Call& call, const json& question, const DataSet& set) {
  const bool finds = call.method.empty();
  const NumberMethod method = method_of(set.quantity, finds ? "ours" : call.method);
  if (finds) return known_number(method, set, question.at("question"));
  return to_json(bench_record(method, setting_of(question), set, question.at("question"),
                              question.value("errors", false)));
}

}  // namespace
}  // namespace lrb::worker_programs

int main(int argc, char** argv) {
  using namespace lrb;
  using namespace lrb::worker_programs;
  KnownAnswers known;
  std::optional<DataSet> set;
  return serve(
      argc, argv,
      [](const Call& call) {
        std::vector<methods::MethodInfo> out;
        for (const NumberMethod& m : stability::number_methods())
          if (m.quantity == quantity_of(call)) out.push_back(m.info);
        return out;
      },
      [&](const Call& call) {
        return [&known, &set, call](const json& question) {
          if (!question.contains("set")) return about_number(call, question, known);
          if (!set) set = bench::read_data_set(question.at("set"));
          return about_set(call, question, *set);
        };
      });
}

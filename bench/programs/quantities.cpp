/// lrbscope-quantities: a worker like methods.cpp, for methods that return a number or another list than that
/// of intersecting pairs. --quantity Q or the data set of --questions selects the quantity. Without --method
/// it prints the correct answers.

#include <algorithm>
#include <optional>

#include "bench/methods/triangles.hpp"
#include "bench/programs/case_queue.hpp"
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

const Question& question_of(const DataSet& set, std::uint64_t k) {
  if (k >= set.questions.size())
    throw InputError("question " + std::to_string(k) + ": the data set has only " +
                     std::to_string(set.questions.size()));
  return set.questions[k];
}

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
  const Question& q = question_of(set, question);
  bench::Record r;
  r.set = set.name;
  r.method = method.info.name;
  r.setting = setting;
  r.question = question;
  r.pose_class = q.pose_class;
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
  const Question& q = question_of(set, question);
  try {
    const NumberAnswer answer = method.ask(
        query_of(set, q), settings.empty() ? std::nullopt : std::optional<double>(settings.back()));
    return {{"least", answer.lower}, {"most", answer.upper}};
  } catch (const InputError& e) {
    return {{"refusal", e.what()}};
  }
}

using namespace lrb::stability;

struct Options {
  CaseQueue queue;
  std::string quantity = "distance", questions;
  std::optional<double> setting;
  bool pairs = false, errors = false;
};

Quantity quantity_of(const Options& o) {
  const auto q = from_name<Quantity>(o.quantity);
  if (!q || *q == Quantity::pairs) throw InputError("unknown quantity '" + o.quantity + "'");
  return *q;
}

NumberMethod method_of(Quantity quantity, const std::string& name) {
  for (NumberMethod& m : number_methods())
    if (m.quantity == quantity && m.info.name == name) return m;
  throw InputError("unknown method '" + name + "' for this quantity");
}

void say_records(const Options& o, Lines& out) {
  const cases::Family& family = family_of(o.queue);
  const NumberMethod method = method_of(quantity_of(o), o.queue.method);
  KnownAnswers known(o.queue);
  for (std::uint64_t k = o.queue.begin; k < o.queue.end; ++k) {
    const cases::Case c = make(family, o.queue, k);
    const std::optional<stability::RightAnswer> read = known.next();
    Record record = record_of(o.queue, k);
    const auto answer = ask_number(method, c, read ? *read : true_number(method.quantity, c), record);
    nlohmann::ordered_json value = to_json(record);
    if (o.pairs && answer && methods::is_list(method.quantity))
      value["answered_pairs"] = workers::PairsJson::write(answer->pairs);
    out.say(dump(value));
  }
}

/// Answers a data set's queries; without a method, with lrbscope at its finest setting.
void answer_questions(const Options& o, Lines& out) {
  const bench::DataSet set = bench::read_data_set(o.questions);
  const bool finds = o.queue.method.empty();
  const NumberMethod method = method_of(set.quantity, finds ? "ours" : o.queue.method);
  for (std::uint64_t k = o.queue.begin; k < o.queue.end; ++k)
    out.say(dump(finds ? known_number(method, set, k)
                       : to_json(bench_record(method, o.setting, set, k, o.errors))));
}

void work(const Options& o, Lines& out) {
  if (!o.questions.empty()) return answer_questions(o, out);
  if (o.queue.list) {
    for (const NumberMethod& m : number_methods())
      if (m.quantity == quantity_of(o)) out.say(dump(workers::to_json(m.info)));
  } else if (!o.queue.method.empty()) {
    say_records(o, out);
  } else {
    const cases::Family& family = family_of(o.queue);
    for (std::uint64_t k = o.queue.begin; k < o.queue.end; ++k)
      out.say(to_line(true_number(quantity_of(o), make(family, o.queue, k))));
  }
}

int run(int argc, char** argv) {
  Options o;
  CLI::App app("Runs cases on methods that return a number, for lrbscope stability.");
  add_options(app, o.queue);
  app.add_option("--quantity", o.quantity);
  app.add_option("--questions", o.questions);
  app.add_option("--setting", o.setting);
  app.add_flag("--pairs", o.pairs);
  app.add_flag("--errors", o.errors);  // of lists; numbers are judged by the survey
  CLI11_PARSE(app, argc, argv);
  return run_worker([&](Lines& out) { work(o, out); });
}

}  // namespace
}  // namespace lrb::worker_programs

int main(int argc, char** argv) {
  return lrb::worker_programs::run(argc, argv);
}

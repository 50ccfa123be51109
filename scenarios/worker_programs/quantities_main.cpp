/// lrbscope-quantities: a worker as worker.hpp has it, for methods that answer with a number. --quantity Q
/// says with which one, or the data set of --questions does; without --method it prints the right answers.
#include <optional>

#include "engine/core/error.hpp"
#include "scenarios/stability/quantities/number_method.hpp"
#include "scenarios/stability/record_json.hpp"
#include "scenarios/worker_programs/asked_cases.hpp"
#include "scenarios/worker_programs/number_questions.hpp"
#include "scenarios/workers/method_json.hpp"

namespace lrb::worker_programs {
namespace {

using namespace lrb::stability;

struct Options {
  AskedCases asked;
  std::string quantity = "distance", questions;
  std::optional<double> setting;
};

Quantity quantity_of(const Options& o) {
  const auto q = from_name<Quantity>(o.quantity);
  if (!q || *q == Quantity::pairs) throw InputError("there is no quantity '" + o.quantity + "'");
  return *q;
}

NumberMethod method_of(Quantity quantity, const std::string& name) {
  for (NumberMethod& m : number_methods())
    if (m.quantity == quantity && m.info.name == name) return m;
  throw InputError("there is no method '" + name + "' for this quantity");
}

void say_records(const Options& o, Lines& out) {
  const cases::Family& family = family_of(o.asked);
  const NumberMethod method = method_of(quantity_of(o), o.asked.method);
  KnownAnswers known(o.asked);
  for (std::uint64_t k = o.asked.begin; k < o.asked.end; ++k) {
    const cases::Case c = make(family, o.asked, k);
    const std::optional<stability::RightAnswer> read = known.next();
    Record record = record_of(o.asked, k);
    ask_number(method, c, read ? *read : true_number(method.quantity, c), record);
    out.say(dump(to_json(record)));
  }
}

/// Answers a data set's questions; without a method, with ours at its finest setting.
void answer_questions(const Options& o, Lines& out) {
  const bench::DataSet set = bench::read_data_set(o.questions);
  const bool judges = o.asked.method.empty();
  const NumberMethod method = method_of(set.quantity, judges ? "ours" : o.asked.method);
  for (std::uint64_t k = o.asked.begin; k < o.asked.end; ++k)
    out.say(dump(judges ? known_number(method, set, k) : to_json(bench_record(method, o.setting, set, k))));
}

void work(const Options& o, Lines& out) {
  if (!o.questions.empty()) return answer_questions(o, out);
  if (o.asked.list) {
    for (const NumberMethod& m : number_methods())
      if (m.quantity == quantity_of(o)) out.say(dump(workers::to_json(m.info)));
  } else if (!o.asked.method.empty()) {
    say_records(o, out);
  } else {
    const cases::Family& family = family_of(o.asked);
    for (std::uint64_t k = o.asked.begin; k < o.asked.end; ++k)
      out.say(to_line(true_number(quantity_of(o), make(family, o.asked, k))));
  }
}

int run(int argc, char** argv) {
  Options o;
  CLI::App app("Puts cases to methods that answer with a number, for lrbscope stability.");
  add_options(app, o.asked);
  app.add_option("--quantity", o.quantity);
  app.add_option("--questions", o.questions);
  app.add_option("--setting", o.setting);
  app.add_flag("--pairs");  // asked of all workers; there are none here
  CLI11_PARSE(app, argc, argv);
  return run_worker([&](Lines& out) { work(o, out); });
}

}  // namespace
}  // namespace lrb::worker_programs

int main(int argc, char** argv) {
  return lrb::worker_programs::run(argc, argv);
}

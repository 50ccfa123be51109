/// lrbscope-quantities: a worker as worker.hpp has it, for methods that answer with a number. --quantity Q says
/// with which one; without --method it prints the right answers.
#include <algorithm>
#include <fstream>

#include <CLI/CLI.hpp>

#include "engine/core/error.hpp"
#include "scenarios/stability/quantities/number_method.hpp"
#include "scenarios/stability/record_json.hpp"
#include "scenarios/worker_programs/lines.hpp"
#include "scenarios/workers/method_json.hpp"

namespace lrb::worker_programs {
namespace {

using namespace lrb::stability;

struct Options {
  bool list = false;
  std::string quantity = "distance", family, method, expected;
  std::uint64_t seed = 1, cases = 1, begin = 0, end = 0;
};

Quantity quantity_of(const Options& o) {
  const auto q = from_name<Quantity>(o.quantity);
  if (!q || *q == Quantity::pairs) throw InputError("there is no quantity '" + o.quantity + "'");
  return *q;
}

const cases::Family& family_of(const Options& o) {
  const cases::Family* family = cases::find_family(o.family);
  if (family == nullptr) throw InputError("there is no family '" + o.family + "'");
  return *family;
}

cases::Case make(const cases::Family& family, const Options& o, std::uint64_t k) {
  return cases::make_case(family, o.seed, static_cast<int>(k / o.cases), k % o.cases);
}

NumberMethod method_of(const Options& o) {
  for (NumberMethod& m : number_methods())
    if (m.quantity == quantity_of(o) && m.info.name == o.method) return m;
  throw InputError("there is no method '" + o.method + "' for this quantity");
}

void say_records(const Options& o, Lines& out) {
  const cases::Family& family = family_of(o);
  const NumberMethod method = method_of(o);
  std::ifstream known(o.expected);
  std::string line;
  for (std::uint64_t k = 0; k < o.begin; ++k) std::getline(known, line);
  for (std::uint64_t k = o.begin; k < o.end; ++k) {
    const cases::Case c = make(family, o, k);
    const Expected expected =
        std::getline(known, line) ? expected_from(line) : true_number(method.quantity, c);
    Record record;
    record.family = o.family;
    record.method = o.method;
    record.dial = static_cast<int>(k / o.cases);
    record.case_index = k % o.cases;
    record.seed = o.seed;
    ask_number(method, c, expected, record);
    out.say(dump(to_json(record)));
  }
}

void work(const Options& o, Lines& out) {
  if (o.list) {
    for (const NumberMethod& m : number_methods())
      if (m.quantity == quantity_of(o)) out.say(dump(workers::to_json(m.info)));
  } else if (!o.method.empty()) {
    say_records(o, out);
  } else {
    const cases::Family& family = family_of(o);
    for (std::uint64_t k = o.begin; k < o.end; ++k)
      out.say(to_line(true_number(quantity_of(o), make(family, o, k))));
  }
}

int run(int argc, char** argv) {
  static constexpr int kOk = 0, kBadInput = 2;
  Options o;
  CLI::App app("Puts cases to methods that answer with a number, for lrbscope stability.");
  app.add_flag("--list", o.list);
  app.add_option("--quantity", o.quantity);
  app.add_option("--family", o.family);
  app.add_option("--method", o.method);
  app.add_option("--seed", o.seed);
  app.add_option("--cases", o.cases)->check(CLI::PositiveNumber);
  app.add_option("--begin", o.begin);
  app.add_option("--end", o.end);
  app.add_option("--expected", o.expected);
  app.add_flag("--pairs");  // asked of all workers; there are none here
  CLI11_PARSE(app, argc, argv);
  Lines out;
  try {
    work(o, out);
    return kOk;
  } catch (const std::exception& e) {
    out.say(dump({{"error", e.what()}}));
    return kBadInput;
  }
}

}  // namespace
}  // namespace lrb::worker_programs

int main(int argc, char** argv) {
  return lrb::worker_programs::run(argc, argv);
}

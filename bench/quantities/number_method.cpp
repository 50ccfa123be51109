#include "bench/quantities/number_method.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "bench/workers/worker_json.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::stability {
namespace {

constexpr double kMaxOffOfSize = 1e-6, kMaxOffOfMotion = 1e-3;
constexpr int kDigits = 9;

std::string to_text(Quantity quantity, double lower, double upper) {
  if (quantity == Quantity::first_contact && lower >= kNever) return "never";
  const std::string first = io::number_text(lower, kDigits), last = io::number_text(upper, kDigits);
  return first == last ? first : first + " to " + last;
}

/// Returns true if an interval is the special value of its quantity: 0 ("in contact") or kNever.
bool is_special(Quantity quantity, double least, double most) {
  return quantity == Quantity::first_contact ? least >= kNever : most <= 0;
}

}  // namespace

NumberMethod number_method(const std::string& name, const std::string& title, const char* remark,
                           Quantity quantity, Ask ask, methods::MethodStyle style) {
  NumberMethod m;
  m.info.name = name;
  m.info.title = title;
  m.info.remark = remark;
  m.info.style = std::move(style);
  m.quantity = quantity;
  m.ask = std::move(ask);
  return m;
}

NumberMethod with_parameter(NumberMethod m, const char* parameter, std::vector<double> settings) {
  m.info.parameter = parameter;
  m.info.settings = std::move(settings);
  return m;
}

std::vector<NumberMethod> number_methods() {
  std::vector<NumberMethod> all = own_number_methods();
  for (NumberMethod& m : fcl_number_methods()) all.push_back(std::move(m));
  for (NumberMethod& m : cgal_number_methods()) all.push_back(std::move(m));
  return all;
}

void add_near(NumberAnswer& answer, SimplexPair pair, double distance) {
  answer.pairs.push_back(pair);
  answer.distances.push_back(distance);
}

void sort_near(NumberAnswer& answer) {
  std::vector<std::pair<SimplexPair, double>> both;
  for (std::size_t i = 0; i < answer.pairs.size(); ++i)
    both.emplace_back(answer.pairs[i], answer.distances[i]);
  std::sort(both.begin(), both.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  for (std::size_t i = 0; i < both.size(); ++i) std::tie(answer.pairs[i], answer.distances[i]) = both[i];
}

void judge_number(Record& record, const NumberMethod& method, const NumberAnswer& answer,
                  const RightAnswer& expected, double size) {
  const double least = expected.least.value(), most = expected.most.value();
  const bool is_time = method.quantity == Quantity::first_contact;
  record.relation = to_text(method.quantity, answer.lower, answer.upper);
  record.expected_relation = to_text(method.quantity, least, most);
  const bool special = is_special(method.quantity, least, most);
  bool right = is_special(method.quantity, answer.lower, answer.upper) == special;
  if (method.proves) {
    right = right && answer.lower <= most && answer.upper >= least;
  } else if (!special) {
    const double off = std::max(least - answer.upper, answer.lower - most);
    right = right && off <= (is_time ? kMaxOffOfMotion : kMaxOffOfSize * size);
  }
  record.outcome = right ? Outcome::right : Outcome::wrong;
}

void judge_list(Record& record, const NumberAnswer& answer, const RightAnswer& expected) {
  record.missed = methods::without(expected.pairs, answer.pairs).size();
  record.extra = methods::without(answer.pairs, expected.pairs).size();
  record.relation = std::to_string(answer.pairs.size()) + " pairs";
  record.expected_relation = std::to_string(expected.pairs.size()) + " pairs";
  record.outcome = record.missed + record.extra == 0 ? Outcome::right : Outcome::wrong;
}

std::optional<NumberAnswer> ask_number(const NumberMethod& method, const cases::Case& c,
                                       const RightAnswer& expected, Record& record) {
  std::optional<NumberAnswer> out;
  record.expected = expected.pairs.size();
  workers::note_failures(record, [&] {
    if (!expected.rejection.empty()) throw InputError("skipped: " + expected.rejection);
    const NumberQuery question = query_of(c);
    const NumberAnswer answer = method.ask(question, std::nullopt);
    record.microseconds = answer.microseconds;
    if (methods::is_list(method.quantity))
      judge_list(record, answer, expected);
    else
      judge_number(record, method, answer, expected, question.size);
    out = answer;
  });
  return out;
}

}  // namespace lrb::stability

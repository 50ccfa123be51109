#include "bench/stability/judge.hpp"

#include <algorithm>
#include <iterator>

#include "bench/workers/worker_json.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>

namespace lrb {

template <>
inline constexpr auto kFields<stability::RightAnswer> = std::tuple{
    field("pairs", &stability::RightAnswer::pairs), field("relation", &stability::RightAnswer::relation),
    field("least", &stability::RightAnswer::least, Kept::if_set),
    field("most", &stability::RightAnswer::most, Kept::if_set),
    field("refusal", &stability::RightAnswer::rejection, Kept::if_set)};
static_assert(covers_all_fields<stability::RightAnswer>);

}  // namespace lrb

namespace lrb::stability {
namespace {

std::string why_not(const cases::Case& c) {
  char name = 'A';
  for (const auto& [rep, pose] : {std::pair{c.a, c.pose_a}, std::pair{c.b, c.pose_b}}) {
    for (std::size_t v = 0; v < rep->vertices().size(); ++v)
      if (!pose.apply(rep->vertices()[v]).allFinite())
        return std::string("body ") + name + ", vertex " + std::to_string(v) +
               " is not representable as double";
    ++name;
  }
  return "";
}

}  // namespace

RightAnswer expected_answer(const cases::Case& c) {
  RightAnswer e;
  e.rejection = why_not(c);
  if (!e.rejection.empty()) return e;
  BruteForceResult r = brute_force(*c.a, c.pose_a, *c.b, c.pose_b);
  e.pairs = std::move(r.pairs);
  e.relation = r.relation;
  return e;
}

std::string to_line(const RightAnswer& e) {
  return io::record_to_json(e).dump() + "\n";
}

RightAnswer expected_from(const std::string& line) {
  return io::record_from_json<RightAnswer>(nlohmann::json::parse(line));
}

Relation relation_from(const std::string& word) {
  if (const auto r = from_name<Relation>(word); r && *r != Relation::unresolved) return *r;
  throw InputError("'" + word + "': unknown relation");
}

namespace {

using methods::MethodAnswer;
using methods::MethodInfo;
using methods::Says;

bool is_inside(Relation r) {
  return r == Relation::a_inside_b || r == Relation::b_inside_a;
}

Relation mirrored(Relation r) {
  if (r == Relation::a_inside_b) return Relation::b_inside_a;
  if (r == Relation::b_inside_a) return Relation::a_inside_b;
  return r;
}

const char* in_brief(bool contact, bool inside) {
  return contact ? "contact" : inside ? "inside" : "separate";
}

void compare_pairs(Record& record, const std::vector<SimplexPair>& answered,
                   const std::vector<SimplexPair>& expected) {
  std::vector<SimplexPair> missed, extra;
  std::set_difference(expected.begin(), expected.end(), answered.begin(), answered.end(),
                      std::back_inserter(missed));
  std::set_difference(answered.begin(), answered.end(), expected.begin(), expected.end(),
                      std::back_inserter(extra));
  record.missed = missed.size();
  record.extra = extra.size();
}

void compare_contact(Record& record, bool answered, bool expected) {
  record.missed = expected && !answered;
  record.extra = answered && !expected;
}

void conclude(Record& record, bool relation_matters, bool extra_matters = true) {
  const bool right = record.missed == 0 && (record.extra == 0 || !extra_matters) &&
                     (!relation_matters || record.relation == record.expected_relation);
  record.outcome = right ? Outcome::right : Outcome::wrong;
}

}  // namespace

void judge(Record& record, const MethodInfo& info, const MethodAnswer& answer, const RightAnswer& expected) {
  if (!expected.rejection.empty()) {
    record.outcome = Outcome::wrong;
    record.message = "answered, although " + expected.rejection;
    return;
  }
  record.expected = expected.pairs.size();
  if (info.pairs)
    compare_pairs(record, answer.pairs, expected.pairs);
  else
    compare_contact(record, answer.contact, !expected.pairs.empty());
  if (answer.relation) {
    record.relation = to_string(*answer.relation);
    record.expected_relation = to_string(expected.relation);
  } else if (answer.inside) {
    record.relation = in_brief(answer.contact, *answer.inside);
    record.expected_relation = in_brief(!expected.pairs.empty(), is_inside(expected.relation));
  }
  // For bodies that are not closed, only surface queries are defined.
  conclude(record, answer.relation || expected.relation != Relation::undefined,
           !info.has(methods::Trait::loose) || expected.pairs.empty());
}

void judge_swapped(Record& record, const MethodInfo& info, const MethodAnswer& answer,
                   const MethodAnswer& swapped, bool several) {
  std::vector<SimplexPair> back;
  for (const SimplexPair& p : swapped.pairs) back.push_back({p.b, p.a});
  std::sort(back.begin(), back.end());
  if (info.pairs)
    compare_pairs(record, back, answer.pairs);
  else
    compare_contact(record, swapped.contact, answer.contact);
  bool relation_matters = true;
  if (answer.relation && swapped.relation) {
    record.relation = to_string(mirrored(*swapped.relation));
    record.expected_relation = to_string(*answer.relation);
    relation_matters = !(several && is_inside(*answer.relation) && is_inside(*swapped.relation));
  } else if (answer.inside && swapped.inside) {
    record.relation = in_brief(swapped.contact, *swapped.inside);
    record.expected_relation = in_brief(answer.contact, *answer.inside);
  }
  conclude(record, relation_matters);
}

}  // namespace lrb::stability

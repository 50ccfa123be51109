#include "scenarios/stability/expected.hpp"

#include "engine/core/error.hpp"
#include "engine/query/brute_force.hpp"
#include "scenarios/workers/pairs_json.hpp"

namespace lrb {

template <>
inline constexpr auto kFields<stability::RightAnswer> = std::tuple{
    field("pairs", &stability::RightAnswer::pairs), field("relation", &stability::RightAnswer::relation),
    field("least", &stability::RightAnswer::least, Kept::if_set),
    field("most", &stability::RightAnswer::most, Kept::if_set),
    field("refusal", &stability::RightAnswer::refusal, Kept::if_set)};
static_assert(covers_all_fields<stability::RightAnswer>);

}  // namespace lrb

namespace lrb::stability {
namespace {

std::string why_not(const cases::Case& c) {
  char name = 'A';
  for (const auto& [rep, pose] : {std::pair{c.a, c.pose_a}, std::pair{c.b, c.pose_b}}) {
    for (std::size_t v = 0; v < rep->vertices().size(); ++v)
      if (!pose.apply(rep->vertices()[v]).allFinite())
        return std::string("body ") + name + ", vertex " + std::to_string(v) + " is at no double";
    ++name;
  }
  return "";
}

}  // namespace

RightAnswer expected_answer(const cases::Case& c) {
  RightAnswer e;
  e.refusal = why_not(c);
  if (!e.refusal.empty()) return e;
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
  throw InputError("'" + word + "' is not a relation of two bodies");
}

}  // namespace lrb::stability

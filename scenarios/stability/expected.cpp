#include "scenarios/stability/expected.hpp"

#include "engine/core/error.hpp"
#include "engine/query/brute_force.hpp"
#include "scenarios/workers/pairs_json.hpp"

namespace lrb {

template <>
inline constexpr auto kFields<stability::Expected> =
    std::tuple{field("pairs", &stability::Expected::pairs), field("relation", &stability::Expected::relation),
               field("least", &stability::Expected::least, Kept::if_set),
               field("most", &stability::Expected::most, Kept::if_set),
               field("refusal", &stability::Expected::refusal, Kept::if_set)};
static_assert(covers_all_fields<stability::Expected>);

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

Expected expected_answer(const cases::Case& c) {
  Expected e;
  e.refusal = why_not(c);
  if (!e.refusal.empty()) return e;
  BruteForceResult r = brute_force(*c.a, c.pose_a, *c.b, c.pose_b);
  e.pairs = std::move(r.pairs);
  e.relation = r.relation;
  return e;
}

std::string to_line(const Expected& e) {
  return io::record_to_json(e).dump() + "\n";
}

Expected expected_from(const std::string& line) {
  return io::record_from_json<Expected>(nlohmann::json::parse(line));
}

Relation relation_from(const std::string& word) {
  if (const auto r = from_name<Relation>(word); r && *r != Relation::unresolved) return *r;
  throw InputError("'" + word + "' is not a relation of two bodies");
}

}  // namespace lrb::stability

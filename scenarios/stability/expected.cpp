#include "scenarios/stability/expected.hpp"

#include "engine/core/error.hpp"
#include "engine/query/brute_force.hpp"

namespace lrb::stability {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

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

ordered_json to_json(const std::vector<SimplexPair>& pairs) {
  ordered_json list = ordered_json::array();
  for (const SimplexPair& p : pairs) list.push_back({p.a.value(), p.b.value()});
  return list;
}

std::vector<SimplexPair> pairs_from(const json& pairs) {
  std::vector<SimplexPair> out;
  for (const json& p : pairs)
    out.push_back({SimplexId(p.at(0).get<std::uint32_t>()), SimplexId(p.at(1).get<std::uint32_t>())});
  return out;
}

std::string to_line(const Expected& e) {
  ordered_json line = {{"relation", to_string(e.relation)}, {"pairs", to_json(e.pairs)}};
  if (!e.refusal.empty()) line["refusal"] = e.refusal;
  return line.dump() + "\n";
}

Expected expected_from(const std::string& line) {
  const json value = json::parse(line);
  return {pairs_from(value.at("pairs")), relation_from(value.at("relation").get<std::string>()),
          value.value("refusal", "")};
}

Relation relation_from(const std::string& word) {
  if (const auto r = from_name<Relation>(word); r && *r != Relation::unresolved) return *r;
  throw InputError("'" + word + "' is not a relation of two bodies");
}

}  // namespace lrb::stability

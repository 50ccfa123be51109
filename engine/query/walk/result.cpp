#include "engine/query/walk/result.hpp"

#include "engine/core/fnv.hpp"

namespace lrb {

const char* to_string(Relation r) {
  switch (r) {
    case Relation::separate:
      return "separate";
    case Relation::crossing:
      return "crossing";
    case Relation::touching:
      return "touching";
    case Relation::a_inside_b:
      return "a_inside_b";
    case Relation::b_inside_a:
      return "b_inside_a";
    case Relation::undefined:
      return "undefined";
    case Relation::unresolved:
      return "unresolved";
  }
  return "";
}

const char* to_string(Answer a) {
  return a == Answer::yes ? "yes" : a == Answer::no ? "no" : "unknown";
}

const char* to_string(Recursion r) {
  switch (r) {
    case Recursion::complete:
      return "complete";
    case Recursion::paper:
      return "paper";
    case Recursion::paper_strict:
      return "paper-strict";
  }
  return "";
}

std::uint64_t fingerprint(const std::vector<SimplexPair>& pairs) {
  Fnv64 h;
  for (const SimplexPair& p : pairs) {
    h.add_value(p.a);
    h.add_value(p.b);
  }
  return h.value();
}

}  // namespace lrb

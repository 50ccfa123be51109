#include "engine/query/walk/result.hpp"

#include <string>

#include "engine/core/error.hpp"
#include "engine/core/fnv.hpp"

namespace lrb {

const char* to_string(Relation r) {
  return name_of(r).data();
}
const char* to_string(Answer a) {
  return name_of(a).data();
}
const char* to_string(Recursion r) {
  return name_of(r).data();
}

void refuse_pairs(std::uint64_t limit) {
  throw InputError("the bodies meet in more than " + std::to_string(limit) +
                   " pairs of triangles, the most that are kept: raise max_pairs (--max-pairs) if there is "
                   "memory for more, about 25 bytes a pair and 650 with its contact, or ask only whether "
                   "they meet (mode any or first)");
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

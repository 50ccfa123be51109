// Cases of the other families, asked both ways. They are drawn from all families in their order: a family
// that is added changes which cases these are.
#include "scenarios/cases/families.hpp"

namespace lrb::cases {
namespace {

Case make_swapped(RandomEngine& random, double dial) {
  const std::span<const Family> families = all_families();
  while (true) {  // until it is one of the others
    const Family& f = families[random() % families.size()];
    if (!f.both_ways) return f.make(random, dial);
  }
}

}  // namespace

std::vector<Family> swapped_families() {
  return {
      {"swapped", "cases of the others, asked both ways: is B against A the transpose of A against B?",
       make_swapped, "as theirs", "as theirs", true, 250},
  };
}

}  // namespace lrb::cases

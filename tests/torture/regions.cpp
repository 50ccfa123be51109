#include <unordered_map>

#include "tests/torture/torture.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>

namespace lrb::torture {
namespace {

using cases::Body;
using cases::RandomEngine;

/// Null if the builder refuses the mesh.
cases::Body built(const LrbRep& rep, RandomEngine& random) {
  BuildOptions options;
  options.patch_interior = static_cast<std::uint32_t>(cases::pick(random, 2, 16));
  options.seed = random();
  try {
    return std::make_shared<LrbRep>(build_lrb(rep.real_mesh(), options));
  } catch (const InputError&) {
    return nullptr;
  }
}

bool give(cases::Body& body, RandomEngine& random, std::uint32_t max_simplices) {
  if (body->region_count() > 0 || body->real_simplex_count() > max_simplices) return false;
  // Drawn always, so that what follows does not depend on what is kept.
  RandomEngine own(random());
  static std::unordered_map<std::uint64_t, cases::Body> kept;  // many families draw from a dozen bodies
  const std::uint64_t key = body->hash() * 8 + own() % 8;
  if (kept.size() > 1000) kept.clear();
  const auto [it, fresh] = kept.try_emplace(key);
  if (fresh) {
    RandomEngine options(key);
    it->second = built(*body, options);
  }
  if (!it->second) return false;
  body = it->second;
  return body->region_count() > 0;
}

}  // namespace

int give_regions(cases::Case& c, cases::RandomEngine& random, std::uint32_t max_simplices) {
  int count = give(c.a, random, max_simplices);
  count += give(c.b, random, max_simplices);
  return count;
}

}  // namespace lrb::torture

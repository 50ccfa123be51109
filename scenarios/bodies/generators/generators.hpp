#pragma once
/// Makes bodies by our own code: seeded, closed, oriented outward, free of self-intersections.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::generators {

struct GeneratorParameter {
  const char* name;
  double fallback, least, most;
  bool whole;        ///< takes whole numbers only
  const char* what;  ///< with its unit
};

using GeneratorValues = std::map<std::string, double>;

struct Generator {
  const char* name;
  const char* purpose;
  int dim;
  std::vector<GeneratorParameter> parameters;
  Mesh (*make)(const GeneratorValues& values, std::uint64_t seed);  ///< every parameter has its value
  /// Makes bodies whose regions are known by construction, so that no builder is needed; null for others.
  LrbRep (*make_rep)(const GeneratorValues& values, std::uint64_t seed) = nullptr;
};

std::span<const Generator> generators();
/// Returns a generator by its name; null if there is none.
const Generator* find_generator(const std::string& name);

/// Makes a body; parameters that `values` does not name have the generator's defaults. Throws InputError for
/// an unknown name or parameter and for a value out of range.
Mesh generate(const std::string& name, const GeneratorValues& values = {}, std::uint64_t seed = 1);
/// Makes the same body with its regions, if the generator knows them; nothing if a builder has to find them.
std::optional<LrbRep> generate_rep(const std::string& name, const GeneratorValues& values = {},
                                   std::uint64_t seed = 1);

}  // namespace lrb::generators

#include "engine/build/chain_builder.hpp"

#include "engine/build/complex_builder.hpp"

namespace lrb {
LrbData build_by_chains(const Mesh& mesh, const std::vector<FaceId>&, const BuildOptions&) {
  return ComplexBuilder(mesh).finish(true, false);
}
}  // namespace lrb

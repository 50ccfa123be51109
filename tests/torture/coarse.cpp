#include <cmath>

#include "tests/support/coarse_checks.hpp"
#include "tests/torture/torture.hpp"

namespace lrb::torture {

void check_coarse(const cases::Case& c, const BruteForceResult& truth, RandomEngine& random, Tally& t,
                  std::string& trouble) {
  constexpr int kQueries = 16;
  constexpr std::uint64_t kMeasuredEvery = 4;  // measuring takes longer than all else
  static QueryContext context;
  const double size = shapes::box_of(*c.a).diagonal().norm(),
               far = std::max(c.pose_a.t.cwiseAbs().maxCoeff(), c.pose_b.t.cwiseAbs().maxCoeff());
  // Distances are measured in doubles, whose squares must not overflow.
  if (!(size > 1e-100 && size < 1e100 && far < 1e100) || !c.a->closed() || !c.b->closed()) return;
  const bool meets = truth.relation != Relation::separate;
  for (int i = 0; i < kQueries; ++i) {
    CollideRequest request;
    request.tolerance = std::pow(10, uniform(random, -3, 0)) * size;
    request.mode = static_cast<Mode>(random() % 3);
    if (random() % 3 == 0) request.max_tests = std::uint64_t{1} << random() % 8;
    NullProbe probe;
    const CollideResult coarse = collide(*c.a, c.pose_a, *c.b, c.pose_b, request, context, probe);
    ++t.coarse;
    if (coarse.relation != truth.relation && coarse.relation != Relation::unresolved &&
        request.mode != Mode::any_pair)
      complain(t.wrong_relations, trouble, "coarse: another relation");
    if (meets && coarse.relation == Relation::separate)
      complain(t.wrong_relations, trouble, "coarse: separate, though they meet");
    if (meets && test::wrappers_are_disjoint(*c.a, c.pose_a, *c.b, c.pose_b, request.tolerance, context))
      complain(t.wrong_relations, trouble, "wrappers apart, though the bodies meet");
    if (random() % kMeasuredEvery != 0 || !(coarse.error_bound > 0) || !std::isfinite(coarse.error_bound))
      continue;
    ++t.measured;
    const test::RealSurfaces real(*c.a, c.pose_a, *c.b, c.pose_b);
    const double bound = coarse.error_bound * (1 + 1e-9) + 1e-12 * far;  // measured values are also rounded
    if (!coarse.pairs.empty() && real.off(coarse.pairs[random() % coarse.pairs.size()]) > bound)
      complain(t.wrong_bounds, trouble, "coarse: a pair deviates by more than the bound");
    if (!meets && coarse.relation == Relation::unresolved && real.between() > bound)
      complain(t.wrong_bounds, trouble, "coarse: unresolved, and further apart than the bound");
  }
}

}  // namespace lrb::torture

#include "engine/query/coarse/coarse_query.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"

namespace lrb {
namespace {

/// Factor from one tolerance of the ladder to the next. Smaller: more queries before the exact one; larger:
/// coarser answers where a limit is reached.
constexpr double kLadderStep = 4;
/// A level with more than this share of the bodies' own faces is left out: the exact query costs hardly more.
constexpr double kWorthwhile = 0.7;

}  // namespace

void check_coarse_request(const CollideRequest& request) {
  if (!(request.tolerance >= 0) || !std::isfinite(request.tolerance))
    throw InputError("the tolerance of a query must be a finite length, 0 or more");
  if (!(request.max_time >= 0)) throw InputError("the time limit of a query must be 0 or more seconds");
  if (request.recursion != Recursion::complete)
    throw InputError("a tolerance or limit needs the complete recursion; leave \"paper\" out");
  if (request.contacts || request.interiors_overlap)
    throw InputError(
        "contacts and interiors_overlap are exact: they cannot be combined with a tolerance or limit; leave "
        "out one or the other");
  if (request.wrapper != WrapperMode::regularised)
    throw InputError("a tolerance or limit needs regularised wrappers; leave \"unregularised\" out");
}

std::vector<double> coarse_ladder(QueryContext& context, const CollideRequest& request) {
  // A surface that bounds nothing hides nothing: both bodies have to be queried as they are.
  for (const Side side : {Side::a, Side::b})
    if (!context[side].rep().closed() || context[side].rep().self_intersecting()) return {0};
  std::vector<double> ladder;
  WrapperLevels &a = context[Side::a].levels(), &b = context[Side::b].levels();
  const double largest = std::max(a.largest_thickness(), b.largest_thickness());
  const double smallest = std::min(a.smallest_thickness(), b.smallest_thickness());
  if ((request.max_tests > 0 || request.max_time > 0) && largest > 0) {
    const double real = static_cast<double>(context[Side::a].rep().real_face_count()) +
                        context[Side::b].rep().real_face_count();
    // Use powers of two, so that bodies of similar size share levels from pair to pair.
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (double x = std::ldexp(1.0, exponent); x > request.tolerance && x >= smallest; x /= kLadderStep) {
      const double faces = static_cast<double>(a.at(x).face_count) + b.at(x).face_count;
      if (faces > kWorthwhile * real) break;
      ladder.push_back(x);
    }
  }
  ladder.push_back(request.tolerance);
  a.at(request.tolerance);
  b.at(request.tolerance);
  return ladder;
}

bool wrappers_nested(QueryContext& context) {
  const auto has_piece_in = [](QueryBody& inner, QueryBody& outer) {
    return std::any_of(inner.component_vertices().begin(), inner.component_vertices().end(),
                       [&](VertexId v) { return locate(outer, inner.world(v)) != Where::outside; });
  };
  QueryBody &a = context[Side::a], &b = context[Side::b];
  return has_piece_in(a, b) || has_piece_in(b, a);
}

}  // namespace lrb

#include "engine/collide/coarse_query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <lrbscope/error.hpp>

namespace lrb {
namespace {

/// Factor between successive tolerances. Smaller: more queries before the exact one; larger: coarser answers
/// when a limit is reached.
constexpr double kLadderStep = 4;
/// Steps with more than this share of the bodies' own faces are skipped: the exact query costs hardly more.
/// Measured for bodies of 1,000 faces at shares of 0.44 to 0.59: levels take 1.0 to 1.1 times as long for
/// shallow contacts, 0.7 to 0.9 times for deep ones.
constexpr double kWorthwhile = 0.6;

}  // namespace

void check_request(const CollideRequest& request) {
  // Only a tolerance or a limit restricts what else can be requested.
  if (!request.is_coarse()) return;
  if (!(request.tolerance >= 0) || !std::isfinite(request.tolerance))
    throw InputError("tolerance: expected a finite length of at least 0");
  if (!(request.max_time >= 0)) throw InputError("max_time: expected at least 0 seconds");
  if (request.recursion != Recursion::complete)
    throw InputError("a tolerance or limit requires recursion \"complete\", found \"paper\"");
  if (request.contacts || request.interiors_overlap)
    throw InputError(
        "contacts and interiors_overlap are exact and cannot be combined with a tolerance or limit; leave one "
        "of them out");
  if (request.wrapper != WrapperMode::regularised)
    throw InputError("a tolerance or limit requires regularised wrappers; leave \"unregularised\" out");
}

namespace {

/// Returns the level of a body for a tolerance, or null for the body itself. Under a time limit only levels
/// that exist already are used.
const WrapperLevel* level_of(const LrbRep& rep, double tolerance, const CollideRequest& request) {
  // Building levels takes milliseconds, which a time limit does not allow for.
  return request.max_time > 0 && !rep.has_levels() ? nullptr : rep.levels().within(tolerance);
}

std::uint32_t faces_of(const LrbRep& rep, const WrapperLevel* level) {
  return level == nullptr ? rep.real_face_count() : level->face_count;
}

/// Returns the levels for a tolerance, or the bodies themselves if these are hardly more work.
CoarseStep step_of(const LrbRep& a, const LrbRep& b, double tolerance, const CollideRequest& request) {
  const CoarseStep step{level_of(a, tolerance, request), level_of(b, tolerance, request)};
  // The sum over both bodies decides: one level may be worth it even if the other body is queried as it is.
  const double faces = static_cast<double>(faces_of(a, step.a)) + faces_of(b, step.b);
  return faces > kWorthwhile * (static_cast<double>(a.real_face_count()) + b.real_face_count()) ? CoarseStep{}
                                                                                                : step;
}

}  // namespace

bool is_limited(const CollideRequest& request) {
  return request.max_tests > 0 || request.max_time > 0;
}

std::optional<CoarseStep> first_step(const LrbRep& a, const LrbRep& b, const CollideRequest& request) {
  const bool limited = is_limited(request);
  if (!limited && request.mode != Mode::all_pairs) return std::nullopt;
  CoarseStep step;
  // Wrappers of a surface that is not closed or intersects itself need not enclose it: no levels.
  if (a.closed() && b.closed() && !a.self_intersecting() && !b.self_intersecting())
    step = step_of(a, b, limited ? std::numeric_limits<double>::max() : request.tolerance, request);
  return limited || !step.exact() ? std::optional(step) : std::nullopt;
}

std::vector<CoarseStep> coarse_steps(const LrbRep& a, const LrbRep& b, const CoarseStep& first,
                                     const CollideRequest& request) {
  // Without limits the level of the tolerance is the only step.
  if (!is_limited(request)) return {first};
  std::vector<CoarseStep> steps;
  // Use powers of two, so that bodies of similar size share levels from pair to pair.
  int exponent = 0;
  std::frexp(std::max(first.a ? first.a->bound : 0, first.b ? first.b->bound : 0), &exponent);
  for (double x = std::ldexp(1.0, exponent); x > request.tolerance; x /= kLadderStep) {
    const CoarseStep step = step_of(a, b, x, request);
    // Finer levels have even more faces.
    if (step.exact()) break;
    // Different tolerances can yield the same levels: each is tried once.
    if (steps.empty() || step.a != steps.back().a || step.b != steps.back().b) steps.push_back(step);
    // Of coplanar faces in regions: no level is finer.
    if (std::max(step.a ? step.a->bound : 0, step.b ? step.b->bound : 0) == 0) break;
  }
  // The last step is as fine as the request: its level, or the bodies themselves.
  const CoarseStep last = request.tolerance > 0 ? step_of(a, b, request.tolerance, request) : CoarseStep{};
  if (steps.empty() || last.a != steps.back().a || last.b != steps.back().b) steps.push_back(last);
  return steps;
}

}  // namespace lrb

#pragma once
/// Defines collide() for any probe, at no cost beyond the probe's own, for code compiled with the engine's
/// private headers. Users of the installed engine include <lrbscope/observe.hpp>.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>

#include "engine/collide/coarse_query.hpp"
#include "engine/collide/paper_query.hpp"
#include "engine/collide/relation.hpp"
#include "engine/collide/tree_query.hpp"
#include "engine/exact/predicates.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/observe.hpp>

namespace lrb {

/// Collides body `a` at pose_a with body `b` at pose_b, as collide() in collide.hpp does. `context`: reusable
/// buffers, one context per thread. `probe`: see NullProbe. `result`: new, or emptied by clear().
template <class Probe>
void collide_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const CollideRequest& request, QueryContext& context, Probe& probe, CollideResult& result) {
  const FloatMode float_mode;
  check_query(a, pose_a, b, pose_b);
  if (request.is_coarse()) check_request(request);
  result.recursion = request.recursion;
  result.mode = request.mode;
  // Most queries of scattered bodies end here. With a probe, TreeQuery makes the test.
  const bool tests_roots = !Probe::kEnabled && request.recursion == Recursion::complete;
  const bool ends_at_roots = tests_roots && roots_are_apart(a.tree(), pose_a, b.tree(), pose_b);
  if (ends_at_roots && !request.separation && a.closed() && b.closed()) {
    set_separate(result);
    count_roots_apart(result.counters);
    return;
  }
  const std::optional<CoarseStep> coarse = request.is_coarse() ? first_step(a, b, request) : std::nullopt;
  context.body[0].begin(a, pose_a, request.wrapper);
  context.body[1].begin(b, pose_b, request.wrapper);
  const std::uint64_t fallbacks = exact::exact_fallbacks();
  {
    const exact::FloatingPredicates floating(request.predicates == Predicates::floating);
    if (coarse) {
      CoarseQuery<Probe>(context, request, *coarse, !tests_roots || ends_at_roots, result, probe).run();
    } else {
      bool apart = false;
      if (request.recursion == Recursion::complete) {
        TreeQuery<Probe> query(context, request, result, probe);
        query.run(!tests_roots || ends_at_roots);
        apart = query.ends_at_roots() && a.closed() && b.closed();
      } else {
        PaperQuery<Probe>(context, request, result, probe).run();
      }
      in_phase(probe, Phase::sort, [&] {
        context.pair_order.sort(result);
        return result.pairs.size();
      });
      // A probe is shown the location of points even if boxes decide.
      if (apart && !Probe::kEnabled)
        set_separate(result);
      else
        decide_relation_watched(context, result, probe, [] { return true; });
    }
  }
  if (request.separation && result.relation == Relation::separate)
    in_phase(probe, Phase::separation, [&] {
      result.separation = find_separation(context);
      return result.separation ? result.separation->face_count[0] + result.separation->face_count[1] : 0;
    });
  if (request.contacts || request.interiors_overlap)
    in_phase(probe, Phase::contacts, [&] {
      describe_contact(context, request, result);
      return result.regions.size();
    });
  for (int side = 0; side < 2; ++side) {
    result.opened[side] = context.body[side].wrapper->excluded();
    result.counters.regions_opened += result.opened[side].size();
  }
  // Other threads have added theirs.
  result.counters.exact_fallbacks += exact::exact_fallbacks() - fallbacks;
}

/// Collides two bodies and returns a new result.
template <class Probe>
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request, QueryContext& context, Probe& probe) {
  CollideResult result;
  collide_into(a, pose_a, b, pose_b, request, context, probe, result);
  return result;
}

/// Collides two bodies with a probe from outside the engine, or null. Compiled once, in collide.cpp.
void collide_watched(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const CollideRequest& request, QueryContext& context, CollideProbe* probe,
                     CollideResult& result);

/// Adapts a CollideProbe to the static probe interface of the query templates.
class ProbeAdapter {
 public:
  static constexpr bool kEnabled = true;

  explicit ProbeAdapter(CollideProbe& probe) : probe_(probe) {}
  void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a, std::uint32_t depth_b) {
    probe_.face_test(a, b, meet, depth_a, depth_b);
  }
  void refine(Side side, RegionId region, std::uint32_t faces_added) {
    probe_.refine(side, region, faces_added);
  }
  void coarsen(Side side, RegionId region, std::uint32_t faces_removed) {
    probe_.coarsen(side, region, faces_removed);
  }
  void contact(SimplexId a, SimplexId b, exact::Meet meet) { probe_.contact(a, b, meet); }
  EventLevel level() const { return probe_.level(); }
  std::uint32_t node_pair(const NodeVisit& visit) { return probe_.node_pair(visit); }
  void plane_test(SimplexId a, SimplexId b, Side whose) { probe_.plane_test(a, b, whose); }
  void tested_by(TestedBy how) { probe_.tested_by(how); }
  void point(Side whose, VertexId v, Where where) { probe_.point(whose, v, where); }
  void begin(Phase phase, std::uint32_t walked_a, std::uint32_t walked_b) {
    probe_.begin(phase, walked_a, walked_b);
  }
  void end(Phase phase, std::uint64_t count) { probe_.end(phase, count); }

 private:
  CollideProbe& probe_;
};

}  // namespace lrb

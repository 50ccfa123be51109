#include "scenarios/record/attempts.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lrb::record {
namespace {

using trace::EventId;

/// Returns the vertices that each region covers, as pairs (vertex, region), ascending.
std::vector<std::pair<VertexId, RegionId>> covered_vertices(const LrbRep& rep) {
  std::vector<std::pair<VertexId, RegionId>> out;
  std::vector<std::uint32_t> seen_with(rep.vertices().size(), kNull);
  for (RegionId r(0); r < rep.region_count(); ++r) {
    // Mark the vertices of the lids first; those of the floor that are left are covered.
    for (const FaceId f : rep.lids(r))
      for (const VertexId v : rep.face(f)) seen_with[v] = r;
    for (const FaceId f : rep.floor(r))
      for (const VertexId v : rep.face(f))
        if (std::exchange(seen_with[v], r) != r) out.emplace_back(v, r);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::vector<Attempt> attempts_of(const trace::Trace& trace) {
  std::vector<Attempt> out;
  if (!trace.header.construction) return out;
  for (EventId i = 0; i < trace.events.size(); ++i) {
    const trace::Event& e = trace.events[i];
    if (e.kind == EventKind::cap) {
      const trace::Event& patch = trace.events[e.cause];
      out.push_back({e.cause, i, patch.patch().vertex, trace.vertices_of(patch), e.cap().verdict, {}});
    } else if (e.kind == EventKind::region && !out.empty() && e.cause == out.back().cap) {
      out.back().regions.push_back(e.region());
    }
  }
  return out;
}

std::vector<std::vector<std::uint32_t>> attempts_by_region(const trace::Trace& trace, const LrbRep& rep,
                                                           std::span<const Attempt> attempts) {
  std::vector<std::vector<std::uint32_t>> out(rep.region_count());
  const auto covered = covered_vertices(rep);
  const auto add = [&](RegionId r, std::uint32_t attempt) {
    if (r < out.size() && (out[r].empty() || out[r].back() != attempt)) out[r].push_back(attempt);
  };
  for (std::uint32_t i = 0; i < attempts.size(); ++i) {
    const Attempt& a = attempts[i];
    // A patch without interior vertices is a whole component: it is not at any place.
    const bool whole = trace.events[a.patch].patch().interior == 0;
    const std::span<const VertexId> start(&a.vertex, whole ? 0 : 1);
    for (const VertexId v : a.vertices.empty() ? start : a.vertices)
      for (auto at = std::lower_bound(covered.begin(), covered.end(), std::pair(v, RegionId(0)));
           at != covered.end() && at->first == v; ++at)
        add(at->second, i);
    for (const RegionId r : a.regions) add(r, i);
  }
  return out;
}

VerdictCounts verdicts_of(std::span<const Attempt> attempts, std::span<const std::uint32_t> indices) {
  VerdictCounts out{};
  for (const std::uint32_t i : indices) ++out[static_cast<std::size_t>(attempts[i].verdict)];
  return out;
}

std::uint32_t rejected(const VerdictCounts& verdicts) {
  return std::accumulate(verdicts.begin() + 1, verdicts.end(), 0u);
}

}  // namespace lrb::record

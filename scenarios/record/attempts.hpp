#pragma once
/// The attempts of a builder to cover parts of the front, from the trace of a construction, and the regions
/// where they were made. Nothing here depends on how the builder finds its caps.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::record {

/// A cap that was tried over a patch of the front.
struct Attempt {
  trace::EventId patch = kNull, cap = kNull;  ///< its events
  VertexId vertex{};                          ///< start vertex of the patch
  /// The vertices that the cap could cover; empty for a whole component, and where they were not recorded.
  std::span<const VertexId> vertices;
  CapVerdict verdict = CapVerdict::accepted;
  std::vector<RegionId> regions;  ///< that it made

  bool rejected() const { return verdict != CapVerdict::accepted; }
};

/// Returns the attempts of a construction in order; empty for other traces. Refers to the trace.
std::vector<Attempt> attempts_of(const trace::Trace& trace);

/// Returns, for each region, the attempts made there, as ascending indices: those that could have covered a
/// vertex that the region covers (its floor has the vertex, its lids do not), and the one that made the
/// region. An attempt whose vertices were not recorded counts at its start vertex.
std::vector<std::vector<std::uint32_t>> attempts_by_region(const trace::Trace& trace, const LrbRep& rep,
                                                           std::span<const Attempt> attempts);

/// Number of attempts by verdict; trace::rejection_text() puts them into words.
using VerdictCounts = std::array<std::uint32_t, kEnumNames<CapVerdict>.size()>;

/// Counts the attempts with these indices by verdict.
VerdictCounts verdicts_of(std::span<const Attempt> attempts, std::span<const std::uint32_t> indices);

/// Returns how many of them are rejected.
std::uint32_t rejected(const VerdictCounts& verdicts);

}  // namespace lrb::record

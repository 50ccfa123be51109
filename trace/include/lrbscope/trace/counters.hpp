#pragma once
/// Computes numbers from a trace's events: totals, statistics, histograms, counts per face (for heat maps)
/// and series (for charts). They cover the events that were stored; Trace::truncated() tells whether that is
/// all of them.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

/// The number of events of each sort. Totals of several steps can be added up.
struct Totals {
  std::uint64_t events = 0;      ///< all kinds; best: few
  std::uint64_t face_tests = 0;  ///< exact comparisons of two simplices; best: no more than contacts
  std::uint64_t hits =
      0;  ///< face tests whose simplices met (touched or crossed); best: no more than contacts
  std::uint64_t crossings = 0;                 ///< hits whose simplices crossed
  std::array<std::uint64_t, 2> refinements{};  ///< of A's and of B's wrapper; best: few
  std::array<std::uint64_t, 2> coarsenings{};
  std::uint64_t faces_added = 0;  ///< by the refinements
  std::uint64_t contacts = 0;     ///< pairs of real simplices that meet: the answer's size
  std::uint64_t node_pairs = 0;   ///< pairs of tree nodes; from EventLevel::nodes on

  friend bool operator==(const Totals&, const Totals&) = default;
};
Totals count_events(std::span<const Event> events);

/// A number that explains itself: reports show name, value, unit and description as they are.
struct Statistic {
  std::string_view name;         ///< snake_case, fixed: files use it
  double value = 0;              ///< NaN where it has no meaning (a ratio to nothing)
  std::string_view unit;         ///< may be empty
  std::string_view description;  ///< formula and best value
};

/// Returns the statistics of a whole run:
/// - tests_per_contact = face tests / contacts; best 1
/// - hit_rate = hits / face tests; best 1
/// - tests_per_refinement = face tests / refinements: how much work opening a region causes
/// - faces_per_refinement = faces added / refinements: the size of the regions opened
/// - contact_rate = contacts / hits; best 1 (0: only lids met)
/// - tests_per_step, refinements_per_step, contacts_per_step: means over time steps
/// - largest_wrapper_share_a (_b) = largest number of faces that A's wrapper had / A's real faces; best near
///   0
/// - pair_share = face tests / (steps x real simplices of A x of B): the share of all pairs that was tested;
///   best near 0
/// - seconds: from the first to the last event; on the wall clock only
std::vector<Statistic> statistics(const Trace& trace);

/// counts[i] is the number of values in [edges[i], edges[i + 1]).
struct Histogram {
  std::string_view name, unit, description;
  std::vector<double> edges;  ///< (|counts| + 1), ascending
  std::vector<std::uint64_t> counts;
};
/// Counts face tests by the depth (number of regions to the outside) of the deeper of the two faces; one bin
/// for each depth.
Histogram tests_by_depth(const Trace& trace);
/// Counts refinements by the number of faces they added; bins double in width: 0, 1, 2-3, 4-7, ...
Histogram refinements_by_size(const Trace& trace);
/// Counts time steps by their number of face tests, in `bins` bins of equal width (the paper's figure 3.2).
Histogram steps_by_tests(const Trace& trace, std::size_t bins = 20);

/// Counts for each face of one body, for heat maps. All (|F|).
struct FaceCounts {
  std::vector<std::uint32_t> tests;   ///< number of tests of the face
  std::vector<std::uint32_t> hits;    ///< number of those in which it met the other face
  std::vector<std::uint32_t> misses;  ///< number of those in which it did not: work that led to nothing
  std::vector<std::uint32_t>
      expansions;  ///< number of those that exact arithmetic decided; from EventLevel::nodes on
  std::vector<std::uint32_t>
      plane_tests;                      ///< number of faces that a plane parted it from; at EventLevel::all
  std::vector<std::uint32_t> contacts;  ///< number of contacts; real faces only
  std::vector<std::uint32_t> refinements;  ///< number of refinements of the region behind a pseudo face, or
                                           ///< of the one that covers a real face
};
/// Counts what happened to each face in `events`. `rep` is the body that was recorded as `side`; its faces
/// must include all that the events name.
FaceCounts count_faces(const LrbRep& rep, Side side, std::span<const Event> events);

/// One curve.
struct Series {
  std::string_view name, unit, description;
  std::vector<double> values;
};
/// Curves over a common axis.
struct Chart {
  std::string_view x_name;
  std::vector<double> x;
  std::vector<Series> series;  ///< each (|x|)
};
/// Returns curves over the events: the number of faces of both wrappers, and the face tests, hits,
/// refinements and contacts of the step so far. Takes about `max_points` events at most, evenly spaced, and
/// always the last one.
Chart chart_over_events(const Trace& trace, std::size_t max_points = 2000);
/// Returns curves over the time steps: face tests, hits, refinements, contacts, largest wrappers and, on the
/// wall clock only, milliseconds.
Chart chart_over_steps(const Trace& trace);

// The passes of a construction in numbers, from its events.

/// One pass. Numbers of faces are those of the hull, a polygon counted once.
struct PassSummary {
  EventId first = kNull, last = kNull;  ///< its first event and its last one that is stored
  BuildStage stage = BuildStage::fit;
  std::uint32_t layer = 0;  ///< of the regions that it made
  float most_off = 0;       ///< how far caps may stand off the body, mesh's unit; 0: as far as they like
  float off = 0;            ///< how far the farthest of them does, as it was measured; 0: nobody measured
  std::uint32_t faces_before = 0, faces_after = 0;
  std::uint32_t regions = 0;  ///< that it made
  std::uint32_t merged = 0;   ///< pieces of space that became part of these
  std::uint32_t patches = 0;
  std::uint32_t retried = 0;  ///< patches whose first cap met something, so that another was made with proofs
  std::array<std::uint32_t, kWords<CapVerdict>.size()> caps{};  ///< patches by the verdict on their last cap
  std::uint32_t lids = 0, covered = 0;                          ///< faces of caps that stand, and under them
  std::uint32_t barred = 0, no_patch = 0, waiting = 0;          ///< see PassEnd
  bool given_up = false;                                        ///< see PassEnd

  std::uint32_t accepted() const { return caps[0]; }
  std::uint32_t refused() const { return patches - accepted(); }
  /// Returns the number that people know it by, from 1 on; passes that made nothing have none.
  std::uint32_t number() const { return layer + 1; }
};

/// Returns the passes of a construction, in order; none for other traces.
std::vector<PassSummary> passes_of(const Trace& trace);

/// Returns the number of faces of the hull over the events, from the body's on: at each event that changes
/// it, and at the last.
Chart chart_over_construction(const Trace& trace);
/// Returns curves over the passes: patches that got a cap, and those that did not by the commonest reasons.
Chart chart_over_passes(const Trace& trace);

/// Returns refusals by their reasons, most frequent first: "9 met the hull, 3 too thick".
std::string refusal_words(const std::array<std::uint32_t, kWords<CapVerdict>.size()>& caps);

/// Returns the number of a pass's caps, or of all passes', by verdict.
std::array<std::uint32_t, kWords<CapVerdict>.size()> caps_of(const std::vector<PassSummary>& passes);

}  // namespace lrb::trace

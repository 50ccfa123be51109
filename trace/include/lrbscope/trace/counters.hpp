#pragma once
/// Computes totals, statistics, histograms, counts per face (heat maps) and series (charts) from a trace's
/// events. Only stored events are covered; Trace::truncated() returns true if some were not stored.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

/// Number of events of each kind. Totals of several steps can be added.
struct Totals {
  std::uint64_t events = 0;      ///< all kinds; best: few
  std::uint64_t face_tests = 0;  ///< exact tests of two simplices; best: no more than contacts
  std::uint64_t hits = 0;  ///< face tests whose simplices touched or crossed; best: no more than contacts
  std::uint64_t crossings = 0;                 ///< hits whose simplices crossed
  std::array<std::uint64_t, 2> refinements{};  ///< of the wrappers of A and B; best: few
  std::array<std::uint64_t, 2> coarsenings{};
  std::uint64_t faces_added = 0;  ///< by the refinements
  std::uint64_t contacts = 0;     ///< intersecting pairs of real simplices: the size of the answer
  std::uint64_t node_pairs = 0;   ///< pairs of tree nodes; EventLevel::nodes and above

  friend bool operator==(const Totals&, const Totals&) = default;
};
Totals count_events(std::span<const Event> events);

/// A number with name, unit and description, which reports show unchanged.
struct Statistic {
  std::string_view name;         ///< snake_case; part of the file format
  double value = 0;              ///< NaN if undefined (division by 0)
  std::string_view unit;         ///< may be empty
  std::string_view description;  ///< formula and best value
};

/// Returns the statistics of a run:
/// - tests_per_contact = face tests / contacts; best 1
/// - hit_rate = hits / face tests; best 1
/// - tests_per_refinement = face tests / refinements: work caused by refining a region
/// - faces_per_refinement = faces added / refinements: size of the refined regions
/// - contact_rate = contacts / hits; best 1 (0: only lids intersected)
/// - tests_per_step, refinements_per_step, contacts_per_step: means over time steps
/// - largest_wrapper_share_a (_b) = maximum faces of A's wrapper / A's real faces; best near 0
/// - pair_share = face tests / (steps x real simplices of A x of B): share of all pairs tested; best near 0
/// - seconds: from the first to the last event; wall clock only
std::vector<Statistic> statistics(const Trace& trace);

/// Returns the time from the first to the last event of a step; NaN on the event clock, or if no event of the
/// step was stored.
double seconds_of_step(const Trace& trace, std::size_t step);

/// counts[i] is the number of values in [edges[i], edges[i + 1]).
struct Histogram {
  std::string_view name, unit, description;
  std::vector<double> edges;  ///< (|counts| + 1), ascending
  std::vector<std::uint64_t> counts;
};
/// Counts face tests by the larger depth (number of regions to the outside) of the two faces. One bin per
/// depth.
Histogram tests_by_depth(const Trace& trace);
/// Counts refinements by the number of faces added. Bins double in width: 0, 1, 2-3, 4-7, ...
Histogram refinements_by_size(const Trace& trace);
/// Counts time steps by number of face tests, in `bins` bins of equal width (figure 3.2 of the paper).
Histogram steps_by_tests(const Trace& trace, std::size_t bins = 20);

/// Counts per face of one body, for heat maps. All arrays have size (|F|).
struct FaceCounts {
  std::vector<std::uint32_t> tests;        ///< tests of the face
  std::vector<std::uint32_t> hits;         ///< tests in which it intersected the other face
  std::vector<std::uint32_t> misses;       ///< tests in which it did not: needless work
  std::vector<std::uint32_t> expansions;   ///< tests decided by exact arithmetic; EventLevel::nodes and above
  std::vector<std::uint32_t> plane_tests;  ///< faces separated from it by a plane; EventLevel::all
  std::vector<std::uint32_t> contacts;     ///< contacts; real faces only
  std::vector<std::uint32_t> refinements;  ///< refinements of the region behind a pseudo face, or of the
                                           ///< region that covers a real face
};
/// Counts events per face. `rep` is the body recorded as `side`; all faces named in `events` must be its
/// faces.
FaceCounts count_faces(const LrbRep& rep, Side side, std::span<const Event> events);

/// One curve.
struct Series {
  std::string_view name, unit, description;
  std::vector<double> values;
};
/// Curves over a common x axis.
struct Chart {
  std::string_view x_name;
  std::vector<double> x;
  std::vector<Series> series;  ///< each (|x|)
};
/// Returns curves over the events: faces of both wrappers, and the face tests, hits, refinements and contacts
/// of the step so far. Samples at most about `max_points` events, evenly spaced, including the last.
Chart chart_over_events(const Trace& trace, std::size_t max_points = 2000);
/// Returns curves over the time steps: face tests, hits, refinements, contacts, largest wrappers and, on the
/// wall clock only, milliseconds.
Chart chart_over_steps(const Trace& trace);

// Statistics of the passes of a construction, computed from its events.

/// One pass. Face counts refer to the front; a polygon counts once.
struct PassSummary {
  EventId first = kNull, last = kNull;  ///< its first event and its last stored event
  BuildStage stage = BuildStage::fit;
  std::uint32_t layer = 0;  ///< of the regions it made
  float max_deviation = 0;  ///< maximum deviation allowed for caps, mesh units; 0: unlimited
  float deviation = 0;      ///< maximum measured deviation of its caps; 0: not measured
  std::uint32_t faces_before = 0, faces_after = 0;
  std::uint32_t regions = 0;  ///< number of regions made
  std::uint32_t merged = 0;   ///< pieces merged into them
  std::uint32_t patches = 0;
  std::uint32_t retried = 0;  ///< patches whose first cap intersected something, so that a second was built
                              ///< with checks per collapse
  std::array<std::uint32_t, kEnumNames<CapVerdict>.size()>
      caps{};                                             ///< patches by the verdict on their last cap
  std::uint32_t lids = 0, covered = 0;                    ///< faces of accepted caps, and faces under them
  std::uint32_t excluded = 0, no_patch = 0, waiting = 0;  ///< see PassEnd
  bool given_up = false;                                  ///< see PassEnd

  std::uint32_t accepted() const { return caps[0]; }
  std::uint32_t rejected() const { return patches - accepted(); }
  /// Returns the number shown to users, from 1. Only for passes that made regions.
  std::uint32_t number() const { return layer + 1; }
};

/// Returns the passes of a construction in order. Empty for other traces.
std::vector<PassSummary> passes_of(const Trace& trace);

/// Returns the number of faces of the front over the events, starting with the body itself: at each event
/// that changes it, and at the last one.
Chart chart_over_construction(const Trace& trace);
/// Returns curves over the passes: patches with an accepted cap, and rejected patches by the most frequent
/// reasons.
Chart chart_over_passes(const Trace& trace);

/// Returns a verdict in the words of pages and pictures: "accepted", "met the front". The names in files are
/// older.
std::string_view text_of(CapVerdict verdict);
/// Returns the reasons for rejection, most frequent first: "9 met the front, 3 too thick".
std::string rejection_text(const std::array<std::uint32_t, kEnumNames<CapVerdict>.size()>& caps);

/// Returns the number of caps by verdict, over all given passes.
std::array<std::uint32_t, kEnumNames<CapVerdict>.size()> caps_of(const std::vector<PassSummary>& passes);

}  // namespace lrb::trace

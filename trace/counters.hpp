#pragma once
/// Numbers from events: totals, statistics, histograms, counts per face (heat maps) and series (charts). All
/// are of the events stored; Trace::truncated() says if that is not everything.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trace/trace.hpp"

namespace lrb::trace {

/// How many events of each sort. All add up over steps.
struct Totals {
  std::uint64_t events = 0;      ///< all kinds; best: few
  std::uint64_t face_tests = 0;  ///< exact comparisons of two simplices; best: as many as contacts
  std::uint64_t hits = 0;        ///< of these, they met (touch or cross); best: as many as contacts
  std::uint64_t crossings = 0;   ///< of the hits, they crossed
  std::array<std::uint64_t, 2> refinements{};  ///< of A's and of B's wrapper; best: few
  std::array<std::uint64_t, 2> coarsenings{};
  std::uint64_t faces_added = 0;  ///< by the refinements
  std::uint64_t contacts = 0;     ///< pairs of real simplices that meet: the answer's size

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

/// Of a whole run:
/// - tests_per_contact = face tests / contacts; best 1
/// - hit_rate = hits / face tests; best 1
/// - tests_per_refinement = face tests / refinements; how much work opening a region causes
/// - faces_per_refinement = faces added / refinements; the size of the regions opened
/// - contact_rate = contacts / hits; best 1 (0: only lids met)
/// - tests_per_step, refinements_per_step, contacts_per_step: means over time steps
/// - largest_wrapper_share_a (_b) = most faces A's wrapper had / A's real faces; best: near 0
/// - pair_share = face tests / (steps x real simplices of A x of B): against testing all pairs; best: near 0
/// - seconds: wall clock only, first to last event
std::vector<Statistic> statistics(const Trace& trace);

/// counts[i] is the number of values in [edges[i], edges[i + 1]).
struct Histogram {
  std::string_view name, unit, description;
  std::vector<double> edges;  ///< (|counts| + 1), ascending
  std::vector<std::uint64_t> counts;
};
/// Face tests by the depth (regions to the outside) of the deeper of the two faces; one bin a depth.
Histogram tests_by_depth(const Trace& trace);
/// Refinements by the number of faces they added; bins double in width: 0, 1, 2-3, 4-7, ...
Histogram refinements_by_size(const Trace& trace);
/// Time steps by their number of face tests, `bins` of equal width (the paper's figure 3.2).
Histogram steps_by_tests(const Trace& trace, std::size_t bins = 20);

/// Counts per face of one body, for heat maps. All (|F|).
struct FaceCounts {
  std::vector<std::uint32_t> tests;        ///< face tests of the face
  std::vector<std::uint32_t> hits;         ///< of these, it met the other
  std::vector<std::uint32_t> contacts;     ///< real faces: contacts
  std::vector<std::uint32_t> refinements;  ///< how often the region behind a pseudo face, or the one that
                                           ///< covers a real face, was refined
};
/// Of the events [first, last). `rep` is the body that was recorded as `side`; events must be in its range.
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
/// Over events: faces of both wrappers, and face tests, hits, refinements and contacts of the step so far. At
/// most about `max_points` points, evenly spaced, the last event always.
Chart chart_over_events(const Trace& trace, std::size_t max_points = 2000);
/// Over time steps: face tests, hits, refinements, contacts, largest wrappers, and milliseconds (wall clock
/// only).
Chart chart_over_steps(const Trace& trace);

}  // namespace lrb::trace

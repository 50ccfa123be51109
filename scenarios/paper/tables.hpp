#pragma once
/// The paper's tables 1 and 2: as published, and as measured.

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/paper/sweep.hpp"
#include <lrbscope/render/overlay.hpp>

namespace lrb::paper {

// Formats numbers for the reports.

inline std::string whole(double x) {
  return (x < 0 ? "-" : "") + render::group_digits(static_cast<std::uint64_t>(std::llround(std::abs(x))));
}

/// Writes `digits` digits after the point; those before it in groups of three.
inline std::string fixed(double x, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << std::abs(x);
  const std::string text = out.str();
  const std::size_t point = std::min(text.find('.'), text.size());
  return (x < 0 ? "-" : "") + render::group_digits(std::stoull(text.substr(0, point))) + text.substr(point);
}

inline constexpr PerRecursion<const char*> kRecursionTitles = {
    "the paper's recursion, each pair of regions once", "the paper's recursion, each region once (strict)",
    "the paper's recursion, against the whole wrapper", "complete"};

struct Spread {
  double min = 0, average = 0, max = 0;
};

/// The cost of one recursion against one object, over all counted time steps.
struct RecursionRow {
  Spread comparisons, triangles, refinements;
  double bound_tests = 0;  ///< average number
  std::uint64_t pairs = 0, missed = 0;
};

/// Returns the share of pairs of real triangles that were not found, in percent.
inline double missed_percent(const RecursionRow& x) {
  const std::uint64_t all = x.pairs + x.missed;
  return all > 0 ? 100 * static_cast<double>(x.missed) / static_cast<double>(all) : 0;
}

/// Returns it as text; a dash without pairs.
inline std::string missed_text(const RecursionRow& x) {
  return x.pairs + x.missed > 0 ? fixed(missed_percent(x), 2) + " %" : "–";
}

struct ObjectRow {
  std::string object;
  std::uint32_t real_faces = 0, total_faces = 0;
  std::uint64_t steps = 0;  ///< number of counted time steps
  PerRecursion<RecursionRow> recursions;
  double n_log_n = 0, n_squared = 0;  ///< the paper's estimates: total(X) log2(total(A)), total(A) total(X)
};

/// Returns a row for each object but the first, which collides with the others.
std::vector<ObjectRow> make_table(std::span<const PaperObject> objects, std::span<const ContactStep> steps);

/// A row of the paper's table 2. (Its table 1 is paper_objects().)
struct PublishedRow {
  const char* object;
  double min, average, max;
};
std::span<const PublishedRow> published_table2();
inline constexpr std::array kPublished = {&PublishedRow::min, &PublishedRow::average, &PublishedRow::max};
inline constexpr std::array kMeasured = {&Spread::min, &Spread::average, &Spread::max};
/// Returns the row of an object; null if the paper does not have it.
const PublishedRow* published(const std::string& object);

/// Returns true if these are objects of the paper, with its numbers of faces.
bool as_published(std::span<const PaperObject> objects);

/// Table 2 of one seed, time step and number of steps.
struct Run {
  PaperProtocol protocol;
  std::vector<ObjectRow> rows;
};
/// Returns a run for each seed of the protocol.
std::vector<Run> runs_of_seeds(std::span<const PaperObject> objects, std::span<const ContactStep> steps,
                               const PaperProtocol& protocol);
/// Returns a run for each of other_settings() and for half, once and twice the steps after first contact.
std::vector<Run> runs_of_settings(std::span<const PaperObject> objects, std::span<const ContactStep> steps,
                                  const PaperProtocol& protocol);

struct Band {
  double median = 0, low = 0, high = 0;
};
/// Returns zeros for no values.
Band band_of(std::vector<double> values);

/// Ratios of the measured minimum, average and maximum, by the paper's recursion, to the published ones.
using RatioBands = std::array<Band, 3>;
inline constexpr std::array<const char*, 3> kRatioNames = {"minimum", "average", "maximum"};
/// Over the runs, for one object that is published, or for all of them.
RatioBands ratios(std::span<const Run> runs, const std::string& object = {});

// As CSV, with numbers in full.

std::string table1_csv(std::span<const PaperObject> objects);
/// A line for each run, object and recursion.
std::string table2_csv(std::span<const Run> runs);

/// Returns both tables as JSON: "table1_object_sizes", and "table2_face_comparisons_of_object_A_with" by the
/// paper's recursion with the first seed; for the other recursions the same with their names as suffixes;
/// for published objects also "ratio_to_published", over the seeds.
std::string tables_json(std::span<const PaperObject> objects, std::span<const Run> runs,
                        const PaperProtocol& protocol);

}  // namespace lrb::paper

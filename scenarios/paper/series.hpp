#pragma once
/// Runs the paper's experiment on bodies at several resolutions, to measure the growth of comparisons and
/// time with size.
///
/// Every resolution collides twice: with the paper's object A, as the paper's other objects do, so that one
/// side grows; and with itself, so that both grow. All resolutions of a body get the same directions and
/// rotations. The report has tables, fitted exponents and charts of the series.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/bodies/resolutions.hpp"
#include "scenarios/paper/tables.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::resolutions {

/// A fit y = factor x^exponent.
struct PowerFit {
  double exponent = 0;
  double error = 0;  ///< standard error of the exponent; 0 for fewer than three points
  double factor = 0;
};

/// Fits a straight line to the logarithms by least squares. x and y must be positive and of equal length,
/// with at least two different x.
PowerFit fit_power(std::span<const double> x, std::span<const double> y);

}  // namespace lrb::resolutions

namespace lrb::paper {

/// A body at one resolution, scaled to A's diagonal.
struct SeriesObject {
  std::string body;  ///< the mesh's name
  LrbRep rep;
};

enum class SeriesPartner { a, itself };
inline constexpr std::array<SeriesPartner, 2> kSeriesPartners = {SeriesPartner::a, SeriesPartner::itself};

/// Returns the name of a resolution's collisions in the records.
std::string series_name(const SeriesObject& object, SeriesPartner partner);

/// Generates two bodies at high resolution, for users without meshes.
std::vector<Mesh> own_series_bodies();
/// Reads meshes from the files and folders in `paths`; each is named after its file, without the extension.
/// Skips, with a note that gives the reason, each mesh that no LRB-rep can be built of. Throws InputError if
/// no mesh is left, or if two have the same name.
std::vector<Mesh> read_series_bodies(const std::vector<std::string>& paths, std::vector<std::string>& notes);

/// Returns the bodies in order, the finest resolution of each first, scaled to this diagonal; calls
/// `progress` for each.
std::vector<SeriesObject> make_series(std::span<const Mesh> bodies,
                                      const resolutions::ResolutionOptions& options,
                                      const BuildOptions& building, double diagonal,
                                      const std::function<void(const LrbRep&)>& progress);

/// Runs all collisions of the shard, with the first seed; returns them in the order of sorted().
std::vector<ContactStep> run_series(const LrbRep& a, std::span<const SeriesObject> objects,
                                    const SweepOptions& options);

/// One resolution against one partner.
struct SeriesRow {
  std::string body;
  SeriesPartner partner;
  std::size_t outer_faces;
  ObjectRow counts;
  PerRecursion<double> microseconds;  ///< median of a query's duration
};
/// Returns the rows, by partner, then by object. Throws InputError for steps of other objects.
std::vector<SeriesRow> series_rows(const LrbRep& a, std::span<const SeriesObject> objects,
                                   std::span<const ContactStep> steps);

struct SeriesReport {
  const LrbRep& a;
  std::span<const SeriesObject> objects;
  std::span<const ContactStep> steps;
  std::uint32_t jobs = 1;  ///< number of threads during the measurement of times
};

/// The growth of one recursion's work with a body's faces, real and pseudo, against one partner. Empty if
/// fewer than two resolutions have contacts.
struct SeriesFit {
  std::string body;
  SeriesPartner partner;
  std::size_t recursion;  ///< index into kRecursions
  std::optional<resolutions::PowerFit> comparisons, refinements, microseconds;
};
std::vector<SeriesFit> series_fits(std::span<const SeriesRow> rows);

/// Adds charts, on the page and for print (series-comparisons, series-time), series.jsonl (records),
/// series_times.jsonl and series.json (rows and fits, without times). Returns the tables.
std::vector<report::Table> add_series(const SeriesReport& report, report::Document& doc);

/// Returns the tests of queries on LRB-reps, and of the default, at first contact of each body with itself in
/// at most kAcceleratorCollisions collisions. Calls `progress` after each body, on this one thread.
inline constexpr std::uint32_t kAcceleratorCollisions = 10;
report::Table accelerator_table(std::span<const Mesh> bodies, const PaperProtocol& protocol,
                                const BuildOptions& building,
                                const std::function<void(const Mesh&)>& progress);

/// Returns a fitted power as text, such as "n^0.52 ± 0.01".
std::string power_text(const resolutions::PowerFit& fit);

}  // namespace lrb::paper

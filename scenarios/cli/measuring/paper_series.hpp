#pragma once
/// The series of `lrbscope paper`: reads its options and runs it.

#include "scenarios/cli/command.hpp"
#include "scenarios/paper/series.hpp"

namespace lrb::cli {

struct PaperSeriesOptions {
  std::vector<std::string> meshes;
  resolutions::ResolutionOptions resolutions;  ///< most = 0: no series
  bool lean = false;
};
void add_series_options(CLI::App& app, PaperSeriesOptions& options);

/// Makes the bodies from the given meshes, or our own; A is the paper's object.
std::vector<paper::SeriesObject> make_series(const PaperSeriesOptions& options, const LrbRep& a,
                                             const Globals& globals);
/// Runs the collisions.
std::vector<paper::ContactStep> run_series(const LrbRep& a, std::span<const paper::SeriesObject> objects,
                                           const paper::SweepOptions& sweep, const Globals& globals);

/// Writes a shard's series, to be merged later: series.jsonl and series_times.jsonl.
void write_series_shard(const std::vector<paper::ContactStep>& steps, const std::string& folder);
/// Reads those that lie beside the records.jsonl of the shards.
std::vector<paper::ContactStep> read_series_shards(const std::vector<std::string>& records);

}  // namespace lrb::cli

#pragma once
/// Tells what a shard is a part of, so that merging notices shards that are missing or of another experiment.

#include <string>
#include <vector>

#include "scenarios/bodies/resolutions/resolutions.hpp"
#include "scenarios/paper/sweep.hpp"

namespace lrb::paper {

struct ShardFile {
  Shard shard;
  PaperProtocol protocol;
  resolutions::ResolutionOptions resolutions;  ///< of the series; most = 0: there is none
  bool lean = false;                           ///< the series' bodies are built lean (BuildOptions)
};

/// Returns its path: beside the records.jsonl of the shard.
std::string shard_file_of(const std::string& records);

void write_shard_file(const ShardFile& shard, const std::string& folder);

/// Reads the files beside these records.jsonl and returns the experiment that all are parts of, as shard 0/1.
/// Throws InputError if one is missing or of another experiment, or if they are not all n shards, once each.
ShardFile read_shard_files(const std::vector<std::string>& records);

}  // namespace lrb::paper

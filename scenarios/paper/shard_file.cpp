#include "scenarios/paper/shard_file.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/files.hpp"

namespace lrb::paper {
namespace {

/// Returns what shards of one experiment have in common.
nlohmann::ordered_json experiment(const ShardFile& s) {
  return {{"shards", s.shard.count},
          {"collisions", s.protocol.collisions},
          {"time_step_of_diagonal", s.protocol.step},
          {"steps_after_first_contact", s.protocol.steps_after},
          {"seed", s.protocol.seed},
          {"resolutions", s.resolutions.most},
          {"subdivisions", s.resolutions.subdivisions},
          {"lean", s.lean}};
}

ShardFile read(const std::string& path) {
  try {
    const auto j = nlohmann::json::parse(io::read_text(path));
    ShardFile s;
    s.shard = {j.at("shard").get<std::uint32_t>(), j.at("shards").get<std::uint32_t>()};
    s.protocol.collisions = j.at("collisions").get<std::uint32_t>();
    s.protocol.step = j.at("time_step_of_diagonal").get<double>();
    s.protocol.steps_after = j.at("steps_after_first_contact").get<std::uint32_t>();
    s.protocol.seed = j.at("seed").get<std::uint64_t>();
    s.resolutions.most = j.at("resolutions").get<std::uint32_t>();
    s.resolutions.subdivisions = j.at("subdivisions").get<std::uint32_t>();
    s.lean = j.value("lean", false);
    return s;
  } catch (const nlohmann::json::exception& e) {
    throw InputError(printable_name(path) +
                     ": not written by `lrbscope paper --shard`: " + printable_name(e.what()) +
                     "; give the records.jsonl in the folders that its shards wrote");
  }
}

}  // namespace

std::string shard_file_of(const std::string& records) {
  return (std::filesystem::path(records).parent_path() / "shard.json").string();
}

void write_shard_file(const ShardFile& shard, const std::string& folder) {
  nlohmann::ordered_json j = {{"shard", shard.shard.index}};
  j.update(experiment(shard));
  io::write_text(folder + "/shard.json", j.dump(2) + "\n");
}

ShardFile read_shard_files(const std::vector<std::string>& records) {
  std::optional<ShardFile> first;
  std::vector<std::uint32_t> there;
  for (const std::string& file : records) {
    const std::string path = shard_file_of(file);
    const ShardFile s = read(path);
    if (!first) first = s;
    if (experiment(s) != experiment(*first))
      throw InputError(printable_name(path) + ": a shard of another experiment than " +
                       printable_name(shard_file_of(records.front())) +
                       "; give all shards of one, run with the same options");
    there.push_back(s.shard.index);
  }
  std::sort(there.begin(), there.end());
  for (std::uint32_t i = 0; i < first->shard.count; ++i) {
    const auto times = std::count(there.begin(), there.end(), i);
    if (times != 1)
      throw InputError("--merge: shard " + std::to_string(i) + "/" + std::to_string(first->shard.count) +
                       (times == 0 ? " is missing" : " is there twice") +
                       "; give each shard's records.jsonl once");
  }
  first->shard = {};
  return *first;
}

}  // namespace lrb::paper

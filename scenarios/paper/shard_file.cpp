#include "scenarios/paper/shard_file.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/json/record_json.hpp"
#include "scenarios/paper/fields.hpp"

namespace lrb::paper {
namespace {

/// Returns what shards of one experiment have in common.
nlohmann::ordered_json experiment(const ShardFile& s) {
  nlohmann::ordered_json out = {{"shards", s.shard.count}};
  out.update(io::record_to_json(s.protocol));
  out.update(io::record_to_json(s.resolutions));
  out["lean"] = s.lean;
  return out;
}

ShardFile read(const std::string& path) {
  const auto refuse = [&](const char* why) {
    throw InputError(printable_name(path) + ": not written by `lrbscope paper --shard`: " +
                     printable_name(why) + "; give the records.jsonl in the folders that its shards wrote");
  };
  const auto j = nlohmann::json::parse(io::read_text(path), nullptr, false);
  ShardFile s;
  try {
    s.shard = {j.at("shard").get<std::uint32_t>(), j.at("shards").get<std::uint32_t>()};
    s.protocol = io::record_from_json<PaperProtocol>(j);
    s.resolutions = io::record_from_json<resolutions::ResolutionOptions>(j);
    s.lean = j.value("lean", false);
  } catch (const nlohmann::json::exception& e) {
    refuse(e.what());
  } catch (const InputError& e) {
    refuse(e.what());
  }
  return s;
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

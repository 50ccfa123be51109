#include "scenarios/paper/sweep.hpp"

#include <mutex>
#include <tuple>

#include <nlohmann/json.hpp>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "engine/core/parallel.hpp"
#include "engine/query/walk/query_context.hpp"
#include "scenarios/io/json/record_json.hpp"
#include "scenarios/paper/fields.hpp"
#include "trace/names.hpp"

namespace lrb::paper {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json to_json(const ContactStep& s) {
  ordered_json j = {
      {"object", s.object}, {"collision", s.collision}, {"step", s.step}, {"relation", name_of(s.relation)}};
  for (std::size_t i = 0; i < kRecursions.size(); ++i) {
    j[std::string(name_of(kRecursions[i]))] = io::record_to_json(s.counts[i]);
  }
  return j;
}

ContactStep from_json(const json& j) {
  ContactStep s;
  s.object = j.at("object").get<std::string>();
  s.collision = j.at("collision").get<std::uint32_t>();
  s.step = j.at("step").get<std::uint32_t>();
  s.relation = io::JsonOf<Relation>::read(j.at("relation"));
  for (std::size_t i = 0; i < kRecursions.size(); ++i) {
    s.counts[i] = io::record_from_json<RecursionCount>(j.at(std::string(name_of(kRecursions[i]))));
  }
  return s;
}

}  // namespace

std::vector<ContactStep> run_sweep(std::span<const PaperObject> objects, const SweepOptions& options,
                                   const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  std::vector<std::pair<std::size_t, std::uint32_t>> tasks;  // object, collision
  std::uint64_t number = 0;
  for (std::size_t k = 1; k < objects.size(); ++k)
    for (std::uint32_t c = 0; c < options.protocol.collisions; ++c)
      if (number++ % options.shard.count == options.shard.index) tasks.emplace_back(k, c);

  std::vector<std::vector<ContactStep>> found(tasks.size());
  Workers workers(options.jobs);
  std::vector<QueryContext> contexts(workers.count());
  std::mutex one_at_a_time;
  std::uint64_t done = 0;
  workers.for_each(tasks.size(), [&](std::size_t i, unsigned worker) {
    const PaperObject& x = objects[tasks[i].first];
    found[i] = run_collision(objects[0].rep, x.rep, x.draws.empty() ? x.name : x.draws, tasks[i].second,
                             options.protocol, contexts[worker]);
    for (ContactStep& s : found[i]) s.object = x.name;
    const std::lock_guard lock(one_at_a_time);
    if (progress) progress(++done, tasks.size());
  });
  std::vector<ContactStep> steps;
  for (auto& part : found) std::move(part.begin(), part.end(), std::back_inserter(steps));
  return steps;
}

std::string to_json_lines(std::span<const ContactStep> steps) {
  std::string out;
  for (const ContactStep& s : steps) out += to_json(s).dump() + "\n";
  return out;
}

std::vector<ContactStep> read_json_lines(const std::string& text, const std::string& file) {
  std::vector<ContactStep> steps;
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    try {
      steps.push_back(from_json(json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                            text.begin() + static_cast<std::ptrdiff_t>(end))));
    } catch (const std::exception& e) {
      throw InputError(printable_name(file) + ":" + std::to_string(line) +
                       ": not a record of `lrbscope paper`: " + printable_name(e.what()) +
                       "; give the records.jsonl files that its shards wrote");
    }
    begin = end + 1;
  }
  return steps;
}

std::vector<ContactStep> merged(std::vector<ContactStep> steps) {
  const auto key = [](const ContactStep& s) { return std::tie(s.object, s.collision, s.step); };
  std::sort(steps.begin(), steps.end(), [&](const auto& x, const auto& y) { return key(x) < key(y); });
  for (std::size_t i = 1; i < steps.size(); ++i)
    if (key(steps[i - 1]) == key(steps[i]))
      throw InputError("object " + steps[i].object + ", collision " + std::to_string(steps[i].collision) +
                       ", step " + std::to_string(steps[i].step) +
                       " is there twice; give each shard's records once");
  return steps;
}

}  // namespace lrb::paper

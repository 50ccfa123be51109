#include "scenarios/paper/sweep.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <tuple>

#include <nlohmann/json.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/paper/experiment.hpp"
#include "trace/json_records.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/recorder.hpp>

namespace lrb::paper {

std::array<std::uint32_t, 2> easiest_and_hardest(std::span<const ContactStep> steps,
                                                 const std::string& object) {
  std::map<std::uint32_t, std::uint64_t> comparisons;
  for (const ContactStep& s : steps)
    if (s.object == object) comparisons[s.collision] += s.counts[kPaper].comparisons;
  if (comparisons.empty())
    throw InputError("no collision with " + object + " was recorded, so there is no close-up");
  const auto less = [](const auto& p, const auto& q) { return p.second < q.second; };
  return {std::min_element(comparisons.begin(), comparisons.end(), less)->first,
          std::max_element(comparisons.begin(), comparisons.end(), less)->first};
}

CloseUp close_up(const PaperPair& pair, std::uint32_t collision, const PaperProtocol& protocol) {
  Workspace workspace;
  CloseUp out;
  out.collision = collision;
  out.steps = run_collision(pair.a.rep, pair.x.rep, pair.x.name, collision, protocol, workspace);
  trace::RecorderSettings settings;
  settings.request.recursion = kRecursions[kPaper];
  trace::Recorder recorder(pair.a.rep, pair.x.rep, settings);
  for (const ContactStep& s : out.steps) {
    recorder.begin_step(s.step, s.pose_a, s.pose_x);
    recorder.end_step(
        collide(pair.a.rep, s.pose_a, pair.x.rep, s.pose_x, settings.request, workspace, &recorder).value());
    out.comparisons += s.counts[kPaper].comparisons;
  }
  out.trace = recorder.take();
  return out;
}

std::string head_of(const KeptRun& run, std::span<const PaperObject> objects) {
  nlohmann::ordered_json head = {
      {"lrbscope", trace::lrbscope_version()}, {"shard", run.shard.index}, {"shards", run.shard.count}};
  head.update(io::record_to_json(run.protocol));
  head.update(io::record_to_json(run.resolutions));
  head["lean"] = run.lean;
  for (const PaperObject& o : objects) head["objects"].push_back(o.name + " " + trace::to_hex(o.rep.hash()));
  return head.dump();
}

std::optional<KeptCollision> kept_collision(const std::string& line) {
  const auto value = nlohmann::json::parse(line, nullptr, false);
  KeptCollision out;
  for (const auto& [name, text] : {std::pair{"collision", &out.key}, std::pair{"records", &out.records}}) {
    if (!value.is_object() || !value.contains(name) || !value[name].is_string()) return std::nullopt;
    *text = value[name].get<std::string>();
    if (text->empty()) return std::nullopt;
  }
  return out;
}

std::pair<KeptRun, std::vector<KeptCollision>> read_shards(const std::vector<std::string>& files) {
  std::pair<KeptRun, std::vector<KeptCollision>> out;
  auto& [whole, collisions] = out;
  nlohmann::json first;
  std::vector<std::uint32_t> there;
  for (const std::string& file : files) {
    std::istringstream in(io::read_text(file));
    std::string line;
    std::getline(in, line);
    auto head = nlohmann::json::parse(line, nullptr, false);
    try {
      there.push_back(head.at("shard").get<std::uint32_t>());
      whole = {{0, head.at("shards").get<std::uint32_t>()},
               io::record_from_json<PaperProtocol>(head),
               io::record_from_json<resolutions::ResolutionOptions>(head),
               head.at("lean").get<bool>()};
    } catch (const std::exception& e) {
      throw InputError(printable_name(file) +
                       ": not written by `lrbscope paper --shard`: " + io::plain_reason(e.what()) +
                       "; give the collisions.jsonl of its shards' output folders");
    }
    if (head.value("lrbscope", nlohmann::json()) != trace::lrbscope_version())
      throw InputError(printable_name(file) + ": expected a shard of lrbscope " + trace::lrbscope_version() +
                       "; run it again");
    head.erase("shard");
    if (there.size() == 1) first = head;
    if (head != first)
      throw InputError(printable_name(file) + ": belongs to another experiment than " +
                       printable_name(files.front()) +
                       "; give all shards of one experiment, run with the same options by the same version");
    for (std::size_t number = 2; std::getline(in, line); ++number) {
      auto kept = kept_collision(line);
      if (!kept)
        throw InputError(printable_name(file) + ":" + std::to_string(number) +
                         ": expected a collision with its records; run this shard again");
      collisions.push_back(std::move(*kept));
    }
  }
  for (std::uint32_t i = 0; i < whole.shard.count; ++i) {
    const auto times = std::count(there.begin(), there.end(), i);
    if (times != 1)
      throw InputError("--merge: shard " + std::to_string(i) + "/" + std::to_string(whole.shard.count) +
                       (times == 0 ? " is missing" : " occurs twice") +
                       "; give each shard's collisions.jsonl once");
  }
  whole.shard = {};
  return out;
}

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json to_json(const ContactStep& s, bool times) {
  ordered_json j = {{"seed", s.seed},     {"time_step", s.time_step},
                    {"object", s.object}, {"collision", s.collision},
                    {"step", s.step},     {"relation", name_of(s.relation)}};
  for (std::size_t i = 0; i < kRecursions.size(); ++i) {
    j[std::string(name_of(kRecursions[i]))] = io::record_to_json(s.counts[i]);
    if (times) j["nanoseconds"].push_back(s.counts[i].nanoseconds);
  }
  return j;
}

ContactStep from_json(const json& j) {
  ContactStep s;
  s.seed = j.at("seed").get<std::uint64_t>();
  s.time_step = j.at("time_step").get<double>();
  s.object = j.at("object").get<std::string>();
  s.collision = j.at("collision").get<std::uint32_t>();
  s.step = j.at("step").get<std::uint32_t>();
  s.relation = io::JsonOf<Relation>::read(j.at("relation"));
  for (std::size_t i = 0; i < kRecursions.size(); ++i) {
    const std::string name(name_of(kRecursions[i]));
    s.counts[i] = io::record_from_json<RecursionCount>(j.at(name));
    if (j.contains("nanoseconds")) s.counts[i].nanoseconds = j.at("nanoseconds").at(i).get<std::uint64_t>();
  }
  return s;
}

}  // namespace

std::vector<ContactStep> run(const CollisionTask& task, Workspace& workspace) {
  const PaperObject& x = task.x;
  std::vector<ContactStep> steps =
      run_collision(task.a.rep, x.rep, x.draws.empty() ? x.name : x.draws, task.collision, task.protocol,
                    workspace, task.scalable_only);
  for (ContactStep& s : steps) s.object = x.name;
  return steps;
}

std::vector<ContactStep> run_sweep(std::span<const PaperObject> objects, const SweepOptions& options) {
  std::vector<std::pair<std::size_t, std::uint32_t>> tasks;  // object, collision
  std::uint64_t number = 0;
  for (std::size_t k = 1; k < objects.size(); ++k)
    for (std::uint32_t c = 0; c < options.protocol.collisions; ++c)
      if (number++ % options.shard.count == options.shard.index) tasks.emplace_back(k, c);

  std::vector<std::vector<ContactStep>> found(tasks.size());
  Workers workers(options.jobs);
  std::vector<Workspace> workspaces(workers.count());
  workers.for_each(tasks.size(), [&](std::size_t i, unsigned worker) {
    found[i] = options.runner(
        {objects[0], objects[tasks[i].first], options.protocol, tasks[i].second, options.scalable_only},
        workspaces[worker]);
  });
  std::vector<ContactStep> steps;
  for (auto& part : found) std::move(part.begin(), part.end(), std::back_inserter(steps));
  return steps;
}

std::vector<ContactStep> run_seeds(std::span<const PaperObject> objects, const SweepOptions& options) {
  std::vector<ContactStep> steps;
  SweepOptions one = options;
  for (std::uint32_t i = 0; i < options.protocol.seeds; ++i, ++one.protocol.seed) {
    one.scalable_only = i > 0;  // only table 2 is made of all seeds
    for (ContactStep& s : run_sweep(objects, one)) steps.push_back(std::move(s));
  }
  return steps;
}

std::vector<PaperProtocol> other_settings(const PaperProtocol& protocol) {
  std::vector<PaperProtocol> out;
  for (const double factor : {0.5, 1.0, 2.0, 4.0}) {
    PaperProtocol p = protocol;
    p.step *= factor;
    p.steps_after = std::min(2 * p.steps_after, kMaxStepsAfter);
    p.seeds = 1;
    if (p.step >= kMinStep && p.step <= kMaxStep) out.push_back(p);
  }
  return out;
}

std::string to_json_lines(std::span<const ContactStep> steps, bool times) {
  std::string out;
  for (const ContactStep& s : steps) out += to_json(s, times).dump() + "\n";
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
                       ": not a record of `lrbscope paper`: " + io::plain_reason(e.what()));
    }
    begin = end + 1;
  }
  return steps;
}

std::vector<ContactStep> sorted(std::vector<ContactStep> steps) {
  const auto key = [](const ContactStep& s) {
    return std::tie(s.seed, s.time_step, s.object, s.collision, s.step);
  };
  std::sort(steps.begin(), steps.end(), [&](const auto& x, const auto& y) { return key(x) < key(y); });
  return steps;
}

}  // namespace lrb::paper

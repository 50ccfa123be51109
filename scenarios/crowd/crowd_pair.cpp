#include "scenarios/crowd/crowd_pair.hpp"

#include <algorithm>
#include <filesystem>

#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::crowd {
namespace {

std::uint32_t find_body(const std::vector<std::string>& names, const std::string& name,
                        const std::string& file) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw InputError("--pair: " + file + " has no body " + printable_name(name) +
                     "; its bodies are named by kind and number, from " + names.front() + " to " +
                     names.back());
  return static_cast<std::uint32_t>(at - names.begin());
}

const spec::CrowdKind& kind_of(const spec::Crowd& crowd, std::uint32_t body) {
  std::size_t kind = 0;
  for (; body >= crowd.kinds[kind].count; ++kind) body -= crowd.kinds[kind].count;
  return crowd.kinds[kind];
}

}  // namespace

BodyPair find_pair(const CrowdTrace& trace, const std::string& names) {
  const std::size_t comma = names.find(',');
  if (comma == std::string::npos || names.find(',', comma + 1) != std::string::npos)
    throw InputError("--pair: expected the names of two bodies, such as \"gear 3,rock 5\", found " +
                     printable_name(names));
  const std::vector<std::string> all = body_names(trace.crowd);
  const std::uint32_t i = find_body(all, names.substr(0, comma), trace.file);
  const std::uint32_t j = find_body(all, names.substr(comma + 1), trace.file);
  if (i == j) throw InputError("--pair: expected two bodies, found " + all[i] + " twice");
  return {std::min(i, j), std::max(i, j)};
}

spec::Scenario scenario_of_pair(const CrowdTrace& trace, const BodyPair& pair, const std::string& path) {
  spec::Scenario s;
  const std::vector<std::string> names = body_names(trace.crowd);
  s.name = trace.crowd.name + "-" + names[pair.i] + "-" + names[pair.j];
  std::replace(s.name.begin(), s.name.end(), ' ', '_');
  s.purpose = names[pair.i] + " (A) and " + names[pair.j] + " (B) of the crowd " + trace.crowd.name + ".";
  Fnv64 hash;
  hash.add_value(trace.crowd.hash);
  for (const std::uint32_t body : {pair.i, pair.j}) {
    hash.add_value(body);
    s.bodies.emplace_back();
    s.bodies.back().file =
        (std::filesystem::path(path).parent_path() / (kind_of(trace.crowd, body).name + ".lrb")).string();
    std::vector<Pose>& poses = body == pair.i ? s.motion.of_a : s.motion.poses;
    for (const std::vector<Pose>& step : trace.poses) poses.push_back(step[body]);
  }
  s.hash = hash.value();
  s.motion.kind = spec::Motion::Kind::poses;
  s.request = trace.crowd.request;
  s.more = trace.crowd.more;
  s.request.contacts = s.request.mode == Mode::all_pairs;
  return s;
}

void check_answers(const CrowdTrace& trace, const BodyPair& pair, const run::Recording& recording) {
  for (std::size_t step = 0; step < trace.answers.size(); ++step) {
    const std::vector<CrowdTrace::Answer>& answers = trace.answers[step];
    const auto recorded = std::find_if(answers.begin(), answers.end(),
                                       [&](const CrowdTrace::Answer& a) { return a.bodies == pair; });
    const CollideResult& found = recording.results[step];
    // A pair that was not queried has disjoint boxes.
    const CrowdTrace::Answer answer{.bodies = pair,
                                    .relation = found.relation,
                                    .pairs = found.pairs.size(),
                                    .fingerprint = fingerprint(found.pairs)};
    if (recorded == answers.end() ? !found.pairs.empty() : *recorded != answer)
      throw InputError(trace.file + ": step " + std::to_string(step) +
                       ": the two bodies have another answer than the recorded one; the trace is damaged; "
                       "record it again");
  }
}

}  // namespace lrb::crowd

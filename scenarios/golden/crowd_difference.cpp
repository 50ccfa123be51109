#include "scenarios/golden/crowd_difference.hpp"

#include <algorithm>

#include "scenarios/io/files.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::golden {
namespace {

using Answer = crowd::CrowdTrace::Answer;
using Interval = std::optional<std::array<double, 2>>;

std::string words_of(std::uint64_t value) {
  return std::to_string(value);
}
std::string words_of(Relation relation) {
  return std::string(to_string(relation));
}
std::string words_of(const Interval& bounds) {
  return bounds ? "[" + io::number_text((*bounds)[0]) + ", " + io::number_text((*bounds)[1]) + "]" : "none";
}
std::string words_of(const std::optional<ClashKind>& kind) {
  return kind ? std::string(lrb::name_of(*kind)) : "none";
}
std::string words_of(const std::optional<std::uint64_t>& value) {
  return value ? std::to_string(*value) : "none";
}

/// Returns "8 knot, 6 gear".
std::string kinds_text(const spec::Crowd& crowd) {
  std::string out;
  for (const spec::CrowdKind& kind : crowd.kinds)
    out += (out.empty() ? "" : ", ") + std::to_string(kind.count) + " " + kind.name;
  return out;
}

/// Returns the requested measures: "distance, near 0.1".
std::string measures_text(const spec::StepQuestions& more) {
  std::string out;
  const auto add = [&](const std::string& word) { out.append(out.empty() ? "" : ", ").append(word); };
  if (more.distance) add("distance");
  if (more.clash) add("clash");
  if (more.near) add("near " + io::number_text(*more.near));
  return out.empty() ? "none" : out;
}

/// Collects the differences of the queries of two runs.
class Queries {
 public:
  Queries(const crowd::CrowdTrace& expected, const crowd::CrowdTrace& found)
      : expected_(expected), found_(found), names_(crowd::body_names(found.crowd)) {}

  /// Appends the differences at a step, in ascending order of bodies.
  void of_step(std::size_t step, std::vector<Effect>& out) {
    out_ = &out;
    step_ = static_cast<std::uint32_t>(step);
    const std::vector<Answer>&x = expected_.answers[step], &y = found_.answers[step];
    for (auto p = x.begin(), q = y.begin(); p != x.end() || q != y.end();) {
      const bool only_x = q == y.end() || (p != x.end() && p->bodies < q->bodies),
                 only_y = p == x.end() || (q != y.end() && q->bodies < p->bodies);
      if (only_x) {
        one_sided(*p, true);
        ++p;
      } else if (only_y) {
        one_sided(*q, false);
        ++q;
      } else {
        both(*p++, *q++);
      }
    }
  }

 private:
  /// Adds a query that only one run has. Bodies that are not queried are separate.
  void one_sided(const Answer& a, bool is_expected) {
    const std::string relation = words_of(a.relation), none = "none: the boxes are disjoint";
    add(a.bodies, "query", is_expected ? relation : none, is_expected ? none : relation,
        a.relation == Relation::separate ? Effect::Kind::work : Effect::Kind::answer);
  }

  void both(const Answer& x, const Answer& y) {
    const auto compare = [&](const char* what, const auto& p, const auto& q, Effect::Kind kind) {
      if (p != q) add(x.bodies, what, words_of(p), words_of(q), kind);
    };
    using Kind = Effect::Kind;
    compare("relation", x.relation, y.relation, Kind::answer);
    compare("pairs", x.pairs, y.pairs, Kind::answer);
    if (x.fingerprint != y.fingerprint)
      add(x.bodies, "fingerprint", trace::to_hex(x.fingerprint), trace::to_hex(y.fingerprint), Kind::answer);
    compare("distance", x.distance, y.distance, Kind::answer);
    compare("contact kind", x.kind, y.kind, Kind::answer);
    compare("depth", x.depth, y.depth, Kind::answer);
    compare("near pairs", x.near_pairs, y.near_pairs, Kind::answer);
    compare("contact regions", x.contact_regions, y.contact_regions, Kind::measure);
    for (std::size_t i = 0; i < crowd::kQueryCounters.size(); ++i)
      compare(crowd::kQueryCounters[i].name, x.work[i], y.work[i], Kind::work);
  }

  void add(const BodyPair& bodies, const std::string& what, const std::string& expected,
           const std::string& found, Effect::Kind kind) {
    out_->push_back(
        {step_, names_[bodies.i] + " and " + names_[bodies.j] + ": " + what, expected, found, kind});
  }

  const crowd::CrowdTrace &expected_, &found_;
  std::vector<std::string> names_;
  std::vector<Effect>* out_ = nullptr;
  std::uint32_t step_ = 0;
};

std::size_t common_steps(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  return std::min(x.answers.size(), y.answers.size());
}

/// Returns the first body that has another pose at a step; nullopt: none.
std::optional<std::size_t> moved_body(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y,
                                      std::size_t step) {
  for (std::size_t i = 0; i < y.poses[step].size(); ++i)
    if (!trace::equal(x.poses[step][i], y.poses[step][i])) return i;
  return std::nullopt;
}

}  // namespace

std::size_t query_count(const crowd::CrowdTrace& trace) {
  std::size_t n = 0;
  for (const std::vector<Answer>& step : trace.answers) n += step.size();
  return n;
}

std::vector<Effect> crowd_effects(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  const std::string kinds_x = kinds_text(x.crowd), kinds_y = kinds_text(y.crowd);
  if (kinds_x != kinds_y) return {{0, "bodies", kinds_x, kinds_y, Effect::Kind::answer}};
  std::vector<Effect> out;
  Queries queries(x, y);
  for (std::size_t step = 0; step < common_steps(x, y); ++step) queries.of_step(step, out);
  if (x.answers.size() != y.answers.size())
    out.push_back({static_cast<std::uint32_t>(common_steps(x, y)), "number of steps",
                   std::to_string(x.answers.size()), std::to_string(y.answers.size()), Effect::Kind::answer});
  std::stable_sort(out.begin(), out.end(), [](const Effect& a, const Effect& b) { return a.kind < b.kind; });
  return out;
}

std::optional<trace::Divergence> first_divergence(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  const auto differ = [](const std::string& what, const std::string& expected, const std::string& found,
                         std::optional<std::size_t> step = {}) {
    return trace::Divergence{{}, step, what, expected, found};
  };
  if (const std::string p = kinds_text(x.crowd), q = kinds_text(y.crowd); p != q)
    return differ("bodies", p, q);
  for (std::size_t k = 0; k < y.bodies.size(); ++k)
    if (x.bodies[k].hash != y.bodies[k].hash)
      return differ(y.crowd.kinds[k].name + ": hash", trace::to_hex(x.bodies[k].hash),
                    trace::to_hex(y.bodies[k].hash));
  std::optional<trace::Divergence> request;
  for_each_field<CollideRequest>([&](const auto& field) {
    if (!request && x.crowd.request.*field.member != y.crowd.request.*field.member)
      request = differ("request: " + std::string(field.name), "as approved", "another value");
  });
  if (request) return request;
  if (const std::string p = measures_text(x.crowd.more), q = measures_text(y.crowd.more); p != q)
    return differ("request: measures", p, q);
  const std::vector<std::string> names = crowd::body_names(y.crowd);
  Queries queries(x, y);
  for (std::size_t step = 0; step < common_steps(x, y); ++step) {
    if (const auto body = moved_body(x, y, step))
      return differ(names[*body] + ": pose", "as approved", "another one", step);
    std::vector<Effect> effects;
    queries.of_step(step, effects);
    if (!effects.empty()) return differ(effects[0].what, effects[0].expected, effects[0].found, step);
  }
  if (x.answers.size() != y.answers.size())
    return differ("number of steps", std::to_string(x.answers.size()), std::to_string(y.answers.size()));
  return std::nullopt;
}

std::string kinds_cause(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  const std::string p = kinds_text(x.crowd), q = kinds_text(y.crowd);
  if (p != q) return "the bodies changed: " + p + " -> " + q;
  const std::string m = measures_text(x.crowd.more), n = measures_text(y.crowd.more);
  return m != n ? "the requested measures changed: " + m + " -> " + n : std::string();
}

std::string crowd_pose_cause(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  if (kinds_text(x.crowd) != kinds_text(y.crowd)) return {};
  const std::vector<std::string> names = crowd::body_names(y.crowd);
  for (std::size_t step = 0; step < common_steps(x, y); ++step)
    if (const auto body = moved_body(x, y, step))
      return "step " + std::to_string(step) + ": " + names[*body] + " moved: its origin is displaced by " +
             render::short_number((y.poses[step][*body].t - x.poses[step][*body].t).norm());
  return {};
}

}  // namespace lrb::golden

#include "scenarios/spec/scenario.hpp"

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "engine/core/error.hpp"
#include "engine/core/fnv.hpp"
#include "engine/query/coarse/coarse_query.hpp"
#include "scenarios/io/json/json_node.hpp"
#include "scenarios/io/json/suggest.hpp"
#include "scenarios/spec/scenario_body.hpp"
#include "scenarios/spec/scenario_frames.hpp"
#include "scenarios/spec/scenario_motion.hpp"
#include "trace/hex.hpp"

namespace lrb::spec {
namespace {

constexpr double kLongestTolerance = 1e150;  // its square is still finite
constexpr std::uint64_t kMostTests = std::uint64_t{1} << 62;

std::vector<BodySpec> read_bodies(const io::JsonNode& node, Show show, const std::filesystem::path& folder,
                                  std::uint64_t seed) {
  node.object({"a", "b"});
  std::vector<BodySpec> bodies = {read_body(node.at("a"), folder, seed)};
  if (show == Show::collision)
    bodies.push_back(read_body(node.at("b"), folder, seed));
  else if (node.has("b"))
    node.fail_key("b", "a scenario that shows a refinement or a construction has body a only: remove it");
  return bodies;
}

void read_trace(const io::JsonNode& node, Scenario& s) {
  node.object({"clock", "max_events", "gzip"});
  if (const auto n = node.get("clock"))
    s.clock = n->choice<trace::Clock>({{"event", trace::Clock::event}, {"wall", trace::Clock::wall}});
  if (const auto n = node.get("max_events"))
    s.event_cap = static_cast<std::uint32_t>(n->integer(1, 50'000'000));
  if (const auto n = node.get("gzip")) s.gzip = n->boolean();
}

Expectation read_expectation(const io::JsonNode& node, const io::JsonText& text) {
  node.object({"step", "relation", "pairs", "fingerprint"});
  Expectation e;
  e.step = static_cast<std::uint32_t>(node.at("step").integer(0, kMaxId));
  e.place = text.where(node.pointer());
  if (const auto n = node.get("relation"))
    e.relation = n->choice<Relation>({{"separate", Relation::separate},
                                      {"crossing", Relation::crossing},
                                      {"touching", Relation::touching},
                                      {"a_inside_b", Relation::a_inside_b},
                                      {"b_inside_a", Relation::b_inside_a},
                                      {"undefined", Relation::undefined},
                                      {"unresolved", Relation::unresolved}});
  if (const auto n = node.get("pairs")) e.pairs = n->integer(0, kAnySeed);
  if (const auto n = node.get("fingerprint")) {
    e.fingerprint = trace::from_hex(n->string());
    if (!e.fingerprint) n->fail("expected 16 lower-case hexadecimal digits");
  }
  return e;
}

}  // namespace

CollideRequest read_query(const io::JsonNode& node) {
  if (node.has("max_time"))
    node.fail_key("max_time",
                  "how far a query comes in a time differs from run to run, and the same file is to give the "
                  "same trace: give max_tests instead");
  node.object({"mode", "recursion", "predicates", "wrapper", "contacts", "interiors_overlap", "tolerance",
               "max_tests", "separation"});
  CollideRequest r;
  if (const auto n = node.get("mode"))
    r.mode =
        n->choice<Mode>({{"all", Mode::all_pairs}, {"first", Mode::first_pair}, {"any", Mode::any_pair}});
  if (const auto n = node.get("recursion"))
    r.recursion = n->choice<Recursion>({{"complete", Recursion::complete},
                                        {"paper", Recursion::paper},
                                        {"paper_strict", Recursion::paper_strict}});
  if (const auto n = node.get("predicates"))
    r.predicates = n->choice<Predicates>({{"exact", Predicates::exact}, {"floating", Predicates::floating}});
  if (const auto n = node.get("wrapper"))
    r.wrapper = n->choice<WrapperMode>(
        {{"regularised", WrapperMode::regularised}, {"unregularised", WrapperMode::unregularised}});
  if (const auto n = node.get("tolerance")) r.tolerance = n->number(0, kLongestTolerance);
  if (const auto n = node.get("max_tests")) r.max_tests = n->integer(1, kMostTests);
  if (const auto n = node.get("separation")) r.separation = n->boolean();
  r.contacts = r.mode == Mode::all_pairs && !r.is_coarse();
  if (const auto n = node.get("contacts")) {
    r.contacts = n->boolean();
    if (r.contacts && r.mode != Mode::all_pairs) n->fail("contacts need \"mode\": \"all\"");
  }
  if (const auto n = node.get("interiors_overlap")) r.interiors_overlap = n->boolean();
  try {
    if (r.is_coarse()) check_coarse_request(r);
  } catch (const InputError& e) {
    node.fail(e.what());
  }
  return r;
}

Scenario parse_scenario(const std::string& text, const std::string& file) {
  const io::JsonText json(text, file);
  const io::JsonNode root(json);
  root.object({"$schema", "name", "purpose", "seed", "show", "bodies", "motion", "query", "trace", "frames",
               "expect"});
  Scenario s;
  if (const auto n = root.get("$schema")) n->string();
  s.name = read_name(root.at("name"));
  s.purpose = root.at("purpose").string();
  if (const auto n = root.get("seed")) s.seed = n->integer(0, kAnySeed);
  if (const auto n = root.get("show"))
    s.show = n->choice<Show>({{"collision", Show::collision},
                              {"refinement", Show::refinement},
                              {"construction", Show::construction}});
  s.bodies = read_bodies(root.at("bodies"), s.show, std::filesystem::path(file).parent_path(), s.seed);
  if (s.show == Show::collision) {
    s.motion = read_motion(root.at("motion"));
  } else {
    for (const char* key : {"motion", "query", "expect"})
      if (root.has(key))
        root.fail_key(key, "a refinement or a construction shows one body and asks nothing: remove it");
  }
  s.request.contacts = true;
  if (const auto n = root.get("query")) s.request = read_query(*n);
  if (const auto n = root.get("trace")) read_trace(*n, s);
  s.frames.at = s.show == Show::collision ? FrameSpec::At::step : FrameSpec::At::refinement;
  if (const auto n = root.get("frames")) s.frames = read_frames(*n, s.frames);
  if (const auto n = root.get("expect"))
    for (const io::JsonNode& item : n->items()) s.expect.push_back(read_expectation(item, json));
  Fnv64 hash;
  hash.add_bytes(text.data(), text.size());
  s.hash = hash.value();
  return s;
}

}  // namespace lrb::spec

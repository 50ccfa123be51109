// fingerprints [THREADS]: hashes of the engine's results, one per line: bodies, .lrb files, queries of
// every class of the torture suite, distances, first contacts, clashes, traces. reproducibility.sh compares
// its output over compilers, optimisation and threads.

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "bench/cases/families.hpp"
#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/generators.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/motion.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;

namespace {

constexpr int kDifficulties = 11;       // of each class, from benign to degenerate
constexpr int kCasesPerDifficulty = 8;  // of each class
constexpr int kPosesPerPair = 3;        // of two generated bodies
constexpr std::size_t kEachNth = 11;    // case of a class, for queries that take longer

void print(const std::string& what, std::uint64_t hash) {
  std::printf("%016llx %s\n", static_cast<unsigned long long>(hash), what.c_str());
  std::fflush(stdout);  // under an emulator, a line may take minutes
}

std::uint64_t hash_of_bytes(const std::string& bytes) {
  Fnv64 h;
  h.add_bytes(bytes.data(), bytes.size());
  return h.value();
}

void add_vector(Fnv64& h, const Eigen::Vector3d& x) {
  for (int k = 0; k < 3; ++k) h.add_value(x[k]);
}

/// All that a query answers, to the last bit; no padding between members.
void add_answer(Fnv64& h, const CollideResult& r) {
  h.add_value(r.relation);
  h.add_value(r.interiors_overlap);
  h.add_array(r.pairs);
  h.add_array(r.meets);
  for (const auto& opened : r.opened) h.add_array(opened);
  const Counters& c = r.counters;
  for (const std::uint64_t n : {c.face_tests, c.real_tests, c.exact_fallbacks, c.node_pairs, c.box_tests,
                                c.prefilter_tests, c.refinements, c.regions_opened})
    h.add_value(n);
  h.add_array(c.face_tests_by_level);
  for (const ContactRegion& region : r.regions) {
    h.add_array(region.pairs);
    for (const ContactLoop& loop : region.loops)
      for (const Eigen::Vector3d& x : loop.points) add_vector(h, x);
    for (const double x : {region.length, region.area, region.depth_estimate}) h.add_value(x);
    add_vector(h, region.centroid);
    add_vector(h, region.normal);
  }
}

/// Complete with contacts, then both of the paper's recursions.
std::uint64_t ask(const cases::Case& c, QueryContext& context) {
  Fnv64 h;
  NullProbe probe;
  for (const Recursion recursion : {Recursion::complete, Recursion::paper, Recursion::paper_strict}) {
    CollideRequest request;
    request.recursion = recursion;
    request.contacts = request.interiors_overlap = recursion == Recursion::complete;
    try {
      add_answer(h, collide(*c.a, c.pose_a, *c.b, c.pose_b, request, context, probe));
    } catch (const InputError& e) {  // refused: the same words everywhere
      h.add_value(hash_of_bytes(e.what()));
    }
  }
  return h.value();
}

/// A lower and an upper bound, and witness points.
std::uint64_t ask_distance(const cases::Case& c) {
  Fnv64 h;
  const DistanceResult r = distance(*c.a, c.pose_a, *c.b, c.pose_b);
  for (const double x : {r.lower, r.upper}) h.add_value(x);
  for (const Witness& w : r.witness) add_vector(h, w.point);
  return h.value();
}

/// The first contact of a screw motion of B to the other side of A.
std::uint64_t ask_first_contact(const cases::Case& c) {
  Fnv64 h;
  Pose end = c.pose_b;
  end.t = 2 * c.pose_a.t - end.t;
  const FirstContactResult r =
      first_contact(*c.a, Motion::still(c.pose_a), *c.b, Motion::screw(c.pose_b, end));
  h.add_value(r.outcome);
  for (const double t : {r.t0, r.t1}) h.add_value(t);
  add_vector(h, r.normal);
  return h.value();
}

std::uint64_t ask_clash(const cases::Case& c) {
  Fnv64 h;
  const ClashResult r = clash(*c.a, c.pose_a, *c.b, c.pose_b);
  h.add_value(r.kind);
  for (const auto& interval : {r.depth, r.volume})
    for (const double x :
         {interval.value_or(ProvedInterval{}).lower, interval.value_or(ProvedInterval{}).upper})
      h.add_value(x);
  add_vector(h, r.translation);
  return h.value();
}

/// The answers to every `nth` case, on several threads, each with a context of its own; bodies are shared.
template <typename Ask>
std::uint64_t ask_all(const std::vector<cases::Case>& cases, std::size_t nth, unsigned threads,
                      const Ask& ask) {
  std::vector<std::uint64_t> answers((cases.size() + nth - 1) / nth);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    QueryContext context;
    for (std::size_t i = next++; i < answers.size(); i = next++) {
      const cases::Case& c = cases[i * nth];
      try {
        if constexpr (std::is_invocable_v<Ask, const cases::Case&>)
          answers[i] = ask(c);
        else
          answers[i] = ask(c, context);
      } catch (const InputError& e) {  // refused: the same words everywhere
        answers[i] = hash_of_bytes(e.what());
      }
    }
  };
  std::vector<std::thread> others;
  for (unsigned t = 1; t < threads; ++t) others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
  Fnv64 h;
  h.add_array(answers);
  return h.value();
}

std::vector<cases::Body> generated_bodies() {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("lrb-" + std::to_string(std::rand()))).string();
  std::vector<cases::Body> bodies;
  const auto add = [&](const std::string& name, const Mesh& mesh, const BuildOptions& options) {
    bodies.push_back(std::make_shared<const LrbRep>(build_lrb(mesh, options)));
    print("body " + name, bodies.back()->hash());
    save_lrb(*bodies.back(), file);
    print(".lrb " + name, hash_of_bytes(read_file(file)));
  };
  for (const generators::Generator& g : generators::generators())
    add(g.name, generators::generate(g.name), {});
  BuildOptions merging;
  merging.merge_planes = true;
  add("stairs, planes merged",
      shapes::voxels(6, 6, 5, [](int x, int y, int z) { return z <= x % 3 + y / 2; }), merging);
  std::filesystem::remove(file);
  return bodies;
}

/// Every two generated bodies of one dimension, in contact or nearly so.
std::vector<cases::Case> cases_of(const std::vector<cases::Body>& bodies) {
  cases::RandomEngine random(1);
  std::vector<cases::Case> cases;
  for (const cases::Body& a : bodies)
    for (const cases::Body& b : bodies)
      for (int i = 0; i < kPosesPerPair && a->dim() == b->dim(); ++i)
        cases.push_back({a, b, Pose{}, shapes::random_pose(random, *a, *b, 0.1 * i), {}, {}});
  return cases;
}

std::vector<cases::Case> cases_of(const cases::Family& family) {
  cases::RandomEngine random(1);
  std::vector<cases::Case> cases;
  for (int difficulty = 0; difficulty < kDifficulties; ++difficulty)
    for (int i = 0; i < kCasesPerDifficulty; ++i)
      cases.push_back(family.make(random, static_cast<double>(difficulty) / (kDifficulties - 1)));
  return cases;
}

void print_trace(const cases::Case& c, Recursion recursion) {
  trace::RecorderSettings settings;
  settings.scenario = "repeat";
  settings.request.recursion = recursion;
  trace::Recorder recorder(*c.a, *c.b, settings);
  QueryContext context;
  recorder.begin_step(0, c.pose_a, c.pose_b);
  recorder.end_step(collide(*c.a, c.pose_a, *c.b, c.pose_b, settings.request, context, recorder));
  print(std::string("trace ") + to_string(recursion), hash_of_bytes(trace::trace_to_json(recorder.take())));
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned threads = argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 1;
  const auto bodies = generated_bodies();
  const auto pairs = cases_of(bodies);
  print("generated bodies", ask_all(pairs, 1, threads, ask));
  for (const cases::Family& family : cases::all_families()) {
    const auto cases = cases_of(family);
    const std::string name = family.name;
    print("class " + name, ask_all(cases, 1, threads, ask));
    print("distances " + name, ask_all(cases, kEachNth, threads, ask_distance));
    print("first contacts " + name, ask_all(cases, kEachNth, threads, ask_first_contact));
    print("clashes " + name, ask_all(cases, kEachNth, threads, ask_clash));
  }
  for (const Recursion recursion : {Recursion::complete, Recursion::paper})
    print_trace(pairs.front(), recursion);
}

// The torture suite: every family at every difficulty, against brute force and independent
// oracles.
//
// Each batch of poses runs in a process of its own, so that a crash or a hang is counted and the rest goes
// on. A difference is printed with the command that shows it alone. A million poses near contact:
//   torture --poses 56000 --jobs 2
//
// Columns. contact, inside: poses in which surfaces meet, in which one body contains the other. regions:
// bodies that the builder made first, which must not change the answer. false-, false+: pairs missed, pairs
// too many. lists: duplicates, wrong order, touch for cross, or contradictions with first_pair, B against A
// or contacts. relation: wrong relations or interiors_overlap. undecided: interiors_overlap unknown although
// the case has an answer. refusals: world coordinates beyond 1.8e308. crashes: crashes, hangs and other
// refusals. rational, CGAL, parity: pairs and relations given to these oracles. coarse: queries with a
// tolerance, of bodies with regions; measured: answers whose error bound is compared with distances; bound:
// exceeded. motions: bodies that move; contacts: with a first contact; misses: contacts of the exact query
// before t0; no contact: pairs at t1 that do not meet; wide: intervals wider than requested that are not
// marked as grazing.
//
// interiors_overlap is a statement about bodies as rounded to world coordinates: a crossing gives "yes" only
// where that is proven, and a body that rounding has made flat gives "unknown". A face is the
// triangles of cut_polygon(), and inside is the parity of these.

#include "tests/torture/torture.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>
#include <unordered_map>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/shared_meshes.hpp"
#include "tests/torture/cgal_oracle.hpp"
#include "tests/torture/models.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>

using namespace lrb;
using namespace lrb::cases;
using namespace lrb::torture;

namespace {

/// A batch takes seconds: one that takes longer than this hangs.
constexpr unsigned kBatchSeconds = 600;

struct Batch {
  std::uint64_t begin = 0, end = 0;
};

Tally& operator+=(Tally& sum, const Tally& part) {
  for (const Column& c : kColumns) sum.*c.count += part.*c.count;
  return sum;
}

void print_row(const char* name, const Tally& counts, double seconds) {
  std::printf("%-14s", name);
  for (const Column& c : kColumns) std::printf(" %10llu", static_cast<unsigned long long>(counts.*c.count));
  std::printf(" %7.1f\n", seconds);
  std::fflush(stdout);
}

/// Adds up work(batch) over [0, count), `jobs` processes at a time. Counts come through a pipe. Those of a
/// batch whose process dies are a crash.
Tally sum_in_children(const char* name, std::uint64_t count, std::uint64_t batch_size, unsigned jobs,
                      const std::function<Tally(Batch)>& work) {
  static_assert(sizeof(Tally) <= 4096, "must fit into a pipe, which is read when its writer has gone");
  struct Child {
    pid_t pid;
    int result;
    Batch batch;
  };
  std::vector<Child> running;
  Tally sum;
  const auto collect = [&] {
    int status = 0;
    const pid_t pid = wait(&status);
    const auto it =
        std::find_if(running.begin(), running.end(), [&](const Child& c) { return c.pid == pid; });
    if (it == running.end()) return;
    Tally part;
    const bool whole = read(it->result, &part, sizeof part) == static_cast<ssize_t>(sizeof part);
    close(it->result);
    if (!whole || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
      const auto [begin, end] = it->batch;
      std::fprintf(stderr, "%s: the process died (status %d) between cases %llu and %llu\n", name, status,
                   static_cast<unsigned long long>(begin), static_cast<unsigned long long>(end));
      part = {};
      part.poses = end - begin;
      part.crashes = 1;
    }
    sum += part;
    running.erase(it);
  };
  for (std::uint64_t begin = 0; begin < count; begin += batch_size) {
    const Batch batch{begin, std::min(count, begin + batch_size)};
    while (running.size() >= jobs) collect();
    int ends[2];
    std::fflush(stdout);
    const bool piped = pipe(ends) == 0;
    const pid_t child = piped ? fork() : -1;
    if (child == 0) {
      close(ends[0]);
      alarm(kBatchSeconds);
      const Tally part = work(batch);
      const bool sent = write(ends[1], &part, sizeof part) == static_cast<ssize_t>(sizeof part);
      std::fflush(stderr);
      _exit(sent ? 0 : 1);
    }
    if (piped) close(ends[1]);
    if (child > 0) {
      running.push_back({child, ends[0], batch});
    } else {  // no process to be had: unguarded
      if (piped) close(ends[0]);
      sum += work(batch);
    }
  }
  while (!running.empty()) collect();
  return sum;
}

/// A row: its name, the number of cases, and the work for some of them.
struct Row {
  std::string name;
  std::uint64_t count = 0;
  std::function<Tally(Batch)> work;
};

/// Does the work of all rows, with `jobs` children, or without any if that is 0, and prints the table.
/// Returns the number of differences.
std::uint64_t print_table(const std::vector<Row>& rows, std::uint64_t batch_size, unsigned jobs) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::printf("%-14s", "bodies");
  for (const Column& c : kColumns) std::printf(" %10s", c.head);
  std::printf(" %7s\n", "s");
  Tally total;
  const Clock::time_point begun = Clock::now();
  for (const Row& row : rows) {
    const Clock::time_point start = Clock::now();
    const Tally sum = jobs == 0 ? row.work({0, row.count})
                                : sum_in_children(row.name.c_str(), row.count, batch_size, jobs, row.work);
    print_row(row.name.c_str(), sum, since(start));
    total += sum;
  }
  print_row("total", total, since(begun));
  std::uint64_t differences = 0;
  for (const Column& c : kColumns) differences += c.is_difference ? total.*c.count : 0;
  return differences;
}

constexpr std::uint64_t kBatch = 1000;

struct Options {
  std::uint64_t poses = 1000;  ///< of each class; of the slow ones a quarter
  std::uint64_t seed = 1;
  std::int64_t only = -1;  ///< this pose alone, in this process
  unsigned jobs = 1;
  std::string name;  ///< this class alone
  std::filesystem::path models = test::shared_meshes();
  Effort effort;
};

/// These take ten times as long as the others, for their size or for the oracle's numbers: a quarter of the
/// poses.
constexpr const char* kSlow[] = {"hub",   "interlock", "far",     "extreme",
                                 "ratio", "polygon",   "fractal", "models"};

/// A row of the table: a family, or the real models.
struct Class {
  cases::Family family;
  const Models* models = nullptr;

  std::uint64_t poses(const Options& o) const {
    const bool slow = std::any_of(std::begin(kSlow), std::end(kSlow),
                                  [&](const char* name) { return std::strcmp(name, family.name) == 0; });
    return slow ? (o.poses + 3) / 4 : o.poses;
  }

  cases::Case make(RandomEngine& random, double difficulty) const {
    return models ? models->make(random, difficulty) : family.make(random, difficulty);
  }
};

constexpr cases::Family kModels = {"models", "real models against each other and small bodies, near contact",
                                   nullptr};

/// Null if the builder refuses the mesh.
cases::Body built(const LrbRep& rep, RandomEngine& random) {
  BuildOptions options;
  options.patch_interior = static_cast<std::uint32_t>(cases::pick(random, 2, 16));
  options.seed = random();
  try {
    return std::make_shared<LrbRep>(build_lrb(rep.real_mesh(), options));
  } catch (const InputError&) {
    return nullptr;
  }
}

bool give(cases::Body& body, RandomEngine& random, std::uint32_t max_simplices) {
  if (body->region_count() > 0 || body->real_simplex_count() > max_simplices) return false;
  // Drawn always, so that what follows does not depend on what is kept.
  RandomEngine own(random());
  static std::unordered_map<std::uint64_t, cases::Body> kept;  // many families draw from a dozen bodies
  const std::uint64_t key = body->hash() * 8 + own() % 8;
  if (kept.size() > 1000) kept.clear();
  const auto [it, fresh] = kept.try_emplace(key);
  if (fresh) {
    RandomEngine options(key);
    it->second = built(*body, options);
  }
  if (!it->second) return false;
  body = it->second;
  return body->region_count() > 0;
}

/// Gives a case's bodies regions by build_lrb(), where they have none and the mesh can be built and has at
/// most `max_simplices` simplices: the answer must not change. Returns true if a body got some.
bool give_regions(cases::Case& c, RandomEngine& random, std::uint32_t max_simplices) {
  const bool a = give(c.a, random, max_simplices), b = give(c.b, random, max_simplices);
  return a || b;
}

Tally one_pose(const Class& c, std::uint64_t index, const Options& o, std::string& trouble) {
  // As make_case() at difficulty index % kDifficulties; the remaining random numbers drive the checks.
  RandomEngine random = cases::case_random(c.family, o.seed, index);
  const double difficulty = cases::scaled_difficulty(static_cast<int>(index % cases::kDifficulties));
  cases::Case made = c.make(random, difficulty);
  Tally t;
  if (random() % o.effort.regions_every == 0)
    t.with_regions += give_regions(made, random, o.effort.regions_most_simplices);
  t += check(made, random, o.effort, trouble);
  return t;
}

Tally batch(const Class& c, Batch range, const Options& o) {
  Tally sum;
  int shown = 0;
  for (std::uint64_t i = range.begin; i < range.end; ++i) {
    std::string trouble;
    try {
      sum += one_pose(c, i, o, trouble);
    } catch (const std::exception& e) {
      ++sum.poses;
      ++sum.crashes;
      trouble += std::string("exception: ") + e.what() + '\n';
    }
    if (!trouble.empty() && shown++ < 3)
      std::fprintf(stderr, "--class %s --seed %llu --only %llu\n%s", c.family.name,
                   static_cast<unsigned long long>(o.seed), static_cast<unsigned long long>(i),
                   trouble.c_str());
  }
  return sum;
}

int usage(const std::string& complaint) {
  std::fprintf(stderr, "torture: %s\n", complaint.c_str());
  std::fprintf(
      stderr,
      "usage: torture [--poses N] [--jobs N] [--class NAME] [--seed S] [--only POSE]\n"
      "               [--models FOLDER]   N poses of a class (slow ones: N / 4), compared with every oracle\n"
      "classes:\n");
  for (const cases::Family& f : cases::all_families()) std::fprintf(stderr, "  %-12s %s\n", f.name, f.what);
  std::fprintf(stderr, "  %-12s %s\n", kModels.name, kModels.what);
  return 2;
}

std::uint64_t number(const char* text) {
  return std::strtoull(text, nullptr, 10);
}

/// False if the option is unknown.
bool take(Options& o, const std::string& key, const char* value) {
  if (key == "--poses")
    o.poses = number(value);
  else if (key == "--jobs")
    o.jobs = static_cast<unsigned>(std::max<std::uint64_t>(1, number(value)));
  else if (key == "--class")
    o.name = value;
  else if (key == "--seed")
    o.seed = number(value);
  else if (key == "--only")
    o.only = static_cast<std::int64_t>(number(value));
  else if (key == "--models")
    o.models = value;
  else
    return false;
  return true;
}

/// Runs the requested classes and prints a row each. Returns 1 if there was a difference.
int run_table(const Options& o, const std::vector<Class>& classes) {
  std::vector<Row> rows;
  for (const Class& c : classes) {
    if (!o.name.empty() && o.name != c.family.name) continue;
    const auto work = [&c, &o](Batch b) { return batch(c, b, o); };
    const auto one = static_cast<std::uint64_t>(o.only);
    if (o.only >= 0)
      rows.push_back({c.family.name, 1, [=](Batch) { return work({one, one + 1}); }});
    else
      rows.push_back({c.family.name, c.poses(o), work});
  }
  const std::uint64_t differences = print_table(rows, kBatch, o.only >= 0 ? 0 : o.jobs);
  if (!has_cgal()) std::printf("CGAL was not found when this was built: its column is 0\n");
  return differences == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 == argc) return usage(key + " needs a value");
    if (!take(o, key, argv[i + 1])) return usage("unknown option " + key);
  }
  if (!o.name.empty() && o.name != kModels.name && cases::find_family(o.name) == nullptr)
    return usage("unknown class " + o.name);
  if (o.only >= 0 && o.name.empty()) return usage("--only needs --class");

  std::vector<Class> classes;
  for (const cases::Family& f : cases::all_families()) classes.push_back({f});
  Models models;
  if (o.name.empty() || o.name == kModels.name) {
    models.load(o.models);
    if (models.empty())
      std::printf("no real models in '%s': that class is left out (--models FOLDER, or LRB_MESHES)\n",
                  o.models.string().c_str());
    else
      classes.push_back({kModels, &models});
  }
  return run_table(o, classes);
}

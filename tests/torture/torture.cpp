// The torture suite: every family at every setting of its dial, against brute force and independent oracles.
//
// Each batch of poses runs in a process of its own, so that a crash or a hang is counted and the rest goes
// on. A difference is printed with the command that shows it alone.

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

#include "tests/torture/cgal_oracle.hpp"
#include "tests/torture/compare.hpp"

using namespace lrb;
using namespace lrb::families;
using namespace lrb::torture;

namespace {

constexpr std::uint64_t kBatch = 500;
constexpr unsigned kBatchSeconds = 300;  // a batch takes seconds: beyond this it hangs

struct Options {
  std::uint64_t poses = 1000;  ///< of each class
  std::uint64_t seed = 1;
  std::int64_t only = -1;  ///< this pose alone, in this process
  std::string name;        ///< this class alone
  Effort effort;
};

Tally one_pose(const Family& family, std::uint64_t index, const Options& o, std::string& trouble) {
  // As make_case() at setting index % kDialSettings; what is left of the random numbers drives the checks.
  Random random = case_random(family, o.seed, index);
  const double dial = dial_value(static_cast<int>(index % kDialSettings));
  return check(family.make(random, dial), random, o.effort, trouble);
}

Tally batch(const Family& family, std::uint64_t begin, std::uint64_t end, const Options& o) {
  Tally sum;
  int shown = 0;
  for (std::uint64_t i = begin; i < end; ++i) {
    std::string trouble;
    try {
      sum += one_pose(family, i, o, trouble);
    } catch (const std::exception& e) {
      ++sum.poses;
      ++sum.crashes;
      trouble += std::string("exception: ") + e.what() + '\n';
    }
    if (!trouble.empty() && shown++ < 3)
      std::fprintf(stderr, "--class %s --seed %llu --only %llu\n%s", family.name,
                   static_cast<unsigned long long>(o.seed), static_cast<unsigned long long>(i),
                   trouble.c_str());
  }
  return sum;
}

/// The batch in a child process; a child that dies or hangs counts as one crash.
Tally guarded_batch(const Family& family, std::uint64_t begin, std::uint64_t end, const Options& o) {
  int ends[2];
  if (pipe(ends) != 0) return batch(family, begin, end, o);
  const pid_t child = fork();
  if (child < 0) return batch(family, begin, end, o);
  if (child == 0) {
    close(ends[0]);
    alarm(kBatchSeconds);
    const Tally t = batch(family, begin, end, o);
    const bool sent = write(ends[1], &t, sizeof t) == static_cast<ssize_t>(sizeof t);
    std::fflush(stderr);
    _exit(sent ? 0 : 1);
  }
  close(ends[1]);
  Tally t;
  const bool whole = read(ends[0], &t, sizeof t) == static_cast<ssize_t>(sizeof t);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (whole && WIFEXITED(status) && WEXITSTATUS(status) == 0) return t;
  std::fprintf(stderr, "--class %s --seed %llu: the process died (status %d) between poses %llu and %llu\n",
               family.name, static_cast<unsigned long long>(o.seed), status,
               static_cast<unsigned long long>(begin), static_cast<unsigned long long>(end));
  Tally lost;
  lost.poses = end - begin;
  lost.crashes = 1;
  return lost;
}

void print_header() {
  std::printf("%-12s %9s %9s %8s %7s %7s %7s %8s %9s %9s %8s %10s %8s %8s %7s\n", "class", "poses", "contact",
              "inside", "false-", "false+", "lists", "relation", "undecided", "refusals", "crashes",
              "rational", "CGAL", "parity", "s");
}

void print_row(const char* name, const Tally& t, double seconds) {
  const auto n = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
  std::printf("%-12s %9llu %9llu %8llu %7llu %7llu %7llu %8llu %9llu %9llu %8llu %10llu %8llu %8llu %7.1f\n",
              name, n(t.poses), n(t.in_contact), n(t.inside), n(t.false_negatives), n(t.false_positives),
              n(t.wrong_lists), n(t.wrong_relations), n(t.undecided), n(t.refusals), n(t.crashes),
              n(t.oracle_pairs), n(t.cgal_pairs), n(t.parity_checks), seconds);
  std::fflush(stdout);
}

int usage(const std::string& complaint) {
  std::fprintf(stderr, "torture: %s\n", complaint.c_str());
  std::fprintf(
      stderr,
      "usage: torture [--poses N] [--class NAME] [--seed S] [--only POSE] [--oracle PAIRS]\nclasses:\n");
  for (const Family& f : all_families()) std::fprintf(stderr, "  %-12s %s\n", f.name, f.what);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 == argc) return usage(key + " needs a value");
    const char* value = argv[i + 1];
    if (key == "--poses")
      o.poses = std::strtoull(value, nullptr, 10);
    else if (key == "--class")
      o.name = value;
    else if (key == "--seed")
      o.seed = std::strtoull(value, nullptr, 10);
    else if (key == "--only")
      o.only = std::strtoll(value, nullptr, 10);
    else if (key == "--oracle")
      o.effort.oracle_pairs = std::strtoull(value, nullptr, 10);
    else
      return usage("unknown option " + key);
  }
  if (!o.name.empty() && find_family(o.name) == nullptr) return usage("unknown class " + o.name);
  if (o.only >= 0 && o.name.empty()) return usage("--only needs --class");

  print_header();
  Tally total;
  const auto begun = std::chrono::steady_clock::now();
  const auto seconds_since = [](auto start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  for (const Family& family : all_families()) {
    if (!o.name.empty() && o.name != family.name) continue;
    const auto start = std::chrono::steady_clock::now();
    Tally t;
    if (o.only >= 0) {
      const auto index = static_cast<std::uint64_t>(o.only);
      t = batch(family, index, index + 1, o);
    } else {
      for (std::uint64_t i = 0; i < o.poses; i += kBatch)
        t += guarded_batch(family, i, std::min(o.poses, i + kBatch), o);
    }
    print_row(family.name, t, seconds_since(start));
    total += t;
  }
  print_row("total", total, seconds_since(begun));
  if (!has_cgal()) std::printf("CGAL was not found when this was built: its column is 0\n");
  return total.differences() == 0 ? 0 : 1;
}

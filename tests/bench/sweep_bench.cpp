// First contacts beside those of FCL's continuousCollide() and of a check at equal times: who misses which,
// who finds some that are none, how far off the times are, and how long it takes.
//
//   sweep_bench [--motions N] [--seconds S] [--mesh FILE]     without --mesh: spot of LRB_MESHES
//
// The judge is the proved interval, which is compared with the times that are known in closed form, and with
// the exact query at many times before it. Each method answers in a process of its own, and a motion that
// takes it more than S seconds (2) counts as not answered.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/bench/sweep_methods.hpp"
#include "tests/bench/timing.hpp"
#include "tests/support/shared_meshes.hpp"

using namespace lrb;
using namespace lrb::bench;

namespace {

using Answers = std::vector<std::optional<SweepAnswer>>;

/// A process that answers one motion after the other, from `begin`.
struct Child {
  pid_t pid = -1;
  int output = -1;

  Child(const SweptFamily& family, const SweepMethod& method, std::size_t begin) {
    int ends[2];
    std::fflush(stdout);
    if (pipe(ends) != 0) return;
    pid = fork();
    if (pid != 0) {
      close(ends[1]);
      output = ends[0];
      return;
    }
    const SweepAsker ask = method.make(family);
    for (std::size_t i = begin; i < family.motions.size(); ++i) {
      if (method.straight_only && !family.motions[i].straight) continue;
      const SweepAnswer answer = ask(family.motions[i]);
      if (write(ends[1], &answer, sizeof answer) != static_cast<ssize_t>(sizeof answer)) break;
    }
    _exit(0);
  }
  ~Child() {
    if (pid <= 0) return;
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
    close(output);
  }
  Child(const Child&) = delete;

  std::optional<SweepAnswer> next(double seconds) {
    pollfd wait_for{output, POLLIN, 0};
    SweepAnswer answer;
    if (output < 0 || poll(&wait_for, 1, static_cast<int>(1000 * seconds)) <= 0) return {};
    if (read(output, &answer, sizeof answer) != static_cast<ssize_t>(sizeof answer)) return {};
    return answer;
  }
};

Answers ask(const SweptFamily& family, const SweepMethod& method, double seconds) {
  Answers answers(family.motions.size());
  std::unique_ptr<Child> child;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (method.straight_only && !family.motions[i].straight) continue;
    if (!child) child = std::make_unique<Child>(family, method, i);
    answers[i] = child->next(seconds);
    if (!answers[i]) child.reset();  // it hangs, or is gone
  }
  return answers;
}

/// What is held to be true of one motion.
struct Truth {
  bool contact = false, undecided = false;
  TimeSpan span{2, 2};
};

/// Our answers, after checks; each violation is printed and counted.
struct Judge {
  std::uint64_t samples = 0, violations = 0;

  std::vector<Truth> truths(const SweptFamily& family) {
    std::vector<Truth> list;
    for (const SweptMotion& m : family.motions) {
      const FirstContactResult r = first_contact(family.a, Motion::still({}), family.b, m.motion);
      list.push_back({r.is_contact(), r.outcome == MotionOutcome::undecided, {r.t0, r.t1}});
      if (!agrees(m, list.back()) || meets_before(family, m, r.t0)) {
        ++violations;
        std::printf("%s, motion %zu: the interval [%.17g, %.17g] is wrong\n", family.name.c_str(),
                    list.size() - 1, r.t0, r.t1);
      }
    }
    return list;
  }

 private:
  static bool agrees(const SweptMotion& m, const Truth& t) {
    if (!m.known || t.undecided) return true;
    if (m.known->begin > 1) return !t.contact;
    return t.contact && t.span.begin <= m.known->end && t.span.end >= m.known->begin;
  }

  /// Asks the exact query at 500 times, half of them close to the end.
  bool meets_before(const SweptFamily& family, const SweptMotion& m, double end) {
    CollideRequest any;
    any.mode = Mode::any_pair;
    NullProbe probe;
    for (int i = 0; i < 500; ++i) {
      const double share =
          i % 2 == 0 ? shapes::uniform(random_) : 1 - std::pow(10, -16 * shapes::uniform(random_));
      const double t = std::min(end * share, std::nextafter(end, 0));
      if (t < 0) continue;
      ++samples;
      if (!collide(family.a, Pose{}, family.b, m.motion.at(t), any, context_, probe).pairs.empty())
        return true;
    }
    return false;
  }

  QueryContext context_;
  shapes::RandomEngine random_{21};
};

struct Row {
  int asked = 0, misses = 0, false_hits = 0, no_answer = 0, undecided = 0;
  std::vector<double> off, microseconds;

  void add(const Truth& truth, const SweepAnswer& answer) {
    microseconds.push_back(answer.microseconds);
    undecided += answer.undecided;
    if (answer.undecided) return;
    misses += truth.contact && !answer.contact;
    false_hits += !truth.contact && answer.contact;
    if (truth.contact && answer.contact)
      off.push_back(std::max(std::abs(answer.t - truth.span.begin), std::abs(answer.t - truth.span.end)));
  }

  void print(const std::string& name, double ours_us) {
    std::sort(off.begin(), off.end());
    std::printf("| %s | %d | %d | %d | %d | ", name.c_str(), asked, misses, false_hits,
                no_answer + undecided);
    if (off.empty())
      std::printf("| | ");
    else
      std::printf("%.1e | %.1e | ", off[off.size() / 2], off.back());
    if (microseconds.empty())
      std::printf("| |\n");
    else
      std::printf("%.3g | %.3g |\n", median(microseconds), median(microseconds) / ours_us);
    std::fflush(stdout);
  }
};

void run(const SweptFamily& family, double seconds, Judge& judge) {
  const std::vector<Truth> truths = judge.truths(family);
  int contacts = 0, undecided = 0;
  for (const Truth& t : truths) {
    contacts += t.contact;
    undecided += t.undecided;
  }
  std::printf("\n%s (%s): %zu motions, %d meet, %d undecided\n\n", family.name.c_str(), family.what.c_str(),
              truths.size(), contacts, undecided);
  std::printf(
      "| method | asked | misses | false hits | no answer | off, median | off, most | us | times ours |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  double ours_us = 0;
  std::vector<SweepMethod> methods = own_sweep_methods();
  for (SweepMethod& m : fcl_sweep_methods()) methods.push_back(std::move(m));
  for (const SweepMethod& method : methods) {
    const Answers answers = ask(family, method, seconds);
    Row row;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (truths[i].undecided || (method.straight_only && !family.motions[i].straight)) continue;
      ++row.asked;
      if (answers[i])
        row.add(truths[i], *answers[i]);
      else
        ++row.no_answer;
    }
    if (ours_us == 0) ours_us = median(row.microseconds);
    if (row.asked > 0) row.print(method.name, ours_us);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int count = 40;
  double seconds = 2;
  std::string mesh;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string key = argv[i];
    if (key == "--motions")
      count = std::max(1, std::atoi(argv[i + 1]));
    else if (key == "--seconds")
      seconds = std::atof(argv[i + 1]);
    else if (key == "--mesh")
      mesh = argv[i + 1];
    else
      argc = 0;
  }
  if (argc % 2 == 0 || !(seconds > 0)) {
    std::fprintf(stderr, "usage: sweep_bench [--motions N] [--seconds S] [--mesh FILE]\n");
    return 2;
  }
  if (mesh.empty() && !test::shared_meshes().empty()) mesh = (test::shared_meshes() / "spot.obj").string();
  Judge judge;
  for (const SweptFamily& family : swept_families(count, mesh)) run(family, seconds, judge);
  std::printf("\n%llu exact queries before the intervals, %llu intervals wrong\n",
              static_cast<unsigned long long>(judge.samples),
              static_cast<unsigned long long>(judge.violations));
  return judge.violations == 0 ? 0 : 1;
}

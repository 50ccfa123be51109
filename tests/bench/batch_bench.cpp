// Batches on one thread and on several, in turn, in one run.
//
//   batch_bench [--threads N] [--poses N] [--rounds N] [BODY...]
//
// BODY: a mesh or an .lrb file, which meets a copy of itself; without any a rock of 20,480 faces and a ring
// of 3,200. Printed for each kind of batch: the least time that a round took on one thread, and on N (2); how
// many times as fast that is; how many times as fast the machine is at N such batches at once, each on a
// thread of its own with nothing in common but the bodies, which no batch that is shared out can beat; and
// the processor's time on N threads over that on one.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "scenarios/bodies/shapes.hpp"
#include "tests/bench/timing.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;

namespace {

struct Options {
  unsigned threads = 2;
  std::size_t poses = 10'000;
  int rounds = 7;
  std::vector<std::string> bodies;
};

Options options_of(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const bool has_value = i + 1 < argc;
    if (std::strcmp(argv[i], "--threads") == 0 && has_value)
      o.threads = static_cast<unsigned>(std::atoi(argv[++i]));
    else if (std::strcmp(argv[i], "--poses") == 0 && has_value)
      o.poses = static_cast<std::size_t>(std::atoll(argv[++i]));
    else if (std::strcmp(argv[i], "--rounds") == 0 && has_value)
      o.rounds = std::atoi(argv[++i]);
    else
      o.bodies.emplace_back(argv[i]);
  }
  return o;
}

/// The least time that something took.
struct Spent {
  double wall = 1e300, processor = 1e300;  ///< seconds
};

template <class Work>
void spend(Spent& least, const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  work();
  least.processor = std::min(least.processor, static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
  least.wall = std::min(least.wall, bench::seconds_since(begin));
}

/// Asks the same batch on as many threads at once, each for itself.
template <class Answers, class Ask>
void ask_at_once(std::vector<Batch>& batches, std::vector<Answers>& answers, const Ask& ask) {
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < batches.size(); ++i)
    threads.emplace_back([&, i] { ask(batches[i], answers[i]); });
  for (std::thread& t : threads) t.join();
}

/// Runs a kind of batch on one thread, on several, and once on each of several, in turn, and prints what they
/// took.
template <class Answers, class Ask>
void compare(const char* kind, const Options& o, const Ask& ask) {
  Batch one(1), several(o.threads);
  Answers answers;
  std::vector<Batch> lone(o.threads);
  for (Batch& b : lone) b = Batch(1);
  std::vector<Answers> lone_answers(o.threads);
  Spent on_one, on_several, at_once;
  for (int round = 0; round < o.rounds; ++round) {
    spend(on_one, [&] { ask(one, answers); });
    spend(on_several, [&] { ask(several, answers); });
    spend(at_once, [&] { ask_at_once(lone, lone_answers, ask); });
  }
  std::printf("  %-16s %9.2f ms  %9.2f ms  x %.2f   machine x %.2f   processor's time x %.3f\n", kind,
              1e3 * on_one.wall, 1e3 * on_several.wall, on_one.wall / on_several.wall,
              o.threads * on_one.wall / at_once.wall, on_several.processor / on_one.processor);
}

void compare_all(const Body& a, const Body& b, const Options& o) {
  shapes::RandomEngine random(1);
  std::vector<Pose> poses;
  std::vector<PosedPair> pairs;
  for (std::size_t i = 0; i < o.poses; ++i) {
    poses.push_back(shapes::random_pose(random, a, b, shapes::uniform(random, 0.3, 1.1)));
    pairs.push_back({&a.rep(), Pose{}, &b.rep(), poses.back()});
  }
  std::printf("%s and %s: %u and %u faces, %zu poses, 1 and %u threads\n", a.name().c_str(), b.name().c_str(),
              a.rep().real_face_count(), b.rep().real_face_count(), poses.size(), o.threads);
  CollideRequest any, contacts, coarse;
  any.mode = Mode::any_pair;
  contacts.contacts = true;
  coarse.tolerance = 0.02 * shapes::box_of(a).diagonal().maxCoeff();
  a.rep().levels();
  b.rep().levels();
  const auto collides = [&](const CollideRequest& request) {
    return [&, request](Batch& batch, CollideAnswers& answers) {
      batch.collide(a, Pose{}, b, poses, request, answers);
    };
  };
  compare<CollideAnswers>("any pair", o, collides(any));
  compare<CollideAnswers>("all pairs", o, collides(CollideRequest{}));
  compare<CollideAnswers>("contacts", o, collides(contacts));
  compare<CollideAnswers>("to a tolerance", o, collides(coarse));
  compare<CollideAnswers>("pairs of bodies", o,
                          [&](Batch& batch, CollideAnswers& answers) { batch.collide(pairs, {}, answers); });
  compare<DistanceAnswers>("distances", o, [&](Batch& batch, DistanceAnswers& answers) {
    batch.distance(a, Pose{}, b, poses, {}, answers);
  });
}

}  // namespace

int main(int argc, char** argv) {
  const Options o = options_of(argc, argv);
  if (o.bodies.empty())
    compare_all(Body::from(shapes::bumpy_sphere(5, 7)).value(), Body::from(shapes::torus(80, 20)).value(), o);
  for (const std::string& path : o.bodies) {
    const Body body = Body::load(path).value();
    compare_all(body, body, o);
  }
}

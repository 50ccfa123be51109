// Batches on one thread and on several. "independent" runs one batch per thread that share only the bodies,
// an upper bound for a batch divided among threads: compare its time per thread. CPU is the processor time of
// all threads.
#include <thread>

#include "bench/micro/poses.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/workspace.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace {

constexpr int kPoses = 4000;

const std::vector<Pose>& poses_of(const Subject& s) {
  static std::vector<Pose> poses;
  static const Subject* whose = nullptr;
  if (whose != &s) {
    shapes::RandomEngine random(1);
    poses.clear();
    for (int i = 0; i < kPoses; ++i)
      poses.push_back(shapes::random_pose(random, s.body, s.body, shapes::uniform(random, 0.3, 1.1)));
    whose = &s;
  }
  return poses;
}

/// ask(batch, poses, answers): queries all poses.
template <class Answers, class Ask>
void add_batch(const Subject& s, const std::string& what, const Ask& ask) {
  const auto measure = [&s, ask](benchmark::State& state, unsigned threads) {
    Batch batch(threads);
    Answers answers;
    for (auto _ : state) ask(batch, poses_of(s), answers);
  };
  const auto many = std::max(2u, std::thread::hardware_concurrency());
  const auto add_one = [&](const std::string& how, unsigned threads) {
    return add(s, what + "/" + how, [measure, threads](benchmark::State& state) { measure(state, threads); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->MeasureProcessCPUTime();
  };
  add_one("1 thread", 1);
  add_one(std::to_string(many) + " threads", many);
  poses_of(s);  // before threads use them
  add_one("independent", 1)->Threads(static_cast<int>(many));
}

void add_all(const Subject& s) {
  CollideRequest any, contacts, coarse;
  any.mode = Mode::any_pair;
  contacts.contacts = true;
  coarse.tolerance = 0.02 * s.size;
  s.body.rep().levels();
  const auto collides = [&s](const CollideRequest& request) {
    return [&s, request](Batch& batch, const std::vector<Pose>& poses, CollideAnswers& answers) {
      batch.collide(s.body, {}, s.body, poses, request, answers);
    };
  };
  add_batch<CollideAnswers>(s, "any pair", collides(any));
  add_batch<CollideAnswers>(s, "all pairs", collides({}));
  add_batch<CollideAnswers>(s, "contacts", collides(contacts));
  add_batch<CollideAnswers>(s, "tolerance", collides(coarse));
  add_batch<CollideAnswers>(s, "pairs of bodies",
                            [&s](Batch& batch, const std::vector<Pose>& poses, CollideAnswers& answers) {
                              std::vector<PosedPair> pairs;
                              for (const Pose& p : poses)
                                pairs.push_back({&s.body.rep(), {}, &s.body.rep(), p});
                              batch.collide(pairs, {}, answers);
                            });
  add_batch<DistanceAnswers>(s, "distances",
                             [&s](Batch& batch, const std::vector<Pose>& poses, DistanceAnswers& answers) {
                               batch.distance(s.body, {}, s.body, poses, {}, answers);
                             });
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv, add_all);
}

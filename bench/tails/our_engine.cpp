#include <algorithm>

#include "bench/methods/triangles.hpp"
#include "bench/tails/engine.hpp"
#include <lrbscope/workspace.hpp>

namespace lrb::tails {
namespace {

class OurEngine : public Engine {
 public:
  OurEngine(const LrbRep& a, const LrbRep& b) : a_(a), b_(b) {}

  std::string name() const override { return "ours"; }

  std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted wanted,
                                const Progress& progress) override {
    std::vector<EngineAnswer> out;
    for (const Pose& pose : poses) {
      const methods::Stopwatch watch;
      CollideResult result = std::move(collide(a_, Pose{}, b_, pose, CollideRequest{}, workspace_).value());
      EngineAnswer& answer = out.emplace_back();
      answer.us = watch.microseconds();
      answer.pairs = result.pairs.size();
      // All pairs of faces that a pair of leaves compares count, as in other engines.
      answer.kinds = {result.counters.box_tests,
                      std::max(result.counters.prefilter_tests, result.counters.face_tests)};
      answer.tests = answer.kinds->boxes + answer.kinds->faces;
      if (wanted.list) answer.list = std::move(result.pairs);
      progress(out.size());
    }
    return out;
  }

 private:
  const LrbRep &a_, &b_;
  Workspace workspace_;
};

}  // namespace

std::unique_ptr<Engine> our_engine(const LrbRep& a, const LrbRep& b) {
  return std::make_unique<OurEngine>(a, b);
}

}  // namespace lrb::tails

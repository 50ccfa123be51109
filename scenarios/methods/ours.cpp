#include "engine/build/build.hpp"
#include "engine/error.hpp"
#include "engine/query/collide_impl.hpp"
#include "scenarios/methods/bodies.hpp"
#include "scenarios/methods/method.hpp"

namespace lrb::methods {
namespace {

struct OurBody : MethodBody {
  explicit OurBody(LrbRep r) : rep(std::move(r)) {}
  LrbRep rep;
};

class Ours : public Method {
 public:
  Ours(Recursion recursion, Predicates predicates) {
    request_.recursion = recursion;
    request_.predicates = predicates;
  }

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    if (request_.recursion != Recursion::complete) {
      try {
        return std::make_unique<OurBody>(build_lrb(real_mesh(rep)));
      } catch (const InputError&) {
        // Not closed or not manifold: then with the regions that it has.
      }
    }
    return std::make_unique<OurBody>(rep);
  }

  MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                     Mode mode) override {
    const LrbRep& rep_a = static_cast<const OurBody&>(a).rep;
    const LrbRep& rep_b = static_cast<const OurBody&>(b).rep;
    request_.mode = mode;
    NullProbe probe;
    const Stopwatch watch;
    CollideResult result = collide(rep_a, pose_a, rep_b, pose_b, request_, context_, probe);
    MethodAnswer answer;
    answer.microseconds = watch.microseconds();
    answer.contact = !result.pairs.empty();
    answer.pairs = std::move(result.pairs);
    answer.inside = result.relation == Relation::a_inside_b || result.relation == Relation::b_inside_a;
    answer.relation = result.relation;
    answer.face_tests = result.counters.face_tests;
    return answer;
  }

 private:
  CollideRequest request_;
  QueryContext context_;
};

MethodInfo our_info(const char* name, const char* title, const char* remark) {
  MethodInfo info;
  info.name = name;
  info.title = title;
  info.remark = remark;
  info.says = Says::relation;
  info.plane = info.moves_exactly = info.own_rep = true;
  return info;
}

}  // namespace

MethodEntry ours() {
  return {
      our_info("ours", "lrbscope, complete", "All pairs and the relation; given the bodies and their poses."),
      []() -> std::unique_ptr<Method> {
        return std::make_unique<Ours>(Recursion::complete, Predicates::exact);
      }};
}

MethodEntry ours_floating() {
  return {our_info("ours-floating", "lrbscope without the exact fallback",
                   "As ours, but the sign of a predicate that double precision cannot decide is guessed from "
                   "its rounded value."),
          []() -> std::unique_ptr<Method> {
            return std::make_unique<Ours>(Recursion::complete, Predicates::floating);
          }};
}

MethodEntry ours_paper() {
  return {
      our_info("ours-paper", "lrbscope, the paper's recursion",
               "Section 4 of the paper to the letter, with exact predicates, on an LRB-rep built from the "
               "body; where none can be built (open, not manifold), on the regions that the body has. "
               "Misses contacts under lids that nothing touches."),
      []() -> std::unique_ptr<Method> {
        return std::make_unique<Ours>(Recursion::paper, Predicates::exact);
      }};
}

}  // namespace lrb::methods

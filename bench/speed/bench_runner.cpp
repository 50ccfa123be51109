#include "bench/speed/bench_runner.hpp"

#include <cstddef>

#include <malloc.h>

#include "bench/methods/triangles.hpp"
#include "bench/speed/metrics.hpp"
#include "bench/workers/worker_json.hpp"
#include "engine/mesh/box_tree.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/pair_distance.hpp>
namespace lrb::speed {

void sweep_caches() {
  constexpr std::size_t kBytes = std::size_t{64} << 20, kLine = 64;
  static std::vector<unsigned char> junk(kBytes, 1);
  for (std::size_t i = 0; i < junk.size(); i += kLine) ++junk[i];
}

double heap_bytes() {
  const struct mallinfo2 m = mallinfo2();
  return static_cast<double>(m.uordblks + m.hblkhd);
}

BenchRunner::BenchRunner(const methods::MethodEntry& entry, std::optional<double> setting, const DataSet& set,
                         bool judges)
    : entry_(entry), info_(entry.info), setting_(setting), set_(set), judges_(judges) {
  if (entry.make != nullptr) method_ = entry.make();
  if (method_ && setting_) method_->set(*setting_);
}

const BenchRunner::Built& BenchRunner::built(std::size_t body, std::size_t side) {
  Built& b = built_[{body, side}];
  if (b.body) return b;
  const BodyFile& file = set_.bodies.at(body);
  const LrbRep rep = load_lrb(set_.folder + "/" + file.file);
  const double before = heap_bytes();
  const methods::Stopwatch watch;
  b.body = method_->build(rep);
  b.seconds = info_.has(methods::Trait::own_rep) ? file.build_seconds : watch.microseconds() / 1e6;
  b.bytes = heap_bytes() - before;
  return b;
}

Record BenchRunner::ask(std::uint64_t question) {
  Record r = blank_record(set_, question, info_.name, setting_);
  const Question& q = set_.questions[question];
  workers::note_failures(r, [&] {
    if (!method_) return ask_number(q, r);
    Errors errors;
    r.all = ask(q, Mode::all_pairs, judges_ ? &errors : nullptr);
    if (judges_) r.errors = errors;
    r.first = ask(q, Mode::first_pair, nullptr);
    const Built &a = built(q.a, 0), &b = built(q.b, 1);
    r.build_seconds = a.seconds + b.seconds;
    r.bytes = a.bytes + b.bytes;
  });
  return r;
}

void BenchRunner::ask_number(const Question& q, Record& r) const {
  const auto placed = [&](std::size_t body, const Pose& pose) {
    return methods::at_pose(load_lrb(set_.folder + "/" + set_.bodies.at(body).file), pose);
  };
  const methods::Question question = {placed(q.a, q.pose_a),
                                      placed(q.b, q.pose_b),
                                      q.from,
                                      q.to,
                                      set_.diagonal,
                                      info_of(q.pose_class).within * set_.diagonal};
  QueryTimes times;
  const methods::Answer answer = ask_again_and_again([&] { return entry_.ask(question, setting_); }, times);
  r.all.cold_us = times.cold_us;
  r.all.hot_us = times.hot_us;
  const Quantity quantity = info_.quantity;
  if (methods::is_list(quantity)) {
    r.all.count = answer.pairs.size();
    r.all.contact = !answer.pairs.empty();
    if (judges_) r.errors = errors_of_answer(set_, q, question.a, question.b, info_, answer);
  } else {
    r.all.lower = answer.lower;
    r.all.upper = answer.upper;
    r.all.contact = quantity == Quantity::first_contact ? answer.lower < methods::kNever
                    : quantity == Quantity::depth       ? answer.upper > 0
                                                        : answer.upper <= 0;
  }
  if (info_.has(methods::Trait::proves)) r.all.error_bound = answer.upper - answer.lower;
}

const LrbRep& BenchRunner::rep(std::size_t body) {
  auto it = reps_.find(body);
  if (it == reps_.end())
    it = reps_.emplace(body, load_lrb(set_.folder + "/" + set_.bodies.at(body).file)).first;
  return it->second;
}

Reply BenchRunner::ask(const Question& q, Mode mode, Errors* errors) {
  const Built &a = built(q.a, 0), &b = built(q.b, 1);
  QueryTimes times;
  methods::Answer answer =
      ask_again_and_again([&] { return method_->query(*a.body, q.pose_a, *b.body, q.pose_b, mode); }, times);
  Reply r;
  r.cold_us = times.cold_us;
  r.hot_us = times.hot_us;
  r.contact = answer.contact;
  r.count = answer.pairs.size();
  r.face_tests = answer.face_tests;
  r.error_bound = answer.error_bound;
  const bool lists = info_.pairs && mode == Mode::all_pairs;
  const bool exact = lists || (info_.pairs && !info_.has(methods::Trait::loose));
  const bool contact = !q.expected.empty();
  r.missed = lists ? methods::without(q.expected, answer.pairs).size() : contact && !r.contact;
  r.extra = exact ? methods::without(answer.pairs, q.expected).size() : r.contact && !contact;
  if (errors != nullptr) *errors = errors_of_answer(set_, q, rep(q.a), rep(q.b), info_, answer);
  return r;
}

std::vector<SimplexPair> exact_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                     double within) {
  if (!(within > 0)) return brute_force(a, pose_a, b, pose_b).pairs;
  std::vector<WorldTriangle> of_b;
  std::vector<Box> boxes;
  const auto box_of = [](const WorldTriangle& t) {
    Box box(t.x[0]);
    return box.extend(t.x[1]).extend(t.x[2]);
  };
  for (SimplexId t = 0; t < b.real_simplex_count(); ++t)
    boxes.push_back(box_of(of_b.emplace_back(b, pose_b, t)));
  const BoxTree tree(boxes);
  std::vector<SimplexPair> pairs;
  for (SimplexId s = 0; s < a.real_simplex_count(); ++s) {
    const WorldTriangle of_a(a, pose_a, s);
    Box box = box_of(of_a);
    // Grown by more than the distance, so that rounding loses no candidate.
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(within * (1 + 1e-12)) +
                                   1e-12 * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs());
    box.min() -= margin;
    box.max() += margin;
    tree.for_each_in(box, [&](std::uint32_t t) {
      if (exact::meet_triangles(of_a.corners().data(), of_b[t].corners().data()) != exact::Meet::disjoint ||
          exact::compare_distance(of_a.corners().data(), of_b[t].corners().data(), 3, within) <= 0)
        pairs.push_back({s, SimplexId(t)});
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace lrb::speed

#include "scenarios/bench/bench_runner.hpp"

#include <algorithm>
#include <iterator>

#include <malloc.h>

#include "engine/core/error.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "scenarios/bench/timed_query.hpp"
#include "scenarios/methods/body_parts.hpp"
#include "scenarios/workers/note_failures.hpp"

namespace lrb::bench {
namespace {

double heap_bytes() {
  const struct mallinfo2 m = mallinfo2();
  return static_cast<double>(m.uordblks + m.hblkhd);
}

std::size_t difference(const std::vector<SimplexPair>& of, const std::vector<SimplexPair>& without) {
  std::vector<SimplexPair> out;
  std::set_difference(of.begin(), of.end(), without.begin(), without.end(), std::back_inserter(out));
  return out.size();
}

}  // namespace

BenchRunner::BenchRunner(const methods::MethodEntry& entry, std::optional<double> setting, const DataSet& set,
                         bool keep)
    : info_(entry.info), method_(entry.make()), setting_(setting), set_(set), keep_(keep) {
  if (setting_) method_->set(*setting_);
}

const BenchRunner::Built& BenchRunner::built(std::size_t body, std::size_t side) {
  Built& b = built_[{body, side}];
  if (b.body) return b;
  const BodyFile& file = set_.bodies.at(body);
  const LrbRep rep = load_lrb(set_.folder + "/" + file.file);
  const double before = heap_bytes();
  const methods::Stopwatch watch;
  b.body = method_->build(rep);
  b.seconds = info_.own_rep ? file.build_seconds : watch.microseconds() / 1e6;
  b.bytes = heap_bytes() - before;
  return b;
}

Record BenchRunner::ask(std::uint64_t question) {
  if (question >= set_.questions.size())
    throw InputError("question " + std::to_string(question) + ": the data set has only " +
                     std::to_string(set_.questions.size()));
  const Question& q = set_.questions[question];
  Record r;
  r.set = set_.name;
  r.method = info_.name;
  r.setting = setting_;
  r.question = question;
  r.pose_class = q.pose_class;
  workers::note_failures(r, [&] {
    r.all = ask(q, Mode::all_pairs);
    r.first = ask(q, Mode::first_pair);
    const Built &a = built(q.a, 0), &b = built(q.b, 1);
    r.build_seconds = a.seconds + b.seconds;
    r.bytes = a.bytes + b.bytes;
  });
  return r;
}

Reply BenchRunner::ask(const Question& q, Mode mode) {
  const Built &a = built(q.a, 0), &b = built(q.b, 1);
  QueryTimes times;
  methods::MethodAnswer answer =
      ask_again_and_again([&] { return method_->query(*a.body, q.pose_a, *b.body, q.pose_b, mode); }, times);
  Reply r;
  r.cold_us = times.cold_us;
  r.hot_us = times.hot_us;
  r.contact = answer.contact;
  r.count = answer.pairs.size();
  r.face_tests = answer.face_tests;
  r.error_bound = answer.error_bound;
  if (info_.pairs && mode == Mode::all_pairs) {
    r.missed = difference(q.expected, answer.pairs);
    r.extra = difference(answer.pairs, q.expected);
  } else if (info_.pairs && !info_.loose) {
    r.missed = r.contact ? 0 : !q.expected.empty();
    r.extra = difference(answer.pairs, q.expected);
  } else {
    r.missed = !r.contact && !q.expected.empty();
    r.extra = r.contact && q.expected.empty();
  }
  if (keep_) {
    r.pairs = std::move(answer.pairs);
    r.points = std::move(answer.points);
  }
  return r;
}

}  // namespace lrb::bench

#include "bench/stability/stability_experiment.hpp"

#include <algorithm>
#include <deque>
#include <iterator>
#include <list>
#include <tuple>

#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb {

template <>
inline constexpr auto kFields<stability::RightAnswer> = std::tuple{
    field("pairs", &stability::RightAnswer::pairs), field("relation", &stability::RightAnswer::relation),
    field("least", &stability::RightAnswer::least, Kept::if_set),
    field("most", &stability::RightAnswer::most, Kept::if_set),
    field("refusal", &stability::RightAnswer::rejection, Kept::if_set)};
static_assert(covers_all_fields<stability::RightAnswer>);

}  // namespace lrb

namespace lrb::stability {

namespace {

std::string why_not(const cases::Case& c) {
  char name = 'A';
  for (const auto& [rep, pose] : {std::pair{c.a, c.pose_a}, std::pair{c.b, c.pose_b}}) {
    for (std::size_t v = 0; v < rep->vertices().size(); ++v)
      if (!pose.apply(rep->vertices()[v]).allFinite())
        return std::string("body ") + name + ", vertex " + std::to_string(v) +
               " is not representable as double";
    ++name;
  }
  return "";
}

}  // namespace

RightAnswer expected_answer(const cases::Case& c) {
  RightAnswer e;
  e.rejection = why_not(c);
  if (!e.rejection.empty()) return e;
  BruteForceResult r = brute_force(*c.a, c.pose_a, *c.b, c.pose_b);
  e.pairs = std::move(r.pairs);
  e.relation = r.relation;
  return e;
}

nlohmann::ordered_json to_json(const RightAnswer& e) {
  return io::record_to_json(e);
}

RightAnswer expected_from(const std::string& line) {
  return io::record_from_json<RightAnswer>(nlohmann::json::parse(line));
}

namespace {

using methods::MethodAnswer;
using methods::MethodInfo;
using methods::Says;

bool is_inside(Relation r) {
  return r == Relation::a_inside_b || r == Relation::b_inside_a;
}

Relation mirrored(Relation r) {
  if (r == Relation::a_inside_b) return Relation::b_inside_a;
  if (r == Relation::b_inside_a) return Relation::a_inside_b;
  return r;
}

const char* in_brief(bool contact, bool inside) {
  return contact ? "contact" : inside ? "inside" : "separate";
}

void compare_pairs(Record& record, const std::vector<SimplexPair>& answered,
                   const std::vector<SimplexPair>& expected) {
  record.missed = methods::without(expected, answered).size();
  record.extra = methods::without(answered, expected).size();
}

void compare_contact(Record& record, bool answered, bool expected) {
  record.missed = expected && !answered;
  record.extra = answered && !expected;
}

void conclude(Record& record, bool relation_matters, bool extra_matters = true) {
  const bool right = record.missed == 0 && (record.extra == 0 || !extra_matters) &&
                     (!relation_matters || record.relation == record.expected_relation);
  record.outcome = right ? Outcome::right : Outcome::wrong;
}

}  // namespace

void judge(Record& record, const MethodInfo& info, const MethodAnswer& answer, const RightAnswer& expected) {
  if (!expected.rejection.empty()) {
    record.outcome = Outcome::wrong;
    record.message = "answered, although " + expected.rejection;
    return;
  }
  record.expected = expected.pairs.size();
  if (info.pairs)
    compare_pairs(record, answer.pairs, expected.pairs);
  else
    compare_contact(record, answer.contact, !expected.pairs.empty());
  if (answer.relation) {
    record.relation = to_string(*answer.relation);
    record.expected_relation = to_string(expected.relation);
  } else if (answer.inside) {
    record.relation = in_brief(answer.contact, *answer.inside);
    record.expected_relation = in_brief(!expected.pairs.empty(), is_inside(expected.relation));
  }
  // For bodies that are not closed, only surface queries are defined.
  conclude(record, answer.relation || expected.relation != Relation::undefined,
           !info.has(methods::Trait::loose) || expected.pairs.empty());
}

void judge_swapped(Record& record, const MethodInfo& info, const MethodAnswer& answer,
                   const MethodAnswer& swapped, bool several) {
  std::vector<SimplexPair> back;
  for (const SimplexPair& p : swapped.pairs) back.push_back({p.b, p.a});
  std::sort(back.begin(), back.end());
  if (info.pairs)
    compare_pairs(record, back, answer.pairs);
  else
    compare_contact(record, swapped.contact, answer.contact);
  bool relation_matters = true;
  if (answer.relation && swapped.relation) {
    record.relation = to_string(mirrored(*swapped.relation));
    record.expected_relation = to_string(*answer.relation);
    relation_matters = !(several && is_inside(*answer.relation) && is_inside(*swapped.relation));
  } else if (answer.inside && swapped.inside) {
    record.relation = in_brief(swapped.contact, *swapped.inside);
    record.expected_relation = in_brief(answer.contact, *answer.inside);
  }
  conclude(record, relation_matters);
}

namespace {

using Seconds = std::chrono::duration<double>;
constexpr Seconds kBruteForceTimeout(120);  // brute force is slow, but never hangs

/// `method`: empty for right answers.
std::vector<std::string> command_of(const std::string& program, Quantity quantity,
                                    const std::string& method) {
  std::vector<std::string> command = {program, "--quantity", std::string(name_of(quantity))};
  if (!method.empty()) command.insert(command.end(), {"--method", method});
  return command;
}

nlohmann::ordered_json question_of(const Record& of) {
  return {{"family", of.family}, {"difficulty", of.difficulty}, {"case", of.case_index}, {"seed", of.seed}};
}

/// The state of one family while its jobs run.
struct FamilyWork {
  std::string name;
  workers::MemoryFile expected{"expected"};   ///< one line per case, from begin_ on
  std::vector<std::uint64_t> expected_pairs;  ///< number of pairs, by case
  bool expected_done = false;
  std::vector<std::vector<Record>> records;  ///< method by method
  std::size_t methods_begun = 0, methods_done = 0;
};

/// The records of an experiment while it runs.
class Unfinished {
 public:
  Unfinished(const std::string& path, const std::string& head) : file_(path, head) {
    for (const std::string& line : file_.lines()) {
      const Record r = record_from(nlohmann::json::parse(line, nullptr, false));
      known_[key_of(r)] = r;
    }
  }

  /// Returns the record of the same case and method of an earlier run, or null.
  const Record* find(const Record& of) const {
    const auto it = known_.find(key_of(of));
    return it == known_.end() ? nullptr : &it->second;
  }

  void add(const Record& r) { file_.add(to_json(r).dump()); }
  void remove() const { file_.remove(); }

 private:
  using RecordKey = std::tuple<std::string, std::string, int, std::uint64_t>;
  static RecordKey key_of(const Record& r) { return {r.family, r.method, r.difficulty, r.case_index}; }

  io::UnfinishedFile file_;
  std::map<RecordKey, Record> known_;
};

/// Describes the run whose records can be continued: the version, and what else their outcomes depend on.
std::string head_of(const ExperimentOptions& o) {
  return nlohmann::ordered_json{{"lrbscope", trace::lrbscope_version()},
                                {"quantity", name_of(o.quantity)},
                                {"seed", o.seed},
                                {"timeout", o.timeout}}
      .dump();
}

class Experiment {
 public:
  Experiment(const ExperimentOptions& options, const ProgressFunction& progress)
      : o_(options), progress_(progress), unfinished_(options.unfinished_file, head_of(options)) {
    std::erase_if(o_.methods, [](const workers::WorkerMethod& m) { return !m.info.present; });
    begin_ = o_.difficulty ? static_cast<std::uint64_t>(*o_.difficulty) * o_.cases : 0;
    end_ = o_.difficulty ? begin_ + o_.cases : cases::kDifficulties * o_.cases;
    total_ = o_.families.size() * (o_.methods.size() + 1) * (end_ - begin_);
  }

  std::vector<Record> run() {
    if (o_.methods.empty() || o_.families.empty()) return {};
    while (true) {
      while (running_.size() < o_.jobs && start_one()) {
      }
      if (running_.empty()) break;
      std::vector<workers::Job*> jobs;
      for (const Running& r : running_) jobs.push_back(r.job.get());
      workers::wait_for_news(jobs);
      std::erase_if(running_, [](const Running& r) {
        if (r.job->done()) r.on_done();
        return r.job->done();
      });
    }
    unfinished_.remove();
    return std::move(records_);
  }

 private:
  struct Running {
    std::unique_ptr<workers::Job> job;
    std::function<void()> on_done;
  };

  /// Starts the next method of a family with known right answers, or else the computation of the right
  /// answers of the next family.
  bool start_one() {
    for (const auto& family : open_)
      if (family->expected_done && family->methods_begun < o_.methods.size()) {
        start_method(*family, family->methods_begun++);
        return true;
      }
    if (next_family_ == o_.families.size()) return false;
    open_.push_back(std::make_unique<FamilyWork>());
    open_.back()->name = o_.families[next_family_++];
    open_.back()->records.resize(o_.methods.size());
    start_expected(*open_.back());
    return true;
  }

  void start_expected(FamilyWork& family) {
    workers::Job::Task task;
    task.command = command_of(o_.methods.front().program, o_.quantity, "");
    task.question = [this, &family](std::uint64_t k) { return question_of(record(family, k)).dump(); };
    task.begin = begin_;
    task.end = end_;
    task.limit = kBruteForceTimeout;
    task.on_line = [this, &family](std::uint64_t, const std::string& line) {
      family.expected.write(line + "\n");
      family.expected_pairs.push_back(expected_from(line).pairs.size());
      notify(family.name + ", exact brute force");
    };
    task.on_failure = [this, &family](std::uint64_t k, const workers::WorkerFailure& failure) {
      throw EnvironmentError("exact brute force, family " + family.name + ", difficulty " +
                             std::to_string(k / o_.cases) + ", case " + std::to_string(k % o_.cases) + ": " +
                             failure.message + "; please report it");
    };
    running_.push_back(
        {std::make_unique<workers::Job>(std::move(task)), [&family] { family.expected_done = true; }});
  }

  void start_method(FamilyWork& family, std::size_t m) {
    const workers::WorkerMethod& method = o_.methods[m];
    workers::Job::Task task;
    task.command = command_of(method.program, o_.quantity, method.info.name);
    task.question = [this, &family](std::uint64_t k) {
      nlohmann::ordered_json out = question_of(record(family, k));
      out["right"] = family.expected.path();
      out["line"] = k - begin_;
      return out.dump();
    };
    task.begin = begin_;
    task.end = end_;
    for (; task.begin < end_; ++task.begin) {
      const Record* known = unfinished_.find(record(family, task.begin, method.info.name));
      if (known == nullptr) break;
      family.records[m].push_back(*known);
      notify(family.name + ", " + method.info.name);
    }
    const auto on_done = [this, &family] {
      ++family.methods_done;
      hand_over_finished();
    };
    if (task.begin == end_) return on_done();
    task.limit = Seconds(o_.timeout);
    task.on_line = [this, &family, m](std::uint64_t, const std::string& line) {
      keep(family, m, record_from(nlohmann::json::parse(line)));
    };
    task.on_failure = [this, &family, m](std::uint64_t k, const workers::WorkerFailure& failure) {
      Record r = record(family, k, o_.methods[m].info.name);
      r.expected = family.expected_pairs[k - begin_];
      workers::note_failure(r, failure);
      keep(family, m, std::move(r));
    };
    running_.push_back({std::make_unique<workers::Job>(std::move(task)), on_done});
  }

  /// Returns the record of case k, without an answer.
  Record record(const FamilyWork& family, std::uint64_t k, const std::string& method = "") const {
    Record r;
    r.family = family.name;
    r.method = method;
    r.difficulty = static_cast<int>(k / o_.cases);
    r.case_index = k % o_.cases;
    r.seed = o_.seed;
    return r;
  }

  void keep(FamilyWork& family, std::size_t m, Record record) {
    unfinished_.add(record);
    family.records[m].push_back(std::move(record));
    notify(family.name + ", " + o_.methods[m].info.name);
  }

  /// Passes on finished families in their order.
  void hand_over_finished() {
    while (!open_.empty() && open_.front()->methods_done == o_.methods.size()) {
      for (std::vector<Record>& r : open_.front()->records)
        std::move(r.begin(), r.end(), std::back_inserter(records_));
      open_.pop_front();
    }
  }

  void notify(const std::string& what) {
    ++done_;
    if (progress_) progress_(done_, total_, what);
  }

  ExperimentOptions o_;
  const ProgressFunction& progress_;
  Unfinished unfinished_;
  std::uint64_t begin_ = 0, end_ = 0, done_ = 0, total_ = 0;
  std::size_t next_family_ = 0;
  std::deque<std::unique_ptr<FamilyWork>> open_;
  std::vector<Record> records_;
  std::list<Running> running_;  // declared after what its jobs refer to
};

}  // namespace

std::vector<Record> run_experiment(const ExperimentOptions& options, const ProgressFunction& progress) {
  return Experiment(options, progress).run();
}

bool Replay::ask(workers::Worker& worker, nlohmann::ordered_json question, const std::string& right,
                 std::chrono::duration<double> limit) {
  question.update({{"right", right}, {"line", 0}, {"pairs", true}});
  workers::WorkerFailure failure;
  const std::optional<std::string> line = worker.ask(question.dump(), limit, failure);
  if (!line) {
    record.expected = expected.size();
    workers::note_failure(record, failure);
    return false;
  }
  const auto value = nlohmann::json::parse(*line);
  record = record_from(value);
  if (value.contains("answered_pairs")) answered = workers::PairsJson::read(value.at("answered_pairs"));
  return true;
}

Replay replay(const workers::WorkerMethod& method, const Record& of, double timeout, Quantity quantity) {
  Replay out;
  out.record = with_case({}, of);
  out.record.method = method.info.name;
  workers::WorkerFailure failure;
  const auto right = workers::Worker(command_of(method.program, quantity, ""))
                         .ask(question_of(of).dump(), kBruteForceTimeout, failure);
  if (!right) throw EnvironmentError("exact brute force: " + failure.message + "; please report it");
  out.expected = expected_from(*right).pairs;
  const workers::MemoryFile file("expected");
  file.write(*right + "\n");
  workers::Worker worker(command_of(method.program, quantity, method.info.name));
  out.ask(worker, question_of(of), file.path(), Seconds(timeout));
  return out;
}

StabilityRunner::Posed StabilityRunner::place(const LrbRep& rep, const Pose& pose, int side) {
  if (!info_.has(methods::Trait::moves_exactly)) return {method_->build(methods::at_pose(rep, pose)), Pose{}};
  static constexpr std::size_t kMaxKept = 200;
  if (kept_.size() > kMaxKept) kept_.clear();
  BodyPointer& body = kept_[{rep.hash(), side}];
  if (!body) body = method_->build(rep);
  return {body, pose};
}

void StabilityRunner::ask(const cases::Family& family, const cases::Case& c, const RightAnswer& expected,
                          Record& record) {
  pairs_.reset();
  const Mode mode = info_.pairs ? Mode::all_pairs : Mode::first_pair;
  record.expected = expected.pairs.size();
  workers::note_failures(record, [&] {
    if (c.a->dim() == 2 && !info_.has(methods::Trait::takes_2d))
      throw InputError("skipped: a 2D body, but the method supports only 3D");
    if (!expected.rejection.empty() && !info_.has(methods::Trait::moves_exactly))
      throw InputError("skipped: " + expected.rejection);
    const Posed a = place(*c.a, c.pose_a, 0), b = place(*c.b, c.pose_b, 1);
    methods::MethodAnswer answer = method_->query(*a.body, a.pose, *b.body, b.pose, mode);
    record.microseconds = answer.microseconds;
    if (family.both_ways) {
      const bool several = c.a->component_vertices().size() > 1 && c.b->component_vertices().size() > 1;
      judge_swapped(record, info_, answer, method_->query(*b.body, b.pose, *a.body, a.pose, mode), several);
    } else {
      judge(record, info_, answer, expected);
    }
    if (info_.pairs) pairs_ = std::move(answer.pairs);
  });
}

}  // namespace lrb::stability

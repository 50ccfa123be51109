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
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb {

template <>
inline constexpr auto kFields<stability::RightAnswer> =
    std::tuple{field("pairs", &stability::RightAnswer::pairs),
               field("relation", &stability::RightAnswer::relation),
               field("least", &stability::RightAnswer::least, Kept::if_set),
               field("most", &stability::RightAnswer::most, Kept::if_set),
               field("size", &stability::RightAnswer::size, Kept::if_set),
               field("several", &stability::RightAnswer::several, Kept::if_set),
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
  e.several = c.a->component_vertices().size() > 1 && c.b->component_vertices().size() > 1;
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

using methods::Answer;
using methods::MethodInfo;

const char* in_brief(bool contact, bool inside) {
  return contact ? "contact" : inside ? "inside" : "separate";
}

/// Counts what an answer misses and adds: pairs, or contacts for a method that lists no pairs.
void compare(Record& record, const MethodInfo& info, const std::vector<SimplexPair>& answered, bool contact,
             const std::vector<SimplexPair>& expected, bool expected_contact) {
  record.missed = info.pairs ? methods::without(expected, answered).size() : expected_contact && !contact;
  record.extra = info.pairs ? methods::without(answered, expected).size() : contact && !expected_contact;
}

void conclude(Record& record, bool is_right) {
  record.outcome = is_right ? Outcome::right : Outcome::wrong;
}

void judge_pairs(Record& record, const MethodInfo& info, const Answer& answer, const RightAnswer& expected) {
  const bool contact = !expected.pairs.empty();
  compare(record, info, answer.pairs, answer.contact, expected.pairs, contact);
  if (answer.relation) {
    record.relation = to_string(*answer.relation);
    record.expected_relation = to_string(expected.relation);
  } else if (answer.inside) {
    record.relation = in_brief(answer.contact, *answer.inside);
    record.expected_relation = in_brief(contact, is_inside(expected.relation));
  }
  // For bodies that are not closed, only surface queries are defined.
  const bool relation_matters = answer.relation || expected.relation != Relation::undefined;
  const bool extra_matters = !info.has(methods::Trait::loose) || !contact;
  conclude(record, record.missed == 0 && (record.extra == 0 || !extra_matters) &&
                       (!relation_matters || record.relation == record.expected_relation));
}

void judge_exchanged(Record& record, const MethodInfo& info, const Answer& answer, const Answer& exchanged,
                     bool several) {
  std::vector<SimplexPair> back;
  for (const SimplexPair& p : exchanged.pairs) back.push_back({p.b, p.a});
  std::sort(back.begin(), back.end());
  compare(record, info, back, exchanged.contact, answer.pairs, answer.contact);
  bool relation_matters = true;
  if (answer.relation && exchanged.relation) {
    record.relation = to_string(mirrored(*exchanged.relation));
    record.expected_relation = to_string(*answer.relation);
    relation_matters = !(several && is_inside(*answer.relation) && is_inside(*exchanged.relation));
  } else if (answer.inside && exchanged.inside) {
    record.relation = in_brief(exchanged.contact, *exchanged.inside);
    record.expected_relation = in_brief(answer.contact, *answer.inside);
  }
  conclude(record, record.missed + record.extra == 0 &&
                       (!relation_matters || record.relation == record.expected_relation));
}

std::string number_text(Quantity quantity, double lower, double upper) {
  constexpr int kDigits = 9;
  if (quantity == Quantity::first_contact && lower >= methods::kNever) return "never";
  const std::string first = io::number_text(lower, kDigits), last = io::number_text(upper, kDigits);
  return first == last ? first : first + " to " + last;
}

/// Returns true if an interval is the special value of its quantity: 0 ("in contact") or kNever.
bool is_special(Quantity quantity, double least, double most) {
  return quantity == Quantity::first_contact ? least >= methods::kNever : most <= 0;
}

void judge_number(Record& record, const MethodInfo& info, const Answer& answer, const RightAnswer& expected) {
  constexpr double kMaxOffOfSize = 1e-6, kMaxOffOfMotion = 1e-3;
  const double least = expected.least.value(), most = expected.most.value();
  record.relation = number_text(info.quantity, answer.lower, answer.upper);
  record.expected_relation = number_text(info.quantity, least, most);
  const bool special = is_special(info.quantity, least, most);
  bool right = is_special(info.quantity, answer.lower, answer.upper) == special;
  if (info.has(methods::Trait::proves)) {
    right = right && answer.lower <= most && answer.upper >= least;
  } else if (!special) {
    const double deviation = std::max(least - answer.upper, answer.lower - most);
    const bool is_time = info.quantity == Quantity::first_contact;
    right = right && deviation <= (is_time ? kMaxOffOfMotion : kMaxOffOfSize * expected.size);
  }
  conclude(record, right);
}

}  // namespace

void judge(Record& record, const MethodInfo& info, const Answer& answer, const RightAnswer& expected) {
  const bool of_pairs = info.quantity == Quantity::pairs, is_undefined = !expected.rejection.empty();
  record.expected = expected.pairs.size();
  record.outcome = answer.outcome;
  record.message = answer.message;
  if (is_undefined && !of_pairs) {
    record.outcome = Outcome::rejected;
    record.message = "skipped: " + expected.rejection;
  }
  if (record.outcome != Outcome::answered) return;
  record.microseconds = answer.microseconds;
  if (!answer.exchanged.empty()) {
    judge_exchanged(record, info, answer, answer.exchanged.front(), expected.several);
  } else if (is_undefined) {
    record.outcome = Outcome::wrong;
    record.message = "answered, although " + expected.rejection;
  } else if (of_pairs) {
    judge_pairs(record, info, answer, expected);
  } else if (methods::is_list(info.quantity)) {
    compare(record, info, answer.pairs, answer.contact, expected.pairs, false);
    record.relation = std::to_string(answer.pairs.size()) + " pairs";
    record.expected_relation = std::to_string(expected.pairs.size()) + " pairs";
    conclude(record, record.missed + record.extra == 0);
  } else {
    judge_number(record, info, answer, expected);
  }
}

Replay::Replay(const Record& of, const MethodInfo& info, Answer answer, const RightAnswer& right)
    : record(of), expected(right.pairs) {
  record.method = info.name;
  judge(record, info, answer, right);
  const bool is_answer = record.outcome == Outcome::right || record.outcome == Outcome::wrong;
  if (is_answer && info.pairs && methods::is_list(info.quantity)) answered = std::move(answer.pairs);
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
  std::vector<RightAnswer> expected;  ///< by case, from begin_ on
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
      std::vector<workers::Worker*> busy;
      for (const Running& r : running_) busy.push_back(r.worker.get());
      workers::wait_for_news(busy);
      std::erase_if(running_, [](const Running& r) {
        if (r.worker->done()) r.on_done();
        return r.worker->done();
      });
    }
    unfinished_.remove();
    return std::move(records_);
  }

 private:
  struct Running {
    std::unique_ptr<workers::Worker> worker;
    std::function<void()> on_done;
  };

  void start(std::vector<std::string> command, workers::Worker::Task task, std::function<void()> on_done) {
    running_.push_back({std::make_unique<workers::Worker>(std::move(command)), std::move(on_done)});
    running_.back().worker->begin(std::move(task));
  }

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

  workers::Worker::Task task_for(const FamilyWork& family) const {
    workers::Worker::Task task;
    task.question = [this, &family](std::uint64_t k) { return question_of(record(family, k)).dump(); };
    task.begin = begin_, task.end = end_;
    return task;
  }

  void start_expected(FamilyWork& family) {
    workers::Worker::Task task = task_for(family);
    task.limit = kBruteForceTimeout;
    task.on_line = [this, &family](std::uint64_t, const std::string& line) {
      family.expected.push_back(expected_from(line));
      notify(family.name + ", exact brute force");
    };
    task.on_failure = [this, &family](std::uint64_t k, const workers::WorkerFailure& failure) {
      throw EnvironmentError("exact brute force, family " + family.name + ", difficulty " +
                             std::to_string(k / o_.cases) + ", case " + std::to_string(k % o_.cases) + ": " +
                             failure.message + "; please report it");
    };
    start(command_of(o_.methods.front().program, o_.quantity, ""), std::move(task),
          [&family] { family.expected_done = true; });
  }

  void start_method(FamilyWork& family, std::size_t m) {
    const workers::WorkerMethod& method = o_.methods[m];
    workers::Worker::Task task = task_for(family);
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
    task.on_line = [this, &family, m](std::uint64_t k, const std::string& line) {
      keep(family, m, k, workers::answer_from(nlohmann::json::parse(line)));
    };
    task.on_failure = [this, &family, m](std::uint64_t k, const workers::WorkerFailure& failure) {
      methods::Answer none;
      workers::note_failure(none, failure);
      keep(family, m, k, none);
    };
    start(command_of(method.program, o_.quantity, method.info.name), std::move(task), on_done);
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

  void keep(FamilyWork& family, std::size_t m, std::uint64_t k, const methods::Answer& answer) {
    Record r = record(family, k, o_.methods[m].info.name);
    judge(r, o_.methods[m].info, answer, family.expected[k - begin_]);
    unfinished_.add(r);
    family.records[m].push_back(std::move(r));
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
  std::list<Running> running_;  // declared after what its tasks refer to
};

}  // namespace

std::vector<Record> run_experiment(const ExperimentOptions& options, const ProgressFunction& progress) {
  return Experiment(options, progress).run();
}

Replay replay(const workers::WorkerMethod& method, const Record& of, double timeout, Quantity quantity) {
  workers::WorkerFailure failure;
  const auto right = workers::Worker(command_of(method.program, quantity, ""))
                         .ask(question_of(of).dump(), kBruteForceTimeout, failure);
  if (!right) throw EnvironmentError("exact brute force: " + failure.message + "; please report it");
  workers::Worker worker(command_of(method.program, quantity, method.info.name));
  return {with_case({}, of), method.info, workers::answer_of(worker, question_of(of), Seconds(timeout)),
          expected_from(*right)};
}

StabilityRunner::Posed StabilityRunner::place(const LrbRep& rep, const Pose& pose, int side) {
  if (!info_.has(methods::Trait::moves_exactly)) return {method_->build(methods::at_pose(rep, pose)), Pose{}};
  static constexpr std::size_t kMaxKept = 200;
  if (kept_.size() > kMaxKept) kept_.clear();
  BodyPointer& body = kept_[{rep.hash(), side}];
  if (!body) body = method_->build(rep);
  return {body, pose};
}

methods::Answer StabilityRunner::ask(const cases::Case& c, bool both_ways) {
  const Mode mode = info_.pairs ? Mode::all_pairs : Mode::first_pair;
  methods::Answer out;
  workers::note_failures(out, [&] {
    if (c.a->dim() == 2 && !info_.has(methods::Trait::takes_2d))
      throw InputError("skipped: a 2D body, but the method supports only 3D");
    if (const std::string why = why_not(c); !why.empty() && !info_.has(methods::Trait::moves_exactly))
      throw InputError("skipped: " + why);
    const Posed a = place(*c.a, c.pose_a, 0), b = place(*c.b, c.pose_b, 1);
    methods::Answer answer = method_->query(*a.body, a.pose, *b.body, b.pose, mode);
    if (both_ways) answer.exchanged = {method_->query(*b.body, b.pose, *a.body, a.pose, mode)};
    out = std::move(answer);
  });
  return out;
}

}  // namespace lrb::stability

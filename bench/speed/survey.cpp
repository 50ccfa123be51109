#include "bench/speed/survey.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <tuple>

#include "bench/workers/workers.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::bench {
namespace {

using Key = std::tuple<std::string, std::string, std::uint64_t>;  // set, method at its setting, question

/// A file to which lines are appended; each is flushed at once.
class Appender {
 public:
  explicit Appender(const std::string& path) : path_(path), out_(path, std::ios::app) {}
  void add(const std::string& line) {
    if (!(out_ << line << "\n" << std::flush))
      throw EnvironmentError(printable_name(path_) + ": cannot write the file: " + std::strerror(errno));
  }

 private:
  std::string path_;
  std::ofstream out_;
};

class Survey {
 public:
  Survey(const SurveyOptions& options, const SurveyProgress& progress)
      : o_(options), progress_(progress), file_(options.folder + "/records.jsonl") {
    for (const DataSet& s : o_.sets) total_ += s.questions.size() * o_.contestants.size();
  }

  std::vector<Record> run() {
    for (Record& r : read_records(o_.folder + "/records.jsonl")) known_[key(r)] = std::move(r);
    for (const DataSet& set : o_.sets) {
      // The queries of a class are contiguous.
      for (std::uint64_t begin = 0, end = 0; begin < set.questions.size(); begin = end) {
        while (end < set.questions.size() && set.questions[end].pose_class == set.questions[begin].pose_class)
          ++end;
        for (const Contestant& c : o_.contestants) ask(set, c, begin, end);
      }
    }
    return collect();
  }

 private:
  static Key key(const Record& r) { return {r.set, name_of(r), r.question}; }

  void ask(const DataSet& set, const Contestant& c, std::uint64_t begin, std::uint64_t end) {
    const std::string name = name_of(c.method.column.name, c.setting);
    for (; begin < end && known_.count({set.name, name, begin}) != 0; ++begin) notify(set.name + ", " + name);
    if (begin == end) return;
    workers::Job::Task task;
    task.command = {c.method.program, "--questions", o_.folder + "/" + set.name + ".set.json", "--method",
                    c.method.column.name};
    if (c.setting) task.command.insert(task.command.end(), {"--setting", exactly(*c.setting)});
    if (o_.keep) task.command.push_back("--pairs");
    task.begin = begin;
    task.end = end;
    task.limit =
        std::chrono::duration_cast<workers::Job::Clock::duration>(std::chrono::duration<double>(o_.timeout));
    task.on_line = [&](std::uint64_t, const std::string& line) {
      keep(record_from(nlohmann::json::parse(line)), line);
      notify(set.name + ", " + name);
    };
    task.on_failure = [&](std::uint64_t k, const workers::WorkerFailure& failure) {
      Record r;
      r.set = set.name;
      r.method = c.method.column.name;
      r.setting = c.setting;
      r.question = k;
      r.pose_class = set.questions[k].pose_class;
      r.outcome = failure.timed_out ? Outcome::timed_out : Outcome::crashed;
      r.message = failure.message;
      const std::string line = to_json(r).dump();
      keep(std::move(r), line);
      notify(set.name + ", " + name);
    };
    workers::run_to_end(workers::Job(std::move(task)));
  }

  void keep(Record r, const std::string& line) {
    file_.add(line);
    known_[key(r)] = std::move(r);
  }

  /// Returns the requested records, in order.
  std::vector<Record> collect() const {
    std::vector<Record> out;
    for (const DataSet& set : o_.sets)
      for (const Contestant& c : o_.contestants)
        for (std::uint64_t q = 0; q < set.questions.size(); ++q)
          out.push_back(known_.at({set.name, name_of(c.method.column.name, c.setting), q}));
    return out;
  }

  static std::string exactly(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
  }

  void notify(const std::string& what) {
    ++done_;
    if (progress_) progress_(done_, total_, what);
  }

  const SurveyOptions& o_;
  const SurveyProgress& progress_;
  Appender file_;
  std::map<Key, Record> known_;
  std::uint64_t done_ = 0, total_ = 0;
};

}  // namespace

std::vector<Contestant> contestants(const std::vector<workers::WorkerMethod>& methods) {
  std::vector<Contestant> out;
  for (const workers::WorkerMethod& m : methods) {
    if (!m.info.present) continue;
    if (m.info.settings.empty()) out.push_back({m, std::nullopt});
    for (const double s : m.info.settings) out.push_back({m, s});
  }
  return out;
}

std::vector<Record> survey(const SurveyOptions& options, const SurveyProgress& progress) {
  return Survey(options, progress).run();
}

}  // namespace lrb::bench

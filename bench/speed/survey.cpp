#include "bench/speed/survey.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "bench/workers/worker_json.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::speed {
namespace {

// set, method at its setting, question, round
using RecordKey = std::tuple<std::string, std::string, std::uint64_t, std::uint64_t>;

RecordKey key_of(const Record& r) {
  return {r.set, name_of(r), r.question, r.round};
}

/// Returns true if an answer need not be measured: it is known, or the answer in round 0 failed.
bool is_done(const std::map<RecordKey, Record>& known, RecordKey key) {
  if (known.count(key) > 0) return true;
  std::get<3>(key) = 0;
  const auto first = known.find(key);
  return first != known.end() && first->second.outcome != Outcome::answered;
}

class Survey {
 public:
  Survey(const SurveyOptions& options, const SurveyProgress& progress)
      : o_(options), progress_(progress), file_(options.folder + "/records.jsonl") {
    for (const DataSet& s : o_.sets) total_ += o_.rounds * s.questions.size() * o_.contestants.size();
  }

  std::vector<Record> run() {
    for (Record& r : read_records(o_.folder + "/records.jsonl"))
      if (!lacks_errors(r)) known_[key_of(r)] = std::move(r);
    for (unsigned round = 0; round < o_.rounds; ++round)
      for (const DataSet& set : o_.sets) {
        // The queries of a class are contiguous.
        for (std::uint64_t begin = 0, end = 0; begin < set.questions.size(); begin = end) {
          while (end < set.questions.size() &&
                 set.questions[end].pose_class == set.questions[begin].pose_class)
            ++end;
          for (const Contestant& c : o_.contestants) ask(set, c, round, begin, end);
        }
      }
    return collect();
  }

 private:
  /// True for records without the errors that this survey needs; they are measured again.
  bool lacks_errors(const Record& r) const {
    return o_.judges && r.round == 0 && r.outcome == Outcome::answered && !r.errors && !r.all.upper;
  }

  void ask(const DataSet& set, const Contestant& c, unsigned round, std::uint64_t begin, std::uint64_t end) {
    const std::string name = name_of(c.method.info.name, c.setting);
    const std::string what = set.name + ", " + name;
    while (begin < end) {
      for (; begin < end && is_done(known_, {set.name, name, begin, round}); ++begin) notify(what);
      std::uint64_t stop = begin;
      while (stop < end && !is_done(known_, {set.name, name, stop, round})) ++stop;
      if (begin < stop) run(set, c, round, begin, stop);
      begin = stop;
    }
  }

  void run(const DataSet& set, const Contestant& c, unsigned round, std::uint64_t begin, std::uint64_t end) {
    const std::string what = set.name + ", " + name_of(c.method.info.name, c.setting);
    workers::Worker::Task task;
    task.question = [&](std::uint64_t k) {
      nlohmann::ordered_json question = {{"set", o_.folder + "/" + set.name + ".set.json"}, {"question", k}};
      if (c.setting) question["setting"] = *c.setting;
      if (o_.judges && round == 0) question["errors"] = true;
      return question.dump();
    };
    task.begin = begin;
    task.end = end;
    task.limit = std::chrono::duration<double>(o_.timeout);
    task.on_line = [&](std::uint64_t, const std::string& line) {
      Record r = record_from(nlohmann::json::parse(line));
      r.method = c.method.info.name;
      r.round = round;
      keep(std::move(r));
      notify(what);
    };
    task.on_failure = [&](std::uint64_t k, const workers::WorkerFailure& failure) {
      Record r = blank_record(set, k, c.method.info.name, c.setting);
      r.round = round;
      workers::note_failure(r, failure);
      keep(std::move(r));
      notify(what);
    };
    workers::Worker(c.method.command).run(std::move(task));
  }

  void keep(Record r) {
    file_.add(to_json(r).dump());
    known_[key_of(r)] = std::move(r);
  }

  /// Returns the requested records, in order.
  std::vector<Record> collect() const {
    std::vector<Record> out;
    for (const DataSet& set : o_.sets)
      for (const Contestant& c : o_.contestants)
        for (std::uint64_t q = 0; q < set.questions.size(); ++q)
          for (unsigned round = 0; round < o_.rounds; ++round)
            if (const auto it = known_.find({set.name, name_of(c.method.info.name, c.setting), q, round});
                it != known_.end())
              out.push_back(it->second);
    return out;
  }

  void notify(const std::string& what) {
    ++done_;
    if (progress_) progress_(done_, total_, what);
  }

  const SurveyOptions& o_;
  const SurveyProgress& progress_;
  io::LineAppender file_;
  std::map<RecordKey, Record> known_;
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

namespace {

std::string plan_file(const std::string& folder) {
  return folder + "/survey.json";
}

/// Adds the words that a list does not have yet.
void merge(nlohmann::ordered_json& list, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
}

nlohmann::ordered_json read_plan(const std::string& folder) {
  if (!std::filesystem::exists(plan_file(folder))) return nullptr;
  const std::string text = io::read_text(plan_file(folder));
  nlohmann::ordered_json plan = nlohmann::ordered_json::parse(text, nullptr, false);
  const auto is_list = [&](const char* key) { return plan.contains(key) && plan[key].is_array(); };
  const bool is_plan = plan.is_object() && is_list("sets") && is_list("methods") && plan.contains("rounds") &&
                       plan["rounds"].is_number_unsigned();
  if (!is_plan)
    throw InputError(printable_name(plan_file(folder)) +
                     ": expected the plan of a survey, found another text; delete it and measure again");
  return plan;
}

}  // namespace

void write_plan(const SurveyOptions& options, const std::vector<std::string>& sets) {
  nlohmann::ordered_json plan = read_plan(options.folder);
  if (plan.is_null())
    plan = {{"sets", nlohmann::ordered_json::array()},
            {"methods", nlohmann::ordered_json::array()},
            {"rounds", 1}};
  merge(plan["sets"], sets);
  std::vector<std::string> names;
  for (const Contestant& c : options.contestants) names.push_back(name_of(c.method.info.name, c.setting));
  merge(plan["methods"], names);
  plan["rounds"] = std::max(plan["rounds"].get<unsigned>(), options.rounds);
  io::write_text(plan_file(options.folder), plan.dump() + "\n");
}

std::vector<Missing> missing_answers(const std::string& folder, const std::vector<DataSet>& sets,
                                     const std::vector<Record>& records) {
  const nlohmann::ordered_json plan = read_plan(folder);
  if (plan.is_null()) return {};
  std::map<RecordKey, Record> known;
  for (const Record& r : records) known[key_of(r)] = r;
  std::vector<Missing> out;
  bool any = false;
  for (const std::string name : plan["sets"]) {
    const auto set = std::find_if(sets.begin(), sets.end(), [&](const DataSet& s) { return s.name == name; });
    Missing m{name, 0, 0};
    if (set == sets.end()) {  // its poses were not chosen yet
      m.planned = m.missing = 1;
    } else {
      for (const auto& method : plan["methods"])
        for (std::uint64_t q = 0; q < set->questions.size(); ++q)
          for (std::uint64_t round = 0; round < plan["rounds"].get<unsigned>(); ++round) {
            ++m.planned;
            m.missing += !is_done(known, {m.set, method, q, round});
          }
    }
    any = any || m.missing > 0;
    out.push_back(std::move(m));
  }
  if (!any) out.clear();
  return out;
}

std::string missing_text(const std::vector<Missing>& missing) {
  std::string whole, parts;
  std::size_t none = 0;
  for (const Missing& m : missing) {
    if (m.missing == m.planned) {
      whole += (whole.empty() ? "" : ", ") + m.set;
      ++none;
    } else if (m.missing > 0) {
      parts += (parts.empty() ? "" : ", ") + std::to_string(m.missing) + " of " + std::to_string(m.planned) +
               " of " + m.set;
    }
  }
  if (whole.empty() && parts.empty()) return "";
  std::string out = "The survey is unfinished.";
  if (none > 0)
    out += " No answers yet for " + std::to_string(none) + " of " + std::to_string(missing.size()) +
           " pairs of bodies: " + whole + ".";
  if (!parts.empty()) out += " Missing answers: " + parts + ".";
  return out + " The command that began it continues it.";
}

}  // namespace lrb::speed

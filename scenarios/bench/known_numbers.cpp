#include "scenarios/bench/known_numbers.hpp"

#include <nlohmann/json.hpp>

#include "engine/core/error.hpp"
#include "scenarios/workers/job.hpp"
#include "scenarios/workers/workers.hpp"

namespace lrb::bench {

void find_numbers(DataSet& set) {
  constexpr std::chrono::seconds kLimit(120);  // for one question; some depths take seconds
  workers::Job::Task task;
  task.command = {workers::number_worker(), "--questions", write_data_set(set, set.folder)};
  task.end = set.questions.size();
  task.limit = kLimit;
  task.on_line = [&](std::uint64_t k, const std::string& line) {
    const auto value = nlohmann::json::parse(line);
    if (value.contains("refusal"))
      throw InputError(set.what + ", question " + std::to_string(k) + ": its " +
                       std::string(name_of(set.quantity)) + " is not known (" +
                       value.at("refusal").get<std::string>() +
                       "); leave these bodies out, or use another --seed");
    set.questions[k].number = {value.at("least").get<double>(), value.at("most").get<double>()};
  };
  task.on_mishap = [&](std::uint64_t k, const workers::Mishap& mishap) {
    throw EnvironmentError(set.what + ", question " + std::to_string(k) + ": " + mishap.message);
  };
  workers::run_to_end(workers::Job(std::move(task)));
}

}  // namespace lrb::bench

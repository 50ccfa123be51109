#pragma once
/// Puts a data set's questions to one method, and measures the time. For worker programs.

#include <array>
#include <map>
#include <memory>
#include <optional>

#include "engine/lrb/lrb_rep.hpp"
#include "scenarios/bench/record.hpp"
#include "scenarios/methods/method.hpp"

namespace lrb::bench {

class BenchRunner {
 public:
  /// The method must be present. `keep`: the records hold pairs and points.
  BenchRunner(const methods::MethodEntry& entry, std::optional<double> setting, const DataSet& set,
              bool keep);

  /// Puts a question to the method. A refusal is an outcome, too. Throws InputError if there is no such
  /// question.
  Record ask(std::uint64_t question);

 private:
  struct Built {
    std::unique_ptr<methods::MethodBody> body;
    double seconds = 0, bytes = 0;
  };

  const Built& built(std::size_t body, std::size_t side);
  Reply ask(const Question& q, Mode mode);

  methods::MethodInfo info_;
  std::unique_ptr<methods::Method> method_;
  std::optional<double> setting_;
  const DataSet& set_;
  bool keep_;
  std::map<std::pair<std::size_t, std::size_t>, Built> built_;  ///< by body and side
};

}  // namespace lrb::bench

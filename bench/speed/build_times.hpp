#pragma once
/// Compares building: the structures of lrbscope and other engines from the same triangles, their memory, and
/// the time to a first answer.

#include <cstdint>
#include <string>
#include <vector>

#include "bench/speed/data_set.hpp"
#include "bench/speed/make_sets.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::speed {

/// One build in its own process.
struct BuildTime {
  std::string body, method;
  std::uint64_t round = 0;
  Outcome outcome = Outcome::answered;
  std::string message;  ///< reason if it was not built
  /// Milliseconds. Build: one body, from triangles in memory, or for a loaded LRB-rep from its file. First
  /// answer: two bodies and one yes-or-no query. CPU: of all threads.
  double build_ms = 0, build_cpu_ms = 0, first_ms = 0, first_cpu_ms = 0;
  double heap_bytes = 0;  ///< growth of the heap by one body
  bool contact = false;   ///< the first answer, which is the same for all methods
};

/// Returns lrbscope's structures, which only this comparison lists: the OBB tree and the LRB-rep, both on one
/// thread and on all, and an LRB-rep loaded from its file.
std::vector<methods::MethodInfo> own_structures();

/// Measures a build and a first answer in this process, which should not have built anything before. `entry`:
/// another engine's method; null: the structure of lrbscope that is named `method`. `file`: an LRB-rep, of
/// which other structures take the real faces.
BuildTime time_build(const methods::MethodEntry* entry, const std::string& method, const std::string& file);

nlohmann::ordered_json to_json(const BuildTime& time);

struct BuildSurvey {
  std::vector<BodyPair> bodies;                ///< only their first bodies
  std::vector<workers::WorkerMethod> methods;  ///< other engines
  unsigned rounds = 5;
  double timeout = 120;  ///< seconds per build
  std::string folder;    ///< for the LRB-reps of the bodies
};

/// A body of a survey.
struct BuiltBody {
  std::string name;
  std::uint32_t faces = 0;
  double lrb_bytes = 0, faces_bytes = 0;  ///< size of its .lrb file with and without regions
};

struct BuildResults {
  std::vector<BuiltBody> bodies;
  std::vector<methods::MethodInfo> methods;
  std::vector<BuildTime> times;
  unsigned rounds = 0;
};

/// Builds every body with every method, each time in its own process: a round runs all methods one after the
/// other, so that ratios within a round have the same load.
BuildResults survey_builds(const BuildSurvey& survey, const record::ProgressReport& progress);

/// Returns the tables for stdout: medians over rounds and their spans, and ratios to FCL.
std::string build_text(const BuildResults& results);
/// Returns a line per body, method and round.
std::string build_csv(const BuildResults& results);
/// Returns the page: the tables (with `tex` also as files for LaTeX), and charts of the time to build, of the
/// first answer, and of memory.
report::Document build_page(const BuildResults& results, bool tex = false);

}  // namespace lrb::speed

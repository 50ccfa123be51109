#pragma once
/// Writes the results of a test of goldens: files of the differences, and a page.

#include <string>
#include <vector>

#include "scenarios/golden/check.hpp"
#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::golden {

/// The result of testing one scenario, without its run.
struct GoldenResult {
  std::string name, purpose;
  GoldenSpec spec;
  GoldenVerdict verdict;
  std::size_t steps = 0, events = 0;
  double seconds = 0;                     ///< duration of the test: the run, its pictures and the comparison
  std::uint32_t repeats = 0, passes = 0;  ///< of a failed test that was repeated
  std::string approve;                    ///< the command that approves the run
  std::string renderer;                   ///< what drew the pictures, if some failed; may be empty
  std::string page;                       ///< path of the page that shows the result; may be empty
  std::vector<report::Comparison> comparisons;
  report::PngBytes thumbnail = {};  ///< of the first picture that failed, with a frame around what differs
};

/// Tests a run. With `all`, also keeps the pictures that passed.
GoldenResult test_golden(const Golden& golden, const GoldenRun& run, const std::string& approve, bool all);

/// Returns the result for a golden that could not be tested, because it is damaged or its scenario is
/// rejected.
GoldenResult untested_golden(const std::string& name, const std::string& rejection,
                             const std::string& approve);

/// Removes the files of an earlier test of these goldens from a folder. Other files are kept.
void clear_golden_report(const std::string& folder, const std::vector<std::string>& names);

/// Writes the failures of a test: folder/NAME/{frame_1,divergence}.{expected,actual,difference}.png and,
/// the run as a golden, approve/NAME, from which it can be approved. Its trace is one for `lrbscope render`
/// and Perfetto.
void write_failures(const GoldenResult& result, const GoldenRun& run, const std::string& folder);

/// Writes folder/index.html.
void write_golden_page(const std::vector<GoldenResult>& results, const report::Folder& folder,
                       const std::string& command);

/// Describes the result of a scenario's test, in lines.
std::string result_text(const GoldenResult& result);

// Writes a test's results as JUnit XML for CI servers.

/// Returns a test suite with a case for each golden. A golden that could not be tested is an error; one that
/// differs is a failure, with result_text().
std::string junit_xml(const std::vector<GoldenResult>& results);

/// Returns a table of the results in GitHub's Markdown, the failures first, for the summary of a CI job, then
/// the pictures of failures, approved and found. `pictures`: path or address of the test's output folder.
std::string markdown(const std::vector<GoldenResult>& results, const std::string& pictures);

/// Returns a line for each cause that several failures have, with their names.
std::vector<std::string> equal_causes(const std::vector<GoldenResult>& results);

}  // namespace lrb::golden

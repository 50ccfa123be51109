#pragma once
/// Writes a test's results as JUnit XML, which CI servers show.

#include <string>
#include <vector>

#include "scenarios/golden/golden_report.hpp"

namespace lrb::golden {

/// Returns a test suite with a case for each golden. A golden that could not be tested is an error; one that
/// differs is a failure, with the lines that tell people about it.
std::string junit_xml(const std::vector<GoldenResult>& results);

}  // namespace lrb::golden

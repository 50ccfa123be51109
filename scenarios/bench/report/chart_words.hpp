#pragma once
/// What charts of speed against accuracy say, by what methods were asked for.

#include <string>
#include <vector>

#include "scenarios/bench/data_set.hpp"
#include "scenarios/report/page/page.hpp"

namespace lrb::bench {

struct ChartWords {
  std::string title, purpose;
  std::string error;   ///< for the axis
  std::string proved;  ///< in the key: what a cross is
  std::vector<report::PageText> texts;
};

ChartWords chart_words(Quantity quantity);

}  // namespace lrb::bench

#pragma once
/// Two pictures that should be the same: side by side, under a swipe, and as their difference.

#include <array>
#include <string>
#include <vector>

namespace lrb::report {

struct PageComparison {
  std::string id;     ///< letters, digits, _ and -: the page's address ends with it
  std::string title;  ///< and the text under it
  std::string text;
  bool passed = false;
  std::array<std::string, 3> data_uris;  ///< expected, actual, difference; an empty one is left out
  std::array<std::string, 2> captions;   ///< of expected and actual; may be empty
  std::string command;                   ///< the command that approves it; may be empty
};

std::string comparisons_html(const std::vector<PageComparison>& comparisons);

}  // namespace lrb::report

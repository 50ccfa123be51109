#pragma once
/// Reads what the program prints with one JSON object to a line.

#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace lrb::test {

inline std::vector<nlohmann::json> json_lines(const std::string& text) {
  std::vector<nlohmann::json> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(nlohmann::json::parse(line));
  return out;
}

/// Runs the program, which must succeed, and returns the lines that it prints.
inline std::vector<nlohmann::json> lines_of(const Folder& folder, const std::vector<std::string>& arguments) {
  const Outcome o = run(folder, arguments);
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  return json_lines(o.out);
}

}  // namespace lrb::test

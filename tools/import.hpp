#pragma once

#include <cstdint>
#include <string>

#include "tools/commands.hpp"
#include <lrbscope/trace/capture.hpp>

namespace lrb::tools {

/// A range of queries by number, both included.
struct QueryRange {
  std::uint32_t first = 1, last = kNull;

  bool contains(std::uint32_t number) const { return first <= number && number <= last; }
};

/// Parses the value of --queries: "40-60", "40-", "40" or nothing, for all. Throws InputError.
QueryRange parse_queries(const std::string& text);

/// Writes the page of a captured query to a folder. `source`: where the capture is from. Throws InputError
/// for a query with a side without a tree.
void write_query_page(capture::Capture capture, const std::string& source, const std::string& folder,
                      const Globals& globals);

}  // namespace lrb::tools

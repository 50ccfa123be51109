#pragma once

#include <cstdint>
#include <string>

#include "tools/commands.hpp"
#include <lrbscope/trace/capture.hpp>

namespace lrb::cli {

/// Writes the page of a captured query to a folder. `source`: where the capture is from. Throws InputError
/// for a query with a side without a tree.
void write_query_page(const capture::Capture& capture, const std::string& source, const std::string& folder,
                      const Globals& globals);

}  // namespace lrb::cli

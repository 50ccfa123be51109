#include "tests/fuzz/feed.hpp"
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::fuzz {

bool feed_trace(std::string_view bytes) {
  return accepted("t.json", [&] {
    const trace::Trace trace = trace::trace_from_json(bytes, "t.json");
    static_cast<void>(trace::summary_json(trace));
    if (!(trace::trace_from_json(trace::trace_to_json(trace), "t.json") == trace))
      throw std::logic_error("a trace that was accepted is another one after writing and reading it");
  });
}

}  // namespace lrb::fuzz

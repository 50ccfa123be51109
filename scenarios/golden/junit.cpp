#include "scenarios/golden/junit.hpp"

#include "render/markup.hpp"
#include "scenarios/io/number_text.hpp"

namespace lrb::golden {
namespace {

constexpr int kDecimals = 3;  // of seconds

std::string case_xml(const GoldenResult& r) {
  std::string out = "  <testcase classname=\"golden\" name=\"" + render::escape_markup(r.name) +
                    "\" time=\"" + io::fixed_text(r.seconds, kDecimals) + "\"";
  if (r.verdict.passed()) return out + "/>\n";
  const char* kind = r.verdict.refusal.empty() ? "failure" : "error";
  // The case has the name, and the element the verdict: the message is the rest of the first line, and what
  // follows is the element's text.
  const std::string text = result_text(r), head = "FAIL  " + r.name + ": ";
  const std::size_t end = text.find('\n');
  return out + ">\n    <" + kind + " message=\"" +
         render::escape_markup(text.substr(head.size(), end - head.size())) + "\">" +
         render::escape_markup(text.substr(end + 1)) + "</" + kind + ">\n  </testcase>\n";
}

}  // namespace

std::string junit_xml(const std::vector<GoldenResult>& results) {
  std::size_t failures = 0, errors = 0;
  double seconds = 0;
  std::string cases;
  for (const GoldenResult& r : results) {
    errors += r.verdict.refusal.empty() ? 0 : 1;
    failures += r.verdict.refusal.empty() && !r.verdict.passed() ? 1 : 0;
    seconds += r.seconds;
    cases += case_xml(r);
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"lrbscope golden\" tests=\"" +
         std::to_string(results.size()) + "\" failures=\"" + std::to_string(failures) + "\" errors=\"" +
         std::to_string(errors) + "\" time=\"" + io::fixed_text(seconds, kDecimals) + "\">\n" + cases +
         "</testsuite>\n";
}

}  // namespace lrb::golden

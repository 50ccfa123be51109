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
  const std::string text = result_text(r);
  return out + ">\n    <" + kind + " message=\"" + render::escape_markup(text.substr(0, text.find('\n'))) +
         "\">" + render::escape_markup(text) + "</" + kind + ">\n  </testcase>\n";
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

// lrbscope live: programs that record nothing or something else. The page: tests/examples/capture.sh.
#include <algorithm>
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"

namespace lrb::test {
namespace {

TEST_CASE("live: programs without a capture are reported in one line") {
  const Folder folder;
  const std::pair<const char*, const char*> programs[] = {
      {"exit 0", "recorded nothing; compile it with -DLRBCAP_ENABLE"},
      {"exit 7", "recorded nothing (sh ended with exit code 7)"},
      {"kill -9 $$", "recorded nothing (sh was ended by signal 9)"},
      {"echo hello >\"$LRBCAP_OUT\"", "expected a capture (LRBCAP ...), found text: 'hello'"},
      {"printf LRBCAP >\"$LRBCAP_OUT\"", "recorded nothing"},
      {"head -c 100000 /dev/zero >\"$LRBCAP_OUT\"; sleep 100", "expected a capture (LRBCAP ...)"}};
  for (const auto& program : programs) {
    const std::string script = program.first, says = program.second;
    CAPTURE(script);
    const Outcome o = run(folder, {"--quiet", "live", "--exit", "--", "sh", "-c", script});
    CHECK(o.code == 2);
    CHECK(o.out.empty());
    CHECK_MESSAGE(o.err.find(says) != std::string::npos, o.err);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
  }
  check_rejected(folder, {"live", "--exit"});
  check_rejected(folder, {"live", "--exit", "--", "./no-such-program"});
}

}  // namespace
}  // namespace lrb::test

// lrbscope live: requests of the page's server, and programs that record nothing or something else.
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"
#include "tools/loopback_server.hpp"

namespace lrb::test {
namespace {

using cli::parse_request;

TEST_CASE("live: requests for this machine by GET are answered, all others are not") {
  const std::string host = "\r\nHost: 127.0.0.1:8000\r\n";
  const auto status = [](const std::string& head) { return parse_request(head, 8000).status; };
  CHECK(parse_request("GET / HTTP/1.1" + host, 8000).target == "/");
  CHECK(parse_request("GET /queries/7/a%20b.png?x=1 HTTP/1.1" + host, 8000).target == "/queries/7/a b.png");
  CHECK(status("GET / HTTP/1.1\r\nhost:localhost:8000\r\nAccept: */*\r\n") == 200);
  CHECK(status("GET / HTTP/1.1\r\nHost: example.com\r\n") == 403);
  CHECK(status("GET / HTTP/1.1\r\nHost: 127.0.0.1:8001\r\n") == 403);
  CHECK(status("GET / HTTP/1.1\r\nHost: 127.0.0.1:8000\r\nHost: example.com\r\n") == 403);
  CHECK(status("GET / HTTP/1.1\r\nX-Host: 127.0.0.1:8000\r\n") == 403);
  CHECK(status("GET / HTTP/1.1\r\n") == 403);
  CHECK(status("POST / HTTP/1.1" + host) == 405);
  for (const char* line : {"", "GET", "GET /", "GET  HTTP/1.1", "GET x HTTP/1.1", "GET /%0 HTTP/1.1",
                           "GET /%zz HTTP/1.1", "GET /%00 HTTP/1.1", "GET / SSH/2"}) {
    CAPTURE(std::string(line));
    CHECK(status(line + host) == 400);
  }
}

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

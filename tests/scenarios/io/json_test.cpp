#include <string>

#include <doctest/doctest.h>

#include "tests/support/text.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;

namespace {

std::string json_error(const std::string& text) {
  return test::error_of([&] { const io::JsonText parsed(text, "file.json"); });
}

}  // namespace

TEST_CASE("values are found by their pointers") {
  const io::JsonText parsed("{\n  \"a\": [1,\n    {\"b/c\": \"x\\\"y\"}],\n \"~\": true }", "f");
  CHECK(parsed.where("") == "f:1:1");
  CHECK(parsed.where("/a") == "f:2:8");
  CHECK(parsed.where("/a#") == "f:2:3");
  CHECK(parsed.where("/a/0") == "f:2:9");
  CHECK(parsed.where("/a/1/b~1c") == "f:3:13");
  CHECK(parsed.where("/~0") == "f:4:7");
}

TEST_CASE("syntax errors report line and column in one line") {
  for (const char* text : {"{\n  \"a\": 1,,\n}", "{\"a\" 1}", "[1, 2", "", "{\"a\": nul}", "\xff\xfe",
                           "<!DOCTYPE html>", "{} {}"}) {
    CAPTURE(text);
    const std::string error = json_error(text);
    CHECK(error.rfind("file.json:", 0) == 0);
    CHECK(error.find('\n') == std::string::npos);
  }
  CHECK(json_error("{\n  \"a\": 1,,\n}").rfind("file.json:2:10:", 0) == 0);
  CHECK(json_error("[1e999]").rfind("file.json:", 0) == 0);
}

TEST_CASE("a repeated key is an error at its second place") {
  CHECK(json_error("{\"a\": 1,\n \"a\": 2}").find("occurs twice") != std::string::npos);
}

TEST_CASE("absurd nesting is rejected") {
  const std::string deep(100'000, '[');
  CHECK(json_error(deep + std::string(100'000, ']')).find("levels") != std::string::npos);
  CHECK(json_error(deep).find("levels") != std::string::npos);  // before the rest is read
}

TEST_CASE("similar words are suggested, others are not") {
  const std::vector<std::string> known = {"motion", "query", "frames"};
  CHECK(io::nearest_word("moton", known) == "motion");
  CHECK(io::nearest_word("qurey", known) == "query");
  CHECK(io::nearest_word("banana", known).empty());
  CHECK(io::nearest_word(std::string(100'000, 'x'), known).empty());
  CHECK(io::edit_distance("kitten", "sitting") == 3);
  CHECK(io::edit_distance("ab", "ba") == 1);
}

TEST_CASE("readers report location and expectation") {
  const io::JsonText parsed("{\"n\": -1, \"s\": \"x\", \"v\": [1, 2], \"big\": 1e300, \"f\": 1.5}", "f");
  const io::JsonNode root(parsed);
  CHECK_THROWS_WITH_AS(root.at("n").integer(0, 9), "f:1:7: /n: expected a whole number from 0 to 9, found -1",
                       InputError);
  CHECK_THROWS_WITH_AS(root.at("f").integer(0, 9),
                       "f:1:53: /f: expected a whole number from 0 to 9, found 1.5", InputError);
  CHECK_THROWS_WITH_AS(root.at("s").number(0, 1), "f:1:16: /s: expected a number, found string", InputError);
  CHECK_THROWS_WITH_AS(root.at("v").vector(), "f:1:26: /v: expected 3 numbers, found 2", InputError);
  CHECK_THROWS_WITH_AS(root.at("w"), "f:1:1: the key \"w\" is missing; add it", InputError);
  CHECK_THROWS_AS(root.at("big").number(-1, 1), InputError);
}

TEST_CASE("a byte order mark does not change locations, and nothing may follow a NUL byte") {
  CHECK(json_error("\xef\xbb\xbf{\"a\": 1,\n \"a\": 2}").find("file.json:2:2: ") == 0);
  CHECK(json_error(std::string("{}\0{", 4)).find("file.json:1:3: not JSON: found a NUL byte") == 0);
}

TEST_CASE("messages stay one line, whatever the file contains") {
  const io::JsonText parsed("{\"a\\nb\": 1, \"c\": \"\\u001b[2J\\n\"}", "f");
  const io::JsonNode root(parsed);
  CHECK_THROWS_WITH_AS(root.object({"c"}), doctest::Contains("/a\\x0ab: unknown key"), InputError);
  CHECK_THROWS_WITH_AS(root.at("c").choice<int>({{"x", 1}}), doctest::Contains("\\x1b[2J\\x0a"), InputError);
}

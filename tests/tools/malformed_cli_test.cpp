/// Files that are wrong, given to the program: exit 2, one line that says where, nothing else anywhere.

#include <cstring>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/mesh/io/encode.hpp"
#include "tests/support/lrb_files.hpp"
#include "tests/support/lrb_shapes.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

using namespace std::string_literals;

struct Case {
  std::string bytes;
  std::string complaint;  ///< how the message goes on after the file's name
};

/// `arguments`: the command, with "FILE" where the file's name goes.
void check_all(const std::string& file, const std::vector<std::string>& arguments,
               const std::vector<Case>& cases) {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("apart.txt", kApart);
  std::vector<std::string> given = arguments;
  std::replace(given.begin(), given.end(), "FILE"s, file);
  for (const Case& c : cases) {
    folder.write(file, c.bytes);
    const std::vector<std::string> before = folder.tree();
    const Outcome o = run(folder, given);
    CAPTURE(c.complaint);
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(o.out.empty());
    CHECK(o.error_lines() == 1);
    CHECK(o.err.find("lrbscope: " + file + ":" + c.complaint) == 0);
    CHECK(folder.tree() == before);
    CHECK(slurp(folder / file) == c.bytes);
  }
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

std::string utf16(const std::string& text) {
  std::string out = "\xff\xfe";
  for (const char c : text) out += {c, '\0'};
  return out;
}

const std::string kPng = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s;
const std::string kHtml = "<!DOCTYPE html>\n<html><body>404</body></html>\n";

}  // namespace

TEST_CASE("malformed OBJ files are rejected in one line") {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  check_all("m.obj", {"build", "FILE", "-o", "x.lrb"},
            {{"v 0 0 nan\n", "1: "},
             {"v 0 0 0\nv inf 0 0\n", "2: "},
             {"v 0 0 0\nv 1e999 0 0\n", "2: "},
             {"v 0 0\n", "1: "},
             {v + "f 0 1 2\n", "4: "},
             {v + "f 1 2 4\n", "4: "},
             {v + "f 1 2 -4\n", "4: "},
             {v + "f 1 2 4294967299\n", "4: "},
             {v + "f 1 2 18446744073709551619\n", "4: "},
             {v + "f 1 2\n", "4: "},
             {v + "f 1 2 3/\0\n"s, "4: "},
             {v, " "},
             {v + "f 1 2 3x\n", "4: "},
             {utf16(v + "f 1 2 3\n"), "1: "},
             {kHtml, "1: "},
             {kPng, "1: "},
             {"", "1: "},
             {"# nothing\n# at all\n", "1: "}});
}

TEST_CASE("malformed STL files are rejected in one line") {
  const std::string ascii = to_stl_ascii(tetrahedron()), binary = to_stl_binary(tetrahedron());
  std::string nan = binary, many = binary;
  const std::uint32_t quiet_nan = 0x7fc00000, too_many = 4'000'000'000;
  std::memcpy(nan.data() + 84 + 12, &quiet_nan, 4);
  std::memcpy(many.data() + 80, &too_many, 4);
  check_all("m.stl", {"inspect", "FILE"},
            {{ascii.substr(0, ascii.size() / 2), ""},
             {replaced(ascii, "endloop", "endlop"), "7: "},
             {replaced(ascii, "vertex 0 ", "vertex nan "), ""},
             {replaced(ascii, "facet", "facit"), "2: "},
             {"solid\n", ""},
             {binary.substr(0, binary.size() - 7), ""},
             {binary.substr(0, 40), ""},
             {nan, " triangle 0 (byte 96)"},
             {many, ""},
             {"", "1: "},
             {kHtml, "1: "}});
}

TEST_CASE("malformed PLY files are rejected in one line") {
  const std::string ascii = to_ply_ascii(tetrahedron()), binary = to_ply_binary(tetrahedron(), false);
  check_all("m.ply", {"query", "FILE", "FILE", "--poses", "apart.txt"},
            {{"ply\n", "2: "},
             {replaced(ascii, "ascii", "ascij"), "2: "},
             {replaced(ascii, "vertex 4", "vertex 99999999999"), ""},
             {replaced(ascii, "vertex 4", "vertex -1"), "4: "},
             {replaced(ascii, "property double z\n", ""), ""},
             {replaced(ascii, "end_header\n", ""), ""},
             {ascii.substr(0, ascii.size() - 4), ""},
             {ascii + "3 0 1 2\n", "19: "},
             {binary.substr(0, binary.size() - 5), " byte "},
             {binary + "x", " byte "},
             {replaced(binary, "face 4", "face 3"), " byte "},
             {replaced(binary, "face 4", "face 4000000000"), " byte "},
             {utf16(ascii), "1: "},
             {"", "1: "}});
}

TEST_CASE("malformed OFF files are rejected in one line") {
  const std::string good = to_off(tetrahedron());
  check_all("m.off", {"collide", "FILE", "cube.obj", "-o", "out"},
            {{"OFF\n", "2: "},
             {"OFF\n4 4\n0 0", "2: "},
             {replaced(good, "4 4 0", "-4 4 0"), "2: "},
             {replaced(good, "4 4 0", "4000000000 4 0"), "2: "},
             {replaced(good, "4 4 0", "18446744073709551620 4 0"), "2: "},
             {replaced(good, "4 4 0", "4 5 0"), ""},
             {replaced(good, "\n3 ", "\n1 "), "7: "},
             {replaced(good, "\n3 ", "\n4 "), "7: "},
             {replaced(good, "1 0 0", "1 0 infinity"), "4: "},
             {good + "3 0 1 2\n", "11: "},
             {good.substr(0, good.size() - 3), "2: "},
             {"OFF BINARY\n", "1: "},
             {kPng, "1: "}});
}

namespace {

/// A .lrb file with `value` written over its bytes at `at`, and a checksum that fits.
template <class T>
std::string patched(std::string lrb, std::size_t at, T value) {
  std::memcpy(lrb.data() + at, &value, sizeof value);
  const std::uint64_t right = lrb_checksum(std::string_view(lrb).substr(0, lrb.size() - 8));
  std::memcpy(lrb.data() + lrb.size() - 8, &right, 8);
  return lrb;
}

const std::vector<std::string>& seeds(const std::string& format) {
  static const std::vector<fuzz::Format> all = fuzz::formats();
  return std::find_if(all.begin(), all.end(), [&](const fuzz::Format& f) { return f.name == format; })->seeds;
}

}  // namespace

TEST_CASE("malformed .lrb files are rejected in one line") {
  const std::string good = test::lrb_bytes(LrbRep(toy::dented_box()));
  const std::size_t name = 8 + 4UL * 4, vertices = name + 8 + std::strlen("dented box"),
                    offsets = vertices + 8 + 13UL * 24, corners = offsets + 8 + 16UL * 4,
                    inner = corners + 8 + 56UL * 4;
  std::string flipped = good;
  flipped[vertices + 20] ^= 1;
  check_all("m.lrb", {"inspect", "FILE", "--validate", "--render", "-o", "new/x.png"},
            {{good.substr(0, 8), " byte 8: "},
             {good.substr(0, good.size() / 2), " byte "},
             {flipped, " byte "},
             {good + "x", " byte "},
             {patched(good, 8, std::uint32_t{99}), " byte 8: "},
             {patched(good, 12, std::uint32_t{7}), " dented box: dimension 7"},
             {patched(good, 16, std::uint32_t{99}), " dented box: "},
             {patched(good, name, std::uint64_t{1} << 63), " byte 32: "},
             {patched(good, vertices, std::uint64_t{1} << 61), " byte "},
             {patched(good, vertices + 8, std::numeric_limits<double>::infinity()), " dented box: vertex 0 "},
             {patched(good, offsets + 8, std::uint32_t{1}), " dented box: "},
             {patched(good, corners + 8, std::uint32_t{13}), " dented box: face 0 "},
             {patched(good, inner + 8, std::uint32_t{0}), " dented box: face 0 "},
             {"\x89LRB\n\x1a\n", ""}});
}

TEST_CASE("malformed poses are rejected in one line") {
  const std::string good = kApart;
  check_all("p.txt", {"collide", "cube.obj", "cube.obj", "--poses", "FILE", "-o", "out"},
            {{good + "1 0 0 3 0 1 0 0 0 0 1\n", "2: expected 12 numbers"},
             {good + "\n1 0 0 3 0 1 0 0 0 0 1 0 0\n", "3: expected 12 numbers"},
             {good + "1 0 0 nan 0 1 0 0 0 0 1 0\n", "2: "},
             {good + "1 0 0 -inf 0 1 0 0 0 0 1 0\n", "2: "},
             {good + "1 0 0 1e999 0 1 0 0 0 0 1 0\n", "2: "},
             {good + "1 0 0 0x10 0 1 0 0 0 0 1 0\n", "2: "},
             {"1 0 0 three 0 1 0 0 0 0 1 0\n", "1: "},
             {"1 0 0 3\0 0 1 0 0 0 0 1 0\n"s, "1: "},
             {utf16(good), "1: "},
             {"1;0;0;3;0;1;0;0;0;0;1;0\n", "1: "},
             {kHtml, "1: "},
             {kPng, "1: "},
             {"", " no poses"},
             {"# only\n\n# comments\n", " no poses"}});
}

namespace {

std::string scenario(const std::string& change, const std::string& to) {
  return replaced(R"({
 "name": "x", "purpose": "y", "seed": 7,
 "bodies": {"a": {"generator": "ball", "parameters": {"frequency": 2}}, "b": {"file": "cube.obj"}},
 "motion": {"kind": "sweep", "from": [3, 0, 0], "to": [0, 0, 0], "steps": 3},
 "frames": {"size": [320, 240], "at": "none"}
})",
                  change, to);
}

}  // namespace

TEST_CASE("malformed scenarios are rejected in one line") {
  const std::string q = "\"";
  check_all("s.json", {"run", "FILE", "-o", "out"},
            {{scenario("\"purpose\"", "\"porpose\""), "2:15: /porpose: unknown key"},
             {scenario("\"purpose\"", "\"por\\npose\\u001b\""), "2:15: /por"},
             {scenario("\"x\"", "1"), "2:10: /name: "},
             {scenario("\"x\"", "\"../x\""), "2:10: /name: "},
             {scenario("\"x\"", "\"/tmp/x\""), "2:10: /name: "},
             {scenario("\"x\"", "\"..\""), "2:10: /name: "},
             {scenario("\"x\"", "\"\""), "2:10: /name: "},
             {scenario("\"x\"", "\"a\\u0000b\""), "2:10: /name: "},
             {scenario("\"seed\": 7", "\"seed\": -7"), "2:39: /seed: "},
             {scenario("\"seed\": 7", "\"seed\": 18446744073709551616"), "2:39: /seed: "},
             {scenario("\"seed\": 7", "\"seed\": 1e999"), "2:"},
             {scenario("\"seed\": 7", "\"seed\": NaN"), "2:"},
             {scenario("\"seed\": 7", "\"name\": \"z\""), "2:"},
             {scenario("\"generator\": \"ball\", ", ""), "3:18: /bodies/a: "},
             {scenario("\"ball\"", "\"bal\""), "3:32: /bodies/a/generator: "},
             {scenario("\"frequency\": 2", "\"frequency\": 2000000"), "3:"},
             {scenario("\"b\": {\"file\": \"cube.obj\"}", "\"b\": 5"), "3:"},
             {scenario("cube.obj", ""), "3:"},
             {scenario("cube.obj", "s.json"), "1: "},  // itself: read as a mesh, and refused as one
             {scenario("\"steps\": 3", "\"steps\": 1000000000"), "4:"},
             {scenario("\"steps\": 3", "\"steps\": 0"), "4:"},
             {scenario("[3, 0, 0]", "[3, 0]"), "4:"},
             {scenario("[3, 0, 0]", "[3, 0, 1e999]"), "4:"},
             {scenario("[320, 240]", "[320, 240000]"), "5:"},
             {scenario("}\n}", "}"), "5:"},
             {scenario("}\n}", "}\n}\n}"), "7:"},
             {scenario("}\n}", "}\n}\0"s), "6:2: "},
             {scenario("\"y\"", "\"\xff\xfe\""), "2:"},
             {"\xef\xbb\xbf" + scenario("\"steps\": 3", "\"stops\": 3"), "4:"},
             {std::string(100000, '['), "1:"},
             {std::string(1000, '[') + std::string(1000, ']'), "1:65: nested"},
             {utf16("{}"), "1:4: "},
             {kHtml, "1:1: "},
             {"", "1:1: "},
             {"// a comment\n", "1:1: "},
             {"[]", "1:1: "}});
}

TEST_CASE("a scenario with a picture of a missing event writes nothing") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("s.json", scenario("\"at\": \"none\"", "\"events\": [99999]"));
  const std::vector<std::string> before = folder.tree();
  const Outcome o = run(folder, {"run", "s.json", "-o", "out"});
  CHECK(o.code == 2);
  CHECK(o.error_lines() == 1);
  CHECK(o.err.find("lrbscope: scenario x: frames: event 99999") != std::string::npos);
  CHECK(folder.tree() == before);
}

TEST_CASE("malformed traces are rejected in one line") {
  const std::string good = seeds("trace").at(2);
  const auto with = [&](const std::string& what, const std::string& to) { return replaced(good, what, to); };
  check_all("t.json", {"render", "FILE", "-o", "out"},
            {{good.substr(0, good.size() / 2), " line "},
             {good + "}", " line "},
             {with("\"traceEvents\"", "\"events\""), " /metadata/events/stored: "},
             {with("lrbscope trace", "some trace"), " /metadata/format: "},
             {with("\"version\": 3", "\"version\": 99"), " /metadata/version: "},
             {with("\"version\": 3", "\"version\": \"1\""), " /metadata/version: "},
             {with("\"dim\": 2", "\"dim\": 7"), " /metadata/bodies/0/dim: "},
             {with("\"region\":2", "\"region\":200"), " event "},
             {with("\"region\":2", "\"region\":4294967298"), " /traceEvents/"},
             {with("\"region\":2", "\"region\":-2"), " /traceEvents/"},
             {with("\"dim\": 2", "\"dim\": 1e999"), " "},
             {"{\"traceEvents\":" + std::string(1000, '[') + std::string(1000, ']') + "}", " "},
             {"\x1f\x8b\x08\0\0\0\0\0\0\3abc"s, " cannot read the trace"},
             {"{}", " /metadata"},
             {"[]", " "},
             {utf16("{}"), " line 1"},
             {kHtml, " line 1"},
             {kPng, " line 1"},
             {"", " line 1"}});
}

TEST_CASE("a trace without its bodies, or with other bodies, is rejected before anything is written") {
  const Folder folder;
  folder.write("t.json", seeds("trace").at(2));
  folder.write("cube.obj", kCube);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"render", "t.json", "-o", "out"},
        {"render", "t.json", "--bodies", "cube.obj", "-o", "out"}})
    check_rejected(folder, arguments);
}

TEST_CASE("paths that are not regular files are rejected, and endless devices are not read") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  std::filesystem::create_directory(folder / "dir.obj");
  for (const char* path : {"missing.obj", "dir.obj", "/dev/zero", "cube.obj/x.obj"}) {
    const Outcome o = run(folder, {"inspect", path});
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(o.error_lines() == 1);
    CHECK(o.err.find(path) != std::string::npos);
  }
  CHECK(run(folder, {"run", "/dev/zero", "-o", "out"}).code == 2);
  CHECK(run(folder, {"query", "cube.obj", "cube.obj", "--poses", "/dev/zero"}).code == 2);
}

TEST_CASE("names in scenarios and traces cannot escape the output folder") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("s.json", scenario("\"x\"", "\"inside\""));
  std::filesystem::create_directory(folder / "work");
  // A run writes below its folder only; its default folder is named after the scenario.
  std::vector<std::string> before = folder.tree();
  REQUIRE(run(folder, {"run", "s.json"}).code == 0);
  for (const std::string& name : folder.tree())
    CHECK((std::find(before.begin(), before.end(), name) != before.end() || name.starts_with("out")));
  // Names in a trace are shown, and no more than that.
  std::string trace = slurp(folder / "out/inside/trace.json");
  trace = replaced(trace, "\"name\": \"inside\"", "\"name\": \"../../../work/escaped</script><script>\"");
  folder.write("work/t.json", trace);
  before = folder.tree();
  const Outcome o = run(
      folder, {"render", "work/t.json", "--bodies", "out/inside/a.lrb", "out/inside/b.lrb", "-o", "drawn"});
  CAPTURE(o.err);
  CHECK(o.code == 0);
  for (const std::string& name : folder.tree())
    CHECK((std::find(before.begin(), before.end(), name) != before.end() || name.starts_with("drawn")));
  CHECK(slurp(folder / "drawn/index.html").find("escaped</script>") == std::string::npos);
  // Frames of an earlier run are planted links: rejected, and their targets are kept.
  folder.write("precious", "keep me");
  std::filesystem::create_symlink(folder / "precious", folder / "out/inside/frames/frame_0000.png");
  std::filesystem::create_symlink(folder / "precious", folder / "out/inside/montage.png");
  const Outcome rejected = run(folder, {"run", "s.json", "--frames", "step", "--most", "1"});
  CHECK(rejected.code == 3);
  CHECK(rejected.error_lines() == 1);
  CHECK(slurp(folder / "precious") == "keep me");
}

TEST_CASE("names that are not UTF-8 are accepted") {
  const Folder folder;
  folder.write("\xff.obj", kCube);
  CHECK(run(folder, {"inspect", "\xff.obj", "--json"}).code == 0);
  CHECK(run(folder, {"build", "\xff.obj", "--json"}).code == 0);
  CHECK(run(folder, {"collide", "\xff.obj", "\xff.obj", "-o", "out", "--frames", "none"}).code == 0);
}

}  // namespace lrb::test

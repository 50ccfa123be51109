/// Files that would take far more memory than they have bytes, or wait for ever, are refused early.

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include "tests/support/program.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>

namespace fs = std::filesystem;
using namespace lrb::test;

namespace {

#ifdef LRB_ADDRESS_SANITIZER
constexpr bool kCountsMemory = false;  // shadow memory counts, too
#else
constexpr bool kCountsMemory = true;
#endif

struct Measured : Outcome {
  long peak_mb = 0;  ///< resident
};

/// Runs the program in the folder, for a minute at most.
Measured measure(const Folder& folder, const std::vector<std::string>& arguments) {
  std::vector<char*> argv = {const_cast<char*>(LRBSCOPE_BINARY)};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const std::string out = folder / "stdout", err = folder / "stderr";
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const int null = open("/dev/null", O_RDONLY), to = open(out.c_str(), O_CREAT | O_WRONLY, 0600),
              complaints = open(err.c_str(), O_CREAT | O_WRONLY, 0600);
    dup2(null, 0), dup2(to, 1), dup2(complaints, 2);
    if (chdir(folder.path.c_str()) != 0) _exit(127);
    alarm(60);
    execv(LRBSCOPE_BINARY, argv.data());
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  REQUIRE(wait4(child, &status, 0, &usage) == child);
  Measured m;
  m.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  m.out = slurp(out);
  m.err = slurp(err);
  m.peak_mb = usage.ru_maxrss / 1024;
  fs::remove(out);
  fs::remove(err);
  return m;
}

/// The memory that the program needs to do nothing.
long idle_mb(const Folder& folder) {
  static const long mb = measure(folder, {"--version"}).peak_mb;
  return mb;
}

/// Refused in a line that says `what`, with so much memory beyond that of doing nothing.
void check_rejected_within(const Folder& folder, const std::vector<std::string>& arguments, const char* what,
                           long mb) {
  const Measured m = measure(folder, arguments);
  CAPTURE(arguments.back());
  CAPTURE(m.err);
  CHECK(m.code == 2);
  CHECK(m.error_lines() == 1);
  CHECK(m.err.find(what) != std::string::npos);
  if (kCountsMemory) CHECK(m.peak_mb - idle_mb(folder) < mb);
}

/// Writes `begin`, then `again` over and over until there are `bytes`, compressed.
void write_gzip(const std::string& path, const std::string& begin, const std::string& again,
                std::size_t bytes) {
  const gzFile file = gzopen(path.c_str(), "wb9");
  REQUIRE(file != nullptr);
  gzwrite(file, begin.data(), static_cast<unsigned>(begin.size()));
  std::string chunk;
  while (chunk.size() < (1u << 16)) chunk += again;
  for (std::size_t written = 0; written < bytes; written += chunk.size())
    gzwrite(file, chunk.data(), static_cast<unsigned>(chunk.size()));
  gzclose(file);
}

std::string repeated(const std::string& begin, const std::string& again, std::size_t bytes) {
  std::string out = begin;
  while (out.size() < bytes) out += again;
  return out;
}

void put_chunk(std::string& png, const std::string& type, const std::string& data) {
  const auto put = [&](std::size_t v) {
    for (int shift = 24; shift >= 0; shift -= 8) png += static_cast<char>(v >> shift);
  };
  put(data.size());
  const std::string body = type + data;
  png += body;
  put(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
}

/// An RGB picture of a size, whose data unpack to `zeros` bytes of 0.
std::string png_of(std::uint32_t width, std::uint32_t height, std::size_t zeros) {
  std::string header;
  for (const std::uint32_t v : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) header += static_cast<char>(v >> shift);
  header += std::string("\x08\x02\0\0\0", 5);
  const std::string raw(zeros, '\0');
  uLongf length = compressBound(raw.size());
  std::string packed(length, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(raw.data()),
           raw.size());
  packed.resize(length);
  std::string png = "\x89PNG\r\n\x1a\n";
  put_chunk(png, "IHDR", header);
  put_chunk(png, "IDAT", packed);
  put_chunk(png, "IEND", "");
  return png;
}

std::string rejection_of_png(const std::string& bytes, std::uint64_t max_pixels = lrb::render::kMaxPixels) {
  try {
    lrb::render::decode_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "p.png",
                            max_pixels);
  } catch (const lrb::InputError& e) {
    return e.what();
  }
  return {};
}

constexpr std::size_t kMega = 1'000'000;

}  // namespace

TEST_CASE("decompression bombs as traces are rejected with little memory") {
  const Folder folder;
  write_gzip(folder / "zeros.json.gz", "{\"traceEvents\":[", "0,", 60 * kMega);
  REQUIRE(fs::file_size(folder / "zeros.json.gz") < 100'000);
  check_rejected_within(folder, {"render", "zeros.json.gz"}, "unpack to more than", 100);
  write_gzip(folder / "metadata.json.gz", "{\"metadata\":[", "[],", 60 * kMega);
  check_rejected_within(folder, {"render", "metadata.json.gz"}, "unpack to more than", 100);
  write_gzip(folder / "few.json.gz", "{\"traceEvents\":[", "0,", 4 * kMega);
  check_rejected_within(folder, {"render", "few.json.gz"},
                        "/traceEvents/0: expected an event, {...}, found number 0", 60);
  CHECK_FALSE(fs::exists(folder / "out"));
}

TEST_CASE("the parser's memory is bounded by the trace's size") {
  const Folder folder;
  const auto rejected = [&](const std::string& begin, const std::string& again, const char* what, long mb) {
    folder.write("t.json", repeated(begin, again, 20 * kMega));
    check_rejected_within(folder, {"render", "t.json"}, what, mb);
  };
  rejected("{\"traceEvents\":[", "0,", "/traceEvents/0: expected an event", 100);
  rejected("{\"traceEvents\":[", "[],", "/traceEvents/0: expected an event, {...}, found array", 100);
  rejected("{\"traceEvents\":{", "\"a\":1,", "/traceEvents: expected an array of events", 100);
  rejected("{\"traceEvents\":[{\"ph\":[", "0,", "/traceEvents/0: longer than any event", 100);
  rejected("{\"traceEvents\":[{\"ph\":\"M\"},{\"x\":{", "\"a\":{},", "/traceEvents/1: longer than any", 100);
  rejected("{\"metadata\":[", "[],", "its values take more than 8 times", 350);
  rejected("{\"metadata\":[", "{},", "its values take more than 8 times", 350);
  rejected("{\"else\":[", "{},", "its values take more than 8 times", 350);
}

TEST_CASE("an oversized scenario is rejected before it is read") {
  const Folder folder;
  folder.write("large.json", repeated("{\"name\": [", "0,", 60 * kMega));
  check_rejected_within(folder, {"run", "large.json"}, "expected at most 8388608 bytes", 60);
  check_rejected_within(folder, {"crowd", "./large.json"}, "expected at most 8388608 bytes", 60);
  check_rejected_within(folder, {"paper", "--experiment", "./large.json"}, "expected at most 8388608 bytes",
                        60);
}

TEST_CASE("named pipes are rejected without waiting; pipes of a shell are read") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("p.txt", kApart);
  for (const char* name : {"pipe", "pipe.obj", "pipe.json"})
    REQUIRE(mkfifo((folder / name).c_str(), 0600) == 0);
  const std::vector<std::vector<std::string>> waiting = {
      {"inspect", "pipe.obj"},
      {"query", "cube.obj", "pipe.obj", "--poses", "p.txt"},
      {"query", "cube.obj", "cube.obj", "--poses", "pipe"},
      {"run", "pipe.json"},
      {"render", "pipe.json"},
  };
  for (const auto& arguments : waiting) check_rejected_within(folder, arguments, "a named pipe", 60);
  const std::string shell = "cd '" + folder.path.string() +
                            "' && cat cube.obj | '" LRBSCOPE_BINARY "' inspect /dev/stdin >out.txt 2>&1";
  CHECK(std::system(shell.c_str()) == 0);
  CHECK(slurp(folder / "out.txt").find("\nfaces: 6\n") != std::string::npos);
}

TEST_CASE("decompression bombs as pictures are rejected") {
  CHECK(rejection_of_png(png_of(64, 64, 64UL * 193)).empty());
  CHECK(rejection_of_png(png_of(64, 64, 64UL * 193), 4095).find("has 64x64 pixels, expected at most 4095") !=
        std::string::npos);
  CHECK(rejection_of_png(png_of(20'000, 20'000, 1000)).find("has 20000x20000 pixels, expected at most") !=
        std::string::npos);
  CHECK(rejection_of_png(png_of(8000, 8000, 1000)).find("8000x8000 pixels cannot be in ") !=
        std::string::npos);
  CHECK(rejection_of_png(png_of(40'000, 2, 2UL * 120'001)).find("has 40000x2 pixels, a side of more than") !=
        std::string::npos);
}

TEST_CASE("damaged pictures are rejected with a reason") {
  const std::string good = png_of(64, 64, 64UL * 193);
  CHECK(rejection_of_png("GIF89a, or so") == "p.png: not a readable PNG (Not a PNG file)");
  CHECK(rejection_of_png(png_of(64, 64, 20 * kMega)) ==
        "p.png: not a readable PNG (IDAT: Too much image data)");
  CHECK(rejection_of_png(png_of(64, 64, 64UL * 193 - 1)) ==
        "p.png: not a readable PNG (Not enough image data)");
  for (const std::size_t missing : {std::size_t{1}, std::size_t{13}, good.size() - 8, good.size() - 40})
    CHECK(rejection_of_png(good.substr(0, good.size() - missing)) ==
          "p.png: not a readable PNG (the file is truncated)");
  std::string flipped = good;
  flipped[good.size() / 2] ^= 1;
  CHECK(rejection_of_png(flipped).find("p.png: not a readable PNG (IDAT: ") == 0);
}

TEST_CASE("texts in pictures have a size limit") {
  const auto with_text = [](const std::string& value, int times) {
    std::string png = png_of(1, 1, 4);
    const std::string end = png.substr(png.size() - 12);
    png.resize(png.size() - end.size());
    for (int i = 0; i < times; ++i) put_chunk(png, "tEXt", "key" + std::string(1, '\0') + value);
    return png + end;
  };
  CHECK(rejection_of_png(with_text("value", 50)).empty());
  CHECK(rejection_of_png(with_text("value", 1000)) ==
        "p.png: not a readable PNG (tEXt: no space in chunk cache)");
  CHECK(
      rejection_of_png(with_text(std::string(2 * kMega, 'v'), 1)).find("p.png: not a readable PNG (tEXt: ") ==
      0);
}

TEST_CASE("a golden of decompression bombs fails with little memory, and the others are tested") {
  const Folder folder;
  const std::string text = R"({"name": "NAME", "purpose": "p",
    "bodies": {"a": {"generator": "ball", "parameters": {"frequency": 2}},
               "b": {"generator": "ball", "parameters": {"frequency": 2}}},
    "motion": {"kind": "poses", "poses": [{"position": [1.5, 0, 0]}]}, "frames": {"size": [480, 320]}})";
  for (const std::string name : {"bomb", "sound"}) {
    std::string named = text;
    folder.write(name + ".json", named.replace(named.find("NAME"), 4, name));
    const Measured m = measure(folder, {"golden", "approve", "--frames", "1", name + ".json"});
    REQUIRE_MESSAGE(m.code == 0, m.err);
  }
  const long usual_mb = measure(folder, {"golden", "test"}).peak_mb;
  const auto check_fails = [&](const char* what) {
    const Measured m = measure(folder, {"golden", "test"});
    CAPTURE(m.out);
    CHECK(m.code == 1);
    CHECK(m.out.find("FAIL  bomb: ") != std::string::npos);
    CHECK(m.out.find(what) != std::string::npos);
    CHECK(m.out.find("ok    sound: ") != std::string::npos);
    if (kCountsMemory) CHECK(m.peak_mb < usual_mb + 40);
  };
  const std::string picture = slurp(folder / "goldens/bomb/frame_1.png");
  folder.write("goldens/bomb/frame_1.png", png_of(8000, 8000, 8000UL * 24001));
  check_fails("has 8000x8000 pixels, expected at most");
  folder.write("goldens/bomb/frame_1.png", png_of(480, 320, 150 * kMega));
  check_fails("Too much image data");
  fs::remove(folder / "goldens/bomb/frame_1.png");
  REQUIRE(mkfifo((folder / "goldens/bomb/frame_1.png").c_str(), 0600) == 0);
  check_fails("found a named pipe");
  fs::remove(folder / "goldens/bomb/frame_1.png");
  folder.write("goldens/bomb/frame_1.png", picture);
  write_gzip(folder / "goldens/bomb/trace.json.gz", "{\"traceEvents\":[", "{},", 100 * kMega);
  check_fails("unpack to more than");
}

TEST_CASE("too many pairs: one line, no output, and the limit can be raised") {
  const Folder folder;
  const auto strips = [](bool along_y) {
    std::string obj;
    for (int i = 0; i < 100; ++i)
      for (const auto& [far, z] : {std::pair{"-1", "-0.5"}, std::pair{"2", "-0.5"}, std::pair{"0.5", "2"}}) {
        const std::string at = std::to_string(i / 100.0);
        obj += "v " + (along_y ? far + (" " + at) : at + " " + far) + " " + z + "\n";
      }
    for (int i = 0; i < 100; ++i)
      obj += "f " + std::to_string(3 * i + 1) + " " + std::to_string(3 * i + 2) + " " +
             std::to_string(3 * i + 3) + "\n";
    return obj;
  };
  folder.write("a.obj", strips(false));
  folder.write("b.obj", strips(true));
  folder.write("p.txt", "# comment\n1 0 0 0 0 1 0 0 0 0 1 0.125\n");
  std::vector<std::string> query = {"--quiet", "query", "a.obj",       "b.obj",
                                    "--poses", "p.txt", "--max-pairs", "9999"};
  const Outcome rejected = check_rejected(folder, query);
  CHECK(rejected.err.find("p.txt:2: ") != std::string::npos);
  CHECK(rejected.err.find("more than 9999 pairs") != std::string::npos);
  CHECK(rejected.err.find("--max-pairs") != std::string::npos);
  query.back() = "10000";
  CHECK(run(folder, query).out.find("\"pairs\":10000,") != std::string::npos);
  query.back() = "0";
  CHECK(check_rejected(folder, query).err.find("--max-pairs") != std::string::npos);
  check_rejected(folder, {"collide", "a.obj", "b.obj", "--poses", "p.txt", "--max-pairs", "9999"});
  folder.write("s.json", R"({"name": "s", "purpose": "p",
    "bodies": {"a": {"file": "a.obj"}, "b": {"file": "b.obj"}},
    "motion": {"kind": "poses", "poses": [{"position": [0, 0, 0.125]}]},
    "query": {"max_pairs": 9999}, "frames": {"at": "none"}})");
  const Outcome scenario = check_rejected(folder, {"run", "s.json"});
  CHECK(scenario.err.find("scenario s, step 0: ") != std::string::npos);
}

// Lists of poses as lines, CSV and JSON: reading, errors, and lossless writing.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "scenarios/io/poses.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;

namespace {

const Pose kPose{(Eigen::Matrix3d() << 1, 2, 3, 5, 6, 7, 9, 10, 11).finished(), {4, 8, 12}};

bool same(const Pose& x, const Pose& y) {
  return x.r == y.r && x.t == y.t;
}

/// Checks that a text is rejected with a message, in the form of its file.
void check_error(const std::string& file, const std::string& text, const char* message) {
  CAPTURE(text);
  const auto parse = [&] {
    if (file == "p.txt") io::parse_poses(text, file);
    if (file == "p.csv") io::parse_pose_table(text, file);
    if (file == "p.json") io::parse_pose_json(text, file);
  };
  CHECK_THROWS_WITH_AS(parse(), message, InputError);
}

}  // namespace

TEST_CASE("poses: blank lines, comments, commas, CRLF, plus signs") {
  const std::vector<Pose> poses = io::parse_poses(
      "# a comment\r\n\r\n1 0 0 5  0 1 0 6  0 0 1 7\r\n  1,0,0,-1.5, 0,+1,0,2e3, 0,0,1,.25 # behind it\n\n",
      "p.txt");
  REQUIRE(poses.size() == 2);
  CHECK(poses[0].r == Eigen::Matrix3d::Identity());
  CHECK(poses[0].t == Eigen::Vector3d(5, 6, 7));
  CHECK(poses[1].t == Eigen::Vector3d(-1.5, 2000, 0.25));
  CHECK(same(io::parse_poses("1 2 3 4 5 6 7 8 9 10 11 12", "p.txt")[0], kPose));  // row by row
}

TEST_CASE("poses: errors report file and line") {
  check_error("p.txt", "1 0 0 5  0 1 0 6  0 0 1 7\n\n1 2 3",
              "p.txt:3: expected 12 numbers (a row-major 3x4 pose), found 3");
  check_error("p.txt", "1 0 0 x 0 1 0 0 0 0 1 0",
              "p.txt:1: \"x\" is not a number: expected 12 numbers per line");
  check_error("p.txt", "1 0 0 nan 0 1 0 0 0 0 1 0",
              "p.txt:1: \"nan\" is not finite; every number must be finite");
  check_error("p.txt", "1 0 0 1e999 0 1 0 0 0 0 1 0", "p.txt:1: \"1e999\" exceeds the range of a double");
  check_error("p.txt", "", "p.txt: no poses: expected lines of 12 numbers (row-major 3x4)");
  check_error("p.txt", std::string("1 0 0 \0 0 1 0 0 0 0 1 0", 23),
              "p.txt:1: \"?\" is not a number: expected 12 numbers per line");
}

TEST_CASE("parse_vector() accepts three finite numbers only") {
  CHECK(io::parse_vector("1,-2,3.5", "--from") == Eigen::Vector3d(1, -2, 3.5));
  CHECK_THROWS_WITH_AS(io::parse_vector("1,2", "--from"),
                       "--from: expected three numbers X,Y,Z, found 2 in \"1,2\"", InputError);
  CHECK_THROWS_AS(io::parse_vector("1,2,inf", "--from"), InputError);
}

TEST_CASE("poses in CSV: rows of 12 and 16, named columns in any order among others") {
  std::vector<std::size_t> lines;
  const std::vector<Pose> plain = io::parse_pose_table(
      "# made by hand\n1,2,3,4,5,6,7,8,9,10,11,12\r\n\n1, 2 ,3,4,5,6,7,8,9,10,11,12,0,0,0,1\n", "p.csv",
      &lines);
  REQUIRE(plain.size() == 2);
  CHECK(same(plain[0], kPose));
  CHECK(same(plain[1], kPose));
  CHECK(lines == std::vector<std::size_t>{2, 4});

  const std::vector<Pose> named = io::parse_pose_table(
      "step,tx,ty,tz,r00,r01,r02,r10,r11,r12,r20,\"r21\",r22,note\n"
      "7,4,8,12,1,2,3,5,6,7,9,10,11,\"left, then up\"\n",
      "p.csv");
  REQUIRE(named.size() == 1);
  CHECK(same(named[0], kPose));
}

TEST_CASE("poses in CSV: errors report file and line") {
  check_error("p.csv", "1,2,3\n", "p.csv:1: expected 12 numbers (a row-major 3x4 pose) or 16 (4x4), found 3");
  check_error("p.csv", "1,2,3,4,5,6,7,8,9,10,11,12,0,0,0,2\n",
              "p.csv:1: expected 0, 0, 0, 1 as the last row of the 4x4 pose");
  check_error("p.csv", "1,,3,4,5,6,7,8,9,10,11,12\n", "p.csv:1: cell 2 is empty: expected a number");
  check_error(
      "p.csv", "1;2;3;4;5;6;7;8;9;10;11;12\n",
      "p.csv:1: expected 12 numbers (a row-major 3x4 pose) or 16 (4x4), found 1; in a .csv file, commas separate "
      "them");
  check_error(
      "p.csv", "r00,r01\n1,2\n",
      "p.csv:1: missing column r02: expected r00,r01,r02,tx,r10,r11,r12,ty,r20,r21,r22,tz in any order");
  check_error("p.csv", "r00,r01,r02,tx,r10,r11,r12,ty,r20,r21,r22,tz\n1,2\n",
              "p.csv:2: expected 12 cells, as in the first line, found 2");
  check_error("p.csv", "1,2,3,4,5,6,x,8,9,10,11,12\n",
              "p.csv:1: \"x\" is not a number: expected 12 numbers per line");
}

TEST_CASE("poses in JSON: flat or in rows, 3x4 or 4x4, alone or under \"poses\"") {
  for (const char* text : {"[[1,2,3,4,5,6,7,8,9,10,11,12]]", "[[[1,2,3,4],[5,6,7,8],[9,10,11,12]]]",
                           "{\"poses\": [[[1,2,3,4],[5,6,7,8],[9,10,11,12],[0,0,0,1]]], \"unit\": \"mm\"}",
                           "[[1,2,3,4,5,6,7,8,9,10,11,12,0,0,0,1]]"}) {
    CAPTURE(text);
    const io::PoseList list = io::parse_pose_json(text, "p.json");
    REQUIRE(list.poses.size() == 1);
    CHECK(same(list.poses[0], kPose));
    CHECK(list.places[0].substr(0, 9) == "p.json:1:");
  }
}

TEST_CASE("poses in JSON: errors report file, line and column") {
  check_error("p.json", "{}",
              "p.json:1:1: expected an array of poses, or an object with such an array as \"poses\"");
  check_error("p.json", "[]", "p.json:1:1: expected at least 1 items, found 0");
  check_error("p.json", "[\n [1,2]]",
              "p.json:2:2: /0: expected a pose of 12 numbers (3x4, row by row) or 16 (4x4), found 2");
  check_error("p.json", "[[[1,2,3,4],[5,6,7,8],[9,10,11]]]",
              "p.json:1:23: /0/2: expected 4 numbers, found 3");
  check_error("p.json", "[[1,2,3,4,5,6,7,8,9,10,11,12,0,0,1,1]]",
              "p.json:1:2: /0: expected 0, 0, 0, 1 as the last row of the 4x4 pose");
  check_error("p.json", "[[1,2,3,4,5,6,7,8,9,10,11,\"x\"]]",
              "p.json:1:27: /0/11: expected a number, found string");
  check_error("p.json", "{\"poses\": 7}", "p.json:1:11: /poses: expected an array, found number");
  check_error("p.json", "{\"poses\":\n[[1,2,3,4,5,6,7,8,9,10,11,12]], \"poses\": []}",
              "p.json:2:33: the key /poses occurs twice; keep one");
  check_error("p.json", "[[1,2,3,4,5,6,7,8,9,10,11,12]] 5",
              "p.json:1:32: not JSON: value - unexpected number literal; expected end of input");
}

TEST_CASE("poses in JSON: other members are skipped, whatever they contain") {
  const io::PoseList list = io::parse_pose_json(
      "\xef\xbb\xbf{\"meta\": {\"poses\": [1, {\"poses\": null}], \"x\": [[], 1.5, \"y\"]},\n \"poses\": "
      "[[1,2,3,4,5,6,7,8,9,10,11,12],\n[1 , 2,3,4,\t[5,6,7,8],9,10,11,12]], \"after\": [{}]}",
      "p.json");
  REQUIRE(list.poses.size() == 2);
  CHECK(same(list.poses[0], kPose));
  CHECK(same(list.poses[1], kPose));
  CHECK(list.places == std::vector<std::string>{"p.json:2:12", "p.json:3:1"});
}

TEST_CASE(
    "poses in JSON: rejected at the first error, before the rest is read; too large files are not read") {
  std::string text = "[";
  for (int i = 0; i < 1'000'000; ++i) text += "[],";
  CHECK_THROWS_WITH_AS(io::parse_pose_json(text + "no JSON", "p.json"),
                       "p.json:1:2: /0: expected a pose of 12 numbers (3x4, row by row) or 16 (4x4), found 0",
                       InputError);
  CHECK_THROWS_WITH_AS(io::parse_pose_json(std::string(1'000'000, '['), "p.json"),
                       "p.json:1:4: /0/0/0: expected a number, found array", InputError);
  const test::Folder folder;
  folder.write("p.json", "[]");
  std::filesystem::resize_file(folder / "p.json", (std::uintmax_t{64} << 20) + 1);
  CHECK_THROWS_WITH_AS(io::open_poses(folder / "p.json"),
                       doctest::Contains("expected at most 67108864 bytes"), InputError);
}

TEST_CASE("poses: each form is read back as the same numbers, to the last bit") {
  constexpr double kTiny = std::numeric_limits<double>::denorm_min(),
                   kHuge = std::numeric_limits<double>::max();
  Pose odd{(Eigen::Matrix3d() << 0.1, -0.0, 1.0 / 3, kTiny, -kHuge, 1e-300, 2, -7, 1e22).finished(),
           {0, -1.5, 3e8}};
  const std::vector<Pose> poses = {kPose, odd, Pose{}};
  const test::Folder folder;
  for (const char* name : {"p.txt", "p.csv", "p.CSV", "p.json", "p"}) {
    CAPTURE(name);
    io::save_poses(folder / name, poses);
    const io::PoseList back = io::open_poses(folder / name);
    REQUIRE(back.poses.size() == poses.size());
    REQUIRE(back.places.size() == poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      CHECK(same(back.poses[i], poses[i]));
      CHECK(std::signbit(back.poses[i].r(0, 1)) == std::signbit(poses[i].r(0, 1)));
    }
  }
}

// Files of results that an interrupted computation leaves.
#include <doctest/doctest.h>

#include "scenarios/io/files.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/error.hpp>

namespace lrb::test {
namespace {

TEST_CASE("unfinished files: complete lines of the same computation are continued, others dropped") {
  const Folder folder;
  const std::string path = folder / "unfinished.jsonl";
  using Lines = std::vector<std::string>;
  {
    io::UnfinishedFile file(path, "one");
    CHECK(file.lines().empty());
    file.add("first");
    file.add("second");
    CHECK(slurp(path) == "one\nfirst\nsecond\n");  // at once
  }
  folder.write("unfinished.jsonl", slurp(path) + "thi");  // cut off
  {
    io::UnfinishedFile file(path, "one");
    CHECK((file.lines() == Lines{"first", "second"}));
    file.add("third");
  }
  CHECK(slurp(path) == "one\nfirst\nsecond\nthird\n");
  using Other = io::UnfinishedFile::Other;
  CHECK_THROWS_WITH_AS(
      io::UnfinishedFile(path, "another", Other::refused),
      doctest::Contains("unfinished.jsonl: belongs to an interrupted run with other settings"), InputError);
  CHECK(slurp(path) == "one\nfirst\nsecond\nthird\n");
  CHECK(io::UnfinishedFile(path, "one", Other::refused).lines().size() == 3);
  {
    const io::UnfinishedFile file(path, "another");
    CHECK(file.lines().empty());
    CHECK(slurp(path) == "another\n");
    file.remove();
  }
  CHECK(!std::filesystem::exists(path));
  io::UnfinishedFile nothing("", "one");
  nothing.add("line");
  nothing.remove();
  CHECK(folder.tree().empty());
}

}  // namespace
}  // namespace lrb::test

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "tests/mesh/io/encode.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::test {

TEST_CASE("a file is complete after commit and unchanged before") {
  const Folder directory;
  const std::string path = directory / "a.txt", large(300000, 'x');
  save(path, "before");
  {
    AtomicFile file(path);
    file.write("one ");
    file.write(large);
    CHECK(load_bytes(path) == "before");
    file.commit();
  }
  CHECK(load_bytes(path) == "one " + large);
  CHECK(directory.tree().size() == 1);
  write_file(path, std::string("a\0b", 3));
  CHECK(load_bytes(path) == std::string("a\0b", 3));
}

TEST_CASE("a file that is not committed leaves no trace") {
  const Folder directory;
  {
    AtomicFile file(directory / "a.txt");
    file.write("half");
  }
  CHECK(directory.tree().size() == 0);
}

TEST_CASE("an unwritable path is reported with the reason") {
  const Folder directory;
  const auto message = [](const std::string& path) { return error_of([&] { write_file(path, "x"); }); };
  const std::string missing = directory / "none/a.txt";
  CHECK(message(missing).starts_with(missing + ": cannot create the file (No such file or directory); "));
  CHECK(message(directory / "").find("Is a directory") != std::string::npos);
  CHECK(directory.tree().size() == 0);
}

TEST_CASE("a full disk is an EnvironmentError") {
  if (!std::filesystem::exists("/dev/full")) {
    MESSAGE("skipped: no /dev/full here");
    return;
  }
  CHECK_THROWS_AS(write_file("/dev/full", "x"), EnvironmentError);
}

TEST_CASE("permissions and links are kept, special files are written to") {
  const Folder directory;
  const std::string path = directory / "a.txt", link = directory / "link";
  save(path, "before");
  chmod(path.c_str(), 0640);
  std::filesystem::create_symlink(path, link);
  write_file(link, "after");
  CHECK(load_bytes(path) == "after");
  CHECK(std::filesystem::is_symlink(link));
  struct stat status {};
  REQUIRE(stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
  write_file("/dev/null", "x");
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

}  // namespace lrb::test

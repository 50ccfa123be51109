#pragma once
/// The program itself, run in a folder of its own.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/folder.hpp"

namespace lrb::test {

/// Sets an environment variable while it lives.
struct Environment {
  Environment(const char* n, const std::string& value) : name(n) { setenv(name, value.c_str(), 1); }
  ~Environment() { unsetenv(name); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  const char* name;
};

inline std::string slurp(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

struct Outcome {
  int code = -1;
  std::string out, err;
  std::size_t error_lines() const {
    return static_cast<std::size_t>(std::count(err.begin(), err.end(), '\n'));
  }
};

/// Runs the program in the folder; arguments are quoted for the shell.
inline Outcome run(const Folder& folder, const std::vector<std::string>& arguments) {
  std::string line = "cd '" + folder.path.string() + "' && '" LRBSCOPE_BINARY "'";
  for (const std::string& a : arguments) line += " '" + a + "'";
  line += " >'" + folder / "stdout" + "' 2>'" + folder / "stderr" + "' </dev/null";
  const int status = std::system(line.c_str());
  Outcome o;
  o.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  o.out = slurp(folder / "stdout");
  o.err = slurp(folder / "stderr");
  std::filesystem::remove(folder / "stdout");
  std::filesystem::remove(folder / "stderr");
  return o;
}

}  // namespace lrb::test

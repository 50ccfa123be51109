#pragma once
/// A command of the program, asked again and again in a folder of its own.

#include <string>
#include <vector>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/json_lines.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::test {

/// Arguments that follow those of the command, and a part of the line that rejects them.
struct Rejected {
  std::vector<std::string> arguments;
  std::string says;
};

/// The folder has cube.obj, from 0 to 1, and small.obj, from 0.25 to 0.5.
struct Command {
  Folder folder;
  std::vector<std::string> words;  ///< with which every call begins

  explicit Command(std::vector<std::string> command) : words(std::move(command)) {
    folder.write("cube.obj", kCube);
    write_mesh(shapes::box({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}), folder / "small.obj");
  }
  std::vector<std::string> with(const std::vector<std::string>& more) const {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome run(const std::vector<std::string>& more = {}) const { return test::run(folder, with(more)); }
  std::vector<nlohmann::json> lines(const std::vector<std::string>& more = {}) const {
    return lines_of(folder, with(more));
  }
  /// Checks that each is rejected in one line, before anything is written.
  void check_refusals(const std::vector<Rejected>& table) const {
    for (const Rejected& rejected : table) {
      const Outcome o = check_rejected(folder, with(rejected.arguments));
      CHECK_MESSAGE(o.err.find(rejected.says) != std::string::npos, o.err);
    }
  }
};

}  // namespace lrb::test

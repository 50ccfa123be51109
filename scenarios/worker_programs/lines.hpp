#pragma once
/// The lines of JSON that a worker writes to stdout.

#include <cstdio>
#include <cstdlib>
#include <string>

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace lrb::worker_programs {

/// Our lines have a channel of their own, and libraries that print to stdout print to stderr instead.
class Lines {
 public:
  Lines() : out_(fdopen(dup(STDOUT_FILENO), "w")) { dup2(STDERR_FILENO, STDOUT_FILENO); }
  void say(const std::string& line) {
    if (out_ == nullptr || std::fputs(line.c_str(), out_) < 0 || std::fflush(out_) != 0)
      std::_Exit(1);  // nobody listens any more
  }

 private:
  std::FILE* out_;
};

inline std::string dump(const nlohmann::ordered_json& value) {
  return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lrb::worker_programs

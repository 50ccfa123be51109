#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

#include <nlohmann/json.hpp>
#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

int main(int argc, char** argv) {
  return lrb::tools::main(argc, argv);
}

namespace lrb::tools {
namespace {

int complain(const char* kind, const std::string& message, int code) {
  std::cerr << "lrbscope: " << kind << printable_name(message)
            << std::endl;  // one line, no control characters
  return code;
}

template <class Run>
int guarded(const Run& run) {
  try {
    return run();
  } catch (const InputError& e) {
    return complain("", e.what(), kBadInput);
  } catch (const EnvironmentError& e) {
    return complain("", e.what(), kEnvironment);
  } catch (const std::bad_alloc&) {
    return complain("", "out of memory: try a smaller input or a larger machine", kEnvironment);
  } catch (const std::length_error&) {  // a container larger than its maximum size
    return complain("", "out of memory: try a smaller input or a larger machine", kEnvironment);
  } catch (const std::system_error& e) {
    return complain("", std::string("system error: ") + e.what(), kEnvironment);
  } catch (const std::exception& e) {
    return complain("internal error, please report it: ", e.what(), kEnvironment);
  }
}

/// Enlarges the heap once, in large pages where the system has them, and keeps what is freed: a first answer
/// about two meshes of 100,000 faces takes 0.8 of the CPU time. Within a limit of memory the heap stays
/// small.
void use_large_pages() {
#ifdef __GLIBC__
  constexpr int kHeap = 1 << 28, kLargest = 1 << 25, kUsualPad = 1 << 17;
  constexpr std::uintptr_t kPage = 1 << 21;
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, 2 * kHeap);
  mallopt(M_TOP_PAD, kHeap);
  void* const first = std::malloc(kPage);
  mallopt(M_TOP_PAD, kUsualPad);
  const auto begin = (reinterpret_cast<std::uintptr_t>(first) + kPage - 1) / kPage * kPage,
             end = reinterpret_cast<std::uintptr_t>(sbrk(0));
  if (first != nullptr && end > begin && end - begin <= 2 * std::uintptr_t{kHeap})
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  std::free(first);
#endif
}

}  // namespace

void note(const Globals& globals, const std::vector<std::string>& lines) {
  if (globals.quiet) return;
  for (const std::string& line : lines) std::cerr << "note: " << line << "\n";
}

std::string for_people(const nlohmann::ordered_json& value, int digits) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) {
    if (!std::isfinite(value.get<double>())) return "beyond 1.8e308";
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value.get<double>());
    return text;
  }
  if (!value.is_structured()) return value.dump();
  std::string out;
  for (const auto& [key, item] : value.items()) {
    out += out.empty() ? "" : ", ";
    if (value.is_object()) out += key + " ";
    out += for_people(item, digits);
  }
  return value.is_array() ? "(" + out + ")" : out;
}

std::string one_line(const nlohmann::ordered_json& value) {
  return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void print(const std::string& text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return;
  const int reason = errno;
  if (reason == EPIPE) end_as_by_closed_pipe();
  throw EnvironmentError(std::string("stdout: cannot write (") + std::strerror(reason) +
                         "); check its target and the free space there");
}

namespace {

/// Returns the words of the command line in their usual form: `help COMMAND` and `version` become options,
/// and - stands for the standard input, but for the words of other programs.
std::vector<std::string> usual_form(std::vector<std::string> words) {
  if (words.empty()) return words;
  if (words[0] == "version") words[0] = "--version";
  if (words[0] == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  std::replace(words.begin(), std::ranges::find(words, "--"), std::string("-"), std::string("/dev/stdin"));
  return words;
}

/// Ensures that inputs can be read as often as a command likes, and that outputs do not replace them.
void prepare_files(const App& app) {
  static constexpr std::array<std::string_view, 7> kOutputs = {
      "--output", "--draw", "--draw-separation", "--chart", "--animate", "--junit", "--markdown"};
  std::vector<std::string> outputs;
  app.for_each_value([&](const std::string& option, const std::string& value) {
    if (std::ranges::find(kOutputs, option) != kOutputs.end()) return outputs.push_back(value);
    hold_pipe(value);
    protect_input(value);
  });
  std::for_each(outputs.begin(), outputs.end(), reject_input_as_output);
}

int parse_and_run(int argc, char** argv) {
  App app(
      "Exact collision detection for pairs of meshes, which can record, draw and explain every step of a "
      "query.",
      "lrbscope");
  app.set_version(std::string("lrbscope ") + trace::lrbscope_version());
  app.require_subcommand();
  app.fallthrough();
  app.footer(
      "Exit codes: 0 success, 1 mismatch, 2 usage or input error, 3 missing dependency or resource. See also "
      "`lrbscope help COMMAND`.");
  Globals globals;
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  globals.command_line = shell_line(words);
  app.add_flag("-q,--quiet", globals.quiet, "Print only errors to stderr");
  std::string cache;
  app.add_option("--cache", cache, "DIR",
                 "Folder that keeps the LRB-reps of meshes, so that they are built once [$LRBSCOPE_CACHE, or "
                 "none]");
  const std::vector<Command> commands = add_commands(app, globals);
  if (!words.empty() && words[0] == "__complete")
    return print_completions(app, {words.begin() + 1, words.end()});
  if (const std::optional<std::string> text = app.parse(usual_form(words))) {
    print(*text);
    return kOk;
  }
  prepare_files(app);
  // Before any thread starts. Programs that the command starts share the folder.
  if (!cache.empty()) setenv(bodies::kCacheVariable, cache.c_str(), 1);
  for (const Command& command : commands)
    if (command.app->parsed()) return command.run();
  return kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  use_large_pages();
  end_cleanly_on_signals();
  end_cleanly_on_terminate();
  return guarded([&] { return parse_and_run(argc, argv); });
}

}  // namespace lrb::tools

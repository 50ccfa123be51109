#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <limits>
#include <new>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/terminal.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

int main(int argc, char** argv) {
  return lrb::cli::main(argc, argv);
}

namespace lrb::cli {
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

/// Breaks a line of CLI11's help at spaces. Descriptions of options and commands are continued in their
/// column.
std::string wrapped(std::string line) {
  constexpr std::size_t kWidth = 100, kDescriptions = 30;  // kDescriptions: CLI11's default column
  const bool has_column = line.size() > kDescriptions && line[0] == ' ' && line[kDescriptions - 1] == ' ';
  const std::size_t indent = has_column ? kDescriptions : 0;
  std::string out;
  while (line.size() > kWidth) {
    const std::size_t space = line.rfind(' ', kWidth);
    if (space == std::string::npos || space <= indent) break;  // a word longer than the column
    out += line.substr(0, space) + "\n";
    line = std::string(indent, ' ') + line.substr(space + 1);
  }
  return out + line + "\n";
}

/// Prints CLI11's text for --help and --version, in lines of at most 100 columns.
int print_help(CLI::App& app, const CLI::ParseError& request) {
  std::stringstream text;
  app.exit(request, text, text);
  std::string out;
  for (std::string line; std::getline(text, line);) {
    line.erase(line.find_last_not_of(' ') + 1);  // CLI11 2.6 ends lines with a blank
    out += wrapped(line);
  }
  print(out);
  return kOk;
}

/// Returns the first argument that is not an option: the command's name.
std::string_view command_word(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (argv[i][0] != '-') return argv[i];
  return "";
}

/// Returns the selected command, down to subcommands: for `lrbscope golden test` it is test.
const CLI::App& named_command(const CLI::App& app) {
  const std::vector<CLI::App*> below = app.get_subcommands();
  return below.empty() ? app : named_command(*below.front());
}

/// Returns "lrbscope golden test".
std::string call_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : call_of(*app.get_parent()) + " " + app.get_name();
}

/// Returns "; did you mean \"x\"?" if a known word is close to this one, or an empty text.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = io::nearest_word(word, known);
  return near.empty() ? "" : "; did you mean \"" + near + "\"?";
}

/// Returns a message of CLI11 in the words of this program's own ones. `app`: the command.
std::string plain_message(const CLI::App& root, const CLI::App& app, const CLI::ParseError& error) {
  // CLI11 2.3: "0 to 1"; 2.6: "[0 - 1]".
  static const std::regex kRange("(.*): Value (.*) not in range \\[?(\\S+) (?:to|-) ([^\\s\\]]+)\\]?"),
      kValue("Could not convert: (.*) = (.*)"),
      kUnexpected("The following arguments? (?:was|were) not expected: .*");
  const std::string text = error.what();
  std::smatch m;
  const auto number = [](const std::string& digits) { return io::number_text(std::stod(digits), 6); };
  if (std::regex_match(text, m, kRange)) {
    const double high = std::stod(m[4]);
    return m[1].str() + ": expected " +
           (high < std::numeric_limits<float>::max() ? number(m[3]) + " to " + number(m[4])
                                                     : "at least " + number(m[3])) +
           ", found " + m[2].str();
  }
  if (std::regex_match(text, m, kValue)) {
    return m[1].str() + ": cannot read " + in_quotes(m[2].str());
  }
  if (!std::regex_match(text, kUnexpected)) return text;
  const std::vector<std::string> words = root.remaining(true);
  const auto option =
      std::find_if(words.begin(), words.end(), [](const std::string& w) { return w.starts_with("--"); });
  if (option == words.end()) return text;
  std::vector<std::string> known;
  for (const CLI::Option* o : app.get_options())
    for (const std::string& name : o->get_lnames()) known.push_back("--" + name);
  return in_quotes(*option) + " is not an option of " + call_of(app) + did_you_mean(*option, known);
}

/// Returns the error message for a command line that CLI11 rejected. `word`: the first word that is not an
/// option.
std::string usage_error(const CLI::App& root, const CLI::ParseError& error, std::string word) {
  const CLI::App* app = &root;
  const auto is_named = [&](const CLI::App* a) { return a->get_name() == word; };
  if (word.empty() || !root.get_subcommands(is_named).empty()) {
    app = &named_command(root);
    const std::vector<std::string> words = root.remaining(true);
    const auto other = std::find_if(words.begin(), words.end(),
                                    [](const std::string& w) { return !w.empty() && w[0] != '-'; });
    word = other == words.end() ? "" : *other;
  }
  const std::string help = " (see " + call_of(*app) + " --help)";
  std::vector<std::string> known;
  for (const CLI::App* c : app->get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
    known.push_back(c->get_name());
  if (known.empty() || word.empty()) return plain_message(root, *app, error) + help;
  return in_quotes(word) + " is not a command of " + call_of(*app) + did_you_mean(word, known) + help;
}

/// Throws InputError for an option or argument with an empty value: usually an unset shell variable.
void reject_empty_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& value : option->results())
      if (value.empty())
        throw InputError(option->get_name() +
                         ": expected a value, found an empty string; is a shell variable unset?");
  for (const CLI::App* below : app.get_subcommands()) reject_empty_values(*below);
}

int parse_and_run(int argc, char** argv) {
  CLI::App app(
      "Exact collision detection for pairs of meshes, which can record, draw and explain every step of a "
      "query.",
      "lrbscope");
  app.set_version_flag("--version", std::string("lrbscope ") + trace::lrbscope_version());
  app.require_subcommand(1);
  app.fallthrough();
  app.footer(
      "Exit codes: 0 success, 1 mismatch, 2 usage or input error, 3 missing dependency or resource. See also "
      "`lrbscope COMMAND --help`.");
  Globals globals;
  globals.command_line = shell_line({argv + std::min(argc, 1), argv + argc});
  app.add_flag("-q,--quiet", globals.quiet, "Print only errors to stderr");
  std::string cache;
  app.add_option("--cache", cache,
                 "Folder that keeps the LRB-reps of meshes, so that they are built once [$LRBSCOPE_CACHE, or "
                 "none]")
      ->type_name("DIR");
  const std::vector<Command> commands = add_commands(app, globals);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return print_help(app, e);
    return complain("", usage_error(app, e, std::string(command_word(argc, argv))), kBadInput);
  }
  reject_empty_values(app);
  // Before any thread starts. Programs that the command starts share the folder.
  if (!cache.empty()) setenv(bodies::kCacheVariable, cache.c_str(), 1);
  for (const Command& command : commands)
    if (command.app->parsed()) return command.run();
  return kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  end_cleanly_on_signals();
  end_cleanly_on_terminate();
  return guarded([&] { return parse_and_run(argc, argv); });
}

}  // namespace lrb::cli

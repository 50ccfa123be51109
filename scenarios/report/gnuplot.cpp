#include "scenarios/report/gnuplot.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenarios/io/files.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

extern char** environ;

namespace lrb::report {
namespace {

const char* program() {
  const char* given = std::getenv("LRB_GNUPLOT");
  return given != nullptr && *given != '\0' ? given : "gnuplot";
}

constexpr const char* kInstall = ": install Debian's gnuplot-nox, or set LRB_GNUPLOT to the program";

/// An unnamed temporary file: removed when it is closed, however the process ends.
class Scratch {
 public:
  Scratch() : file_(std::tmpfile()) {
    if (file_ == nullptr)
      throw EnvironmentError(std::string("gnuplot: no temporary file: ") + std::strerror(errno));
  }
  ~Scratch() { std::fclose(file_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  int descriptor() const { return fileno(file_); }
  void fill(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size() || std::fflush(file_) != 0)
      throw EnvironmentError(std::string("gnuplot: cannot write its script: ") + std::strerror(errno));
    std::rewind(file_);
  }
  std::string text() {
    std::string out;
    char buffer[1 << 14];
    std::rewind(file_);
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, file_)) out.append(buffer, n);
    return out;
  }

 private:
  std::FILE* file_;
};

struct Finished {
  bool started = false, good = false;
  std::string output, errors;
};

/// Runs gnuplot on a script passed on standard input; the picture is read from its standard output.
Finished run(const std::string& script) {
  Scratch in, out, errors;
  in.fill(script);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.descriptor(), STDERR_FILENO);
  std::string name = program(), from_input = "-";
  char* argv[] = {name.data(), from_input.data(), nullptr};
  pid_t child = -1;
  Finished finished;
  finished.started = posix_spawnp(&child, argv[0], &actions, nullptr, argv, environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  if (!finished.started) return finished;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  finished.good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  finished.output = out.text();
  finished.errors = errors.text();
  return finished;
}

/// Returns the command that sets the terminal. The font is DejaVu Sans, as in the pictures.
std::string terminal(const Gnuplot& chart, const std::string& ending) {
  constexpr double kInch = 25.4, kPointsPerInch = 72, kDpi = 300, kPngDpi = 96;
  const std::string font = " font 'DejaVu Sans," + io::number_text(chart.font) + "'";
  const auto size = [&](double dpi) {
    return " size " + io::number_text(std::round(chart.width / kInch * dpi)) + "," +
           io::number_text(std::round(chart.height / kInch * dpi));
  };
  if (ending == ".svg")
    return "svg noenhanced" + size(kPointsPerInch) + font + " linewidth 0.75 background '#ffffff'";
  if (ending == ".pdf")
    return "pdfcairo noenhanced size " + io::number_text(chart.width / kInch) + "," +
           io::number_text(chart.height / kInch) + font + " linewidth 0.75";
  if (ending == ".png")  // its fonts and lines are made for 96 dpi
    return "pngcairo noenhanced" + size(kDpi) + " fontscale " + io::number_text(kDpi / kPngDpi) + font +
           " linewidth " + io::number_text(kDpi / kPngDpi) + " pointscale " + io::number_text(kDpi / kPngDpi);
  throw InputError(ending + ": charts are written as .svg, .png or .pdf");
}

/// Returns the last message of gnuplot in one line: it names the line and the error.
std::string last_lines(const std::string& errors) {
  std::istringstream in(errors);
  std::string line, last;
  while (std::getline(in, line))
    if (line.find_first_not_of(" \t^\r") != std::string::npos)
      last = line.substr(line.find_first_not_of(" \t"));
  return last.empty() ? "it gave no reason" : last;
}

}  // namespace

bool has_gnuplot() {
  return run("exit\n").good;
}

void Gnuplot::add_data(std::string_view name, const std::vector<std::string>& rows) {
  script += "$" + std::string(name) + " << END_OF_" + std::string(name) + "\n";
  for (const std::string& row : rows) script += row + "\n";
  script += "END_OF_" + std::string(name) + "\n";
}

std::string gnuplot_text(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += c == '\n' || c == '\r' || c == '\0' ? ' ' : c;
  }
  return out + "'";
}

std::string gnuplot_data_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"')
      out += "''";  // a data field cannot contain one
    else if (c == '\\')
      out += "/";  // nor a backslash, which would start an escape
    else
      out += c == '\n' || c == '\r' || c == '\0' ? ' ' : c;
  }
  return out + "\"";
}

std::string drawn(const Gnuplot& chart, const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  Finished finished = run("set terminal " + terminal(chart, ending) + "\nset encoding utf8\n" + chart.script);
  if (!finished.started) throw EnvironmentError(path + ": there is no program " + program() + kInstall);
  if (!finished.good || finished.output.empty())
    throw EnvironmentError(path + ": " + program() + " failed: " + last_lines(finished.errors));
  return std::move(finished.output);
}

void draw(const Gnuplot& chart, const std::string& path) {
  io::write_text(path, drawn(chart, path));
}

}  // namespace lrb::report

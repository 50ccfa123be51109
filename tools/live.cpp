#include "scenarios/profile/live.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "render/page_palette.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/assets.hpp"
#include "tools/import.hpp"
#include "tools/loopback_server.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

extern char** environ;

namespace lrb::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct LiveOptions {
  std::vector<std::string> program;
  std::string record;
  std::uint16_t port = 0;
  bool ends_with_program = false;
};

/// The reading end of a named pipe.
class NamedPipe {
 public:
  explicit NamedPipe(const std::string& path) {
    if (mkfifo(path.c_str(), 0600) == 0) descriptor_ = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0)
      throw EnvironmentError(path + ": cannot make a named pipe: " + std::strerror(errno) + "; set TMPDIR");
    // A larger pipe rarely makes the program wait. The system may refuse.
    fcntl(descriptor_, F_SETPIPE_SZ, 1 << 20);
    const int size = fcntl(descriptor_, F_GETPIPE_SZ);
    capacity_ = size > 0 ? size : 1 << 16;
  }
  ~NamedPipe() { shut(); }
  NamedPipe(const NamedPipe&) = delete;
  NamedPipe& operator=(const NamedPipe&) = delete;

  int descriptor() const { return descriptor_; }
  /// Returns true if the writer is ahead: more than half of the pipe waits to be read.
  bool is_filling() const { return waiting() > capacity_ / 2; }
  bool is_empty() const { return waiting() == 0; }
  /// Reads the available bytes. Returns the number of bytes, 0 without a writer, and -1 if there is nothing
  /// yet.
  ssize_t read(std::vector<std::byte>& buffer) const {
    const ssize_t n = ::read(descriptor_, buffer.data(), buffer.size());
    return n < 0 ? -1 : n;
  }
  void shut() {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
  }

 private:
  /// Returns the number of bytes to read.
  int waiting() const {
    int out = 0;
    return ioctl(descriptor_, FIONREAD, &out) == 0 ? out : 0;
  }

  int descriptor_ = -1, capacity_ = 0;
};

/// The running program.
class Program {
 public:
  explicit Program(const std::vector<std::string>& words) : name_(words.front()) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    // The program gets the signals that this one handles on a thread.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, usual;
    sigemptyset(&none);
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int error = posix_spawnp(&id_, arguments[0], nullptr, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    if (error != 0)
      throw InputError(printable_name(name_) + ": cannot start the program: " + std::strerror(error));
  }
  ~Program() { end(); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  bool has_ended() {
    if (!ended_) ended_ = waitpid(id_, &status_, WNOHANG) == id_;
    return ended_;
  }
  /// Ends it: politely, and after two seconds in any case.
  void end() {
    if (has_ended()) return;
    kill(id_, SIGTERM);
    for (int i = 0; i < 100 && !has_ended(); ++i) usleep(20'000);
    if (has_ended()) return;
    kill(id_, SIGKILL);
    ended_ = waitpid(id_, &status_, 0) == id_;
  }
  /// Returns how it failed, or an empty text.
  std::string failure() const {
    if (WIFSIGNALED(status_))
      return printable_name(name_) + " was ended by signal " + std::to_string(WTERMSIG(status_));
    if (WEXITSTATUS(status_) != 0)
      return printable_name(name_) + " ended with exit code " + std::to_string(WEXITSTATUS(status_));
    return {};
  }

 private:
  std::string name_;
  pid_t id_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

std::string type_of(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".json" || extension == ".jsonl") return "application/json";
  if (extension == ".png") return "image/png";
  if (extension == ".svg") return "image/svg+xml";
  if (extension == ".txt") return "text/plain; charset=utf-8";
  return "application/octet-stream";
}

class Live {
 public:
  Live(const LiveOptions& options, const Globals& globals)
      : options_(options),
        globals_(globals),
        pipe_((folder_.path / "capture").string()),
        server_(options.port, [this](const std::string& target) { return answer(target); }),
        stream_(options.program.front()),
        queries_(stream_.descriptions()) {
    if (!options.record.empty()) {
      record_.open(options.record, std::ios::binary);
      if (!record_) throw EnvironmentError(printable_name(options.record) + ": cannot write the file");
    }
  }

  int run() {
    setenv("LRBCAP_OUT", (folder_.path / "capture").c_str(), 1);
    Program program(options_.program);
    note(globals_, {"live: " + server_.url()});
    // A program may continue after the end of its capture.
    while (!stop_.has_arrived() && !(is_over_ && options_.ends_with_program && program.has_ended())) {
      wait();
      server_.serve();
      if (!is_over_) {
        const bool has_ended = program.has_ended();  // before the read that must find all it wrote
        read_pipe(has_ended);
      }
      check_rest();
      send_update();
    }
    program.end();
    if (!is_over_) read_pipe(true);
    return report(program);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void wait() {
    std::vector<pollfd> waiting;
    waiting.push_back({stop_.descriptor(), POLLIN, 0});
    if (!is_over_) waiting.push_back({pipe_.descriptor(), POLLIN, 0});
    server_.add_to(waiting);
    constexpr int kMilliseconds = 100;
    // Before its first writer a pipe is quiet; after its last one it is over.
    poll(waiting.data(), waiting.size(), kMilliseconds);
  }

  void read_pipe(bool has_ended) {
    constexpr auto kAtOnce = std::chrono::milliseconds(100);
    const auto begin = Clock::now();
    while (Clock::now() - begin < kAtOnce) {
      const ssize_t n = pipe_.read(buffer_);
      if (n < 0) return;
      if (n == 0) {
        // No writer: not yet, or no longer.
        if (stream_.has_begun() || has_ended) finish();
        return;
      }
      const auto bytes = std::span(buffer_).first(static_cast<std::size_t>(n));
      if (record_.is_open())
        record_.write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
      stream_.feed(bytes, [&](capture::Query query) {
        unsent_.push_back(query.number);
        queries_.add(std::move(query), options_.ends_with_program || !pipe_.is_filling());
      });
    }
  }

  /// Checks queries that were left out, while the program is quiet.
  void check_rest() {
    constexpr auto kAtOnce = std::chrono::milliseconds(50);
    const auto begin = Clock::now();
    while (Clock::now() - begin < kAtOnce && (is_over_ || pipe_.is_empty())) {
      const auto checked = queries_.check_one();
      if (!checked) return;
      unsent_.push_back(*checked);
    }
  }

  void finish() {
    is_over_ = true;
    pipe_.shut();
    has_changed_ = true;
  }

  ordered_json state() const {
    ordered_json out = queries_.sums_json();
    out["program"] = joined(options_.program);
    out["running"] = !is_over_;
    return out;
  }
  static std::string joined(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " ") + shell_word(word);
    return out;
  }

  /// Returns JSON without a line break, as server-sent events need it.
  static std::string text_of(const ordered_json& value) {
    std::string out = one_line(value);
    while (out.ends_with('\n')) out.pop_back();
    return out;
  }

  /// Sends the queries since the last update, at most some times a second.
  void send_update() {
    constexpr auto kEvery = std::chrono::milliseconds(200);
    if ((unsent_.empty() && !has_changed_) || Clock::now() - sent_ < kEvery) return;
    if (server_.streams() > 0) {
      ordered_json update{{"state", state()}, {"queries", ordered_json::array()}};
      for (const std::uint32_t number : unsent_)
        if (const profile::LiveQuery* query = queries_.find(number))
          update["queries"].push_back(queries_.json_of(*query));
      server_.send(text_of(update));
    }
    unsent_.clear();
    has_changed_ = false;
    sent_ = Clock::now();
  }

  HttpAnswer answer(const std::string& target) {
    try {
      if (target == "/") return {200, "text/html; charset=utf-8", page()};
      if (target == "/events") {
        ordered_json all{{"state", state()}, {"queries", ordered_json::array()}};
        for (const profile::LiveQuery& query : queries_.kept())
          all["queries"].push_back(queries_.json_of(query));
        return {200, "text/event-stream", "retry: 1000\ndata: " + text_of(all) + "\n\n", true};
      }
      constexpr std::string_view kQueries = "/queries/";
      if (target.starts_with(kQueries)) return file_of_query(target.substr(kQueries.size()));
    } catch (const std::exception& e) {
      return {500, "text/plain; charset=utf-8", std::string(e.what()) + "\n"};
    }
    return {404, "text/plain", "Not Found\n"};
  }

  /// Answers "12/index.html": a file of the page of query 12, which is made at the first request.
  HttpAnswer file_of_query(const std::string& path) {
    const HttpAnswer not_found{404, "text/plain; charset=utf-8",
                               "The query is no longer kept, or has no events.\n"};
    const std::size_t slash = path.find('/');
    const std::string number = path.substr(0, slash);
    if (slash == std::string::npos || number.empty() || number.size() > 9 ||
        number.find_first_not_of("0123456789") != std::string::npos)
      return not_found;
    const fs::path folder = folder_.path / ("query-" + number);
    if (!fs::exists(folder / "index.html")) {
      const profile::LiveQuery* query = queries_.find(static_cast<std::uint32_t>(std::stoul(number)));
      if (query == nullptr || !query->has_events) return not_found;
      write_query_page(queries_.capture_of(*query), joined(options_.program), folder.string(), globals_);
    }
    const std::string rest = path.substr(slash + 1);
    std::error_code error;
    const fs::path file = fs::weakly_canonical(folder / (rest.empty() ? "index.html" : rest), error);
    const fs::path home = fs::weakly_canonical(folder, error);
    // Only files below the folder: no "..", and no links.
    const auto ends = std::mismatch(home.begin(), home.end(), file.begin(), file.end());
    if (error || ends.first != home.end() || !fs::is_regular_file(file))
      return {404, "text/plain", "Not Found\n"};
    return {200, type_of(file), io::read_text(file.string())};
  }

  std::string page() const {
    return report::filled(io::embedded_file("live.html"),
                          {{"style", render::page_root_css() + std::string(io::embedded_file("page.css")) +
                                         std::string(io::embedded_file("live.css"))},
                           {"script", report::script_of(std::array<std::string, 1>{"live"})}});
  }

  int report(const Program& program) {
    const std::string name = printable_name(options_.program.front());
    if (!stream_.has_begun()) {
      const std::string failure = program.failure();
      throw InputError(
          name + ": recorded nothing" + (failure.empty() ? "" : " (" + failure + ")") +
          "; compile it with -DLRBCAP_ENABLE, and open the capture with LRBCAP_OPEN(engine, NULL)");
    }
    if (record_.is_open() && !record_.flush())
      throw EnvironmentError(printable_name(options_.record) + ": cannot write the file");
    std::vector<std::string> notes;
    if (stream_.descriptions().cut_off)
      notes.push_back(
          "the capture has no end: the program did not call LRBCAP_CLOSE(), or was ended" +
          (stream_.unfinished() > 0
               ? "; " + render::counted(stream_.unfinished(), "query has", "queries have") + " no end"
               : std::string()));
    const std::string failure = program.failure();
    const bool was_stopped = stop_.has_arrived();
    if (!failure.empty() && !was_stopped) notes.push_back(failure);
    note(globals_, notes);
    const std::string& engine = stream_.descriptions().engine;
    print((engine.empty() ? name : printable_name(engine)) + ": " + queries_.summary() + "\n" +
          wrong_lines());
    const auto wrong = queries_.sums().outcomes[static_cast<std::size_t>(profile::Judgement::wrong)];
    return wrong > 0 || (!failure.empty() && !was_stopped) ? kMismatch : kOk;
  }

  std::string wrong_lines() const {
    constexpr int kShown = 10;
    std::string out;
    int shown = 0;
    for (const profile::LiveQuery& query : queries_.kept())
      if (query.is_wrong() && ++shown <= kShown)
        out += "  query " + std::to_string(query.query.number) + ": " +
               query.explanation.substr(0, query.explanation.find('\n')) + "\n";
    return out;
  }

  const LiveOptions& options_;
  const Globals& globals_;
  io::TemporaryFolder folder_;
  StopSignal stop_;
  NamedPipe pipe_;
  LoopbackServer server_;
  capture::Stream stream_;
  profile::LiveQueries queries_;
  std::ofstream record_;
  std::vector<std::byte> buffer_ = std::vector<std::byte>(1 << 18);
  bool is_over_ = false, has_changed_ = false;
  std::vector<std::uint32_t> unsent_;  ///< queries since the last update
  Clock::time_point sent_;
};

}  // namespace

Command add_live(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "live",
      "Run a program that records its collision queries with lrbscope_capture.h, and show each query, "
      "checked, on a page that follows the program");
  const auto o = std::make_shared<LiveOptions>();
  app->add_option("PROGRAM", o->program, "The program and its arguments, after --")->required();
  app->add_option("--port", o->port, "N", "Port of the page on 127.0.0.1 [0: any free one]");
  app->add_option("-o,--output", o->record, "FILE", "Also write the capture to this file");
  app->add_flag(
      "--exit", o->ends_with_program,
      "End with the program, instead of serving the page until Ctrl-C. Every query is checked: the program "
      "waits if necessary. Otherwise queries are left out while the program is faster than the check");
  return {app, [o, &globals] { return Live(*o, globals).run(); }};
}

}  // namespace lrb::cli

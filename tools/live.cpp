#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "render/page_palette.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/profile/check.hpp"
#include "scenarios/report/assets.hpp"
#include "tools/import.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

// After Eigen, whose parameters have the name of a macro of <resolv.h>.
#include <httplib.h>

extern char** environ;

namespace lrb::tools {
namespace {

using nlohmann::ordered_json;
using profile::Judgement;

struct LiveOptions {
  std::vector<std::string> program;
  std::string record;
  std::uint16_t port = 0;
  bool ends_with_program = false;
};

/// The running program.
class Program {
 public:
  explicit Program(const std::vector<std::string>& words) : name_(printable_name(words.front())) {
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
    if (error != 0) throw InputError(name_ + ": cannot start the program: " + std::strerror(error));
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
    if (!has_ended()) kill(id_, SIGTERM);
    for (int i = 0; i < 100 && !has_ended(); ++i) usleep(20'000);
    if (has_ended()) return;
    kill(id_, SIGKILL);
    ended_ = waitpid(id_, &status_, 0) == id_;
  }
  /// Returns how it failed, or an empty text.
  std::string failure() const {
    if (WIFSIGNALED(status_)) return name_ + " was ended by signal " + std::to_string(WTERMSIG(status_));
    const int code = WEXITSTATUS(status_);
    return code == 0 ? "" : name_ + " ended with exit code " + std::to_string(code);
  }

 private:
  std::string name_;
  pid_t id_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

struct LiveQuery {
  capture::Query query;
  std::string verdict = "not checked", explanation = {};
};

/// The queries of a running engine, checked as they end. Memory is bounded.
class LiveQueries {
 public:
  explicit LiveQueries(const capture::Capture& descriptions)
      : descriptions_(descriptions), bodies_(descriptions) {}

  const std::deque<LiveQuery>& kept() const { return kept_; }

  void add(capture::Query query, bool is_to_check) {
    kept_.push_back({std::move(query)});
    events_ += kept_.back().query.events.size();
    if (is_to_check)
      check(kept_.back());
    else
      ++unchecked_;
    forget();
  }
  const LiveQuery* find(std::uint32_t number) const {
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const auto& q) { return q.query.number == number; });
    return found == kept_.end() ? nullptr : &*found;
  }
  std::uint64_t count(Judgement judgement) const {
    return sums_.outcomes[static_cast<std::size_t>(judgement)];
  }
  /// Returns "1 200 queries: 1 190 right, 2 wrong, 8 not checked".
  std::string summary() const {
    std::string out = render::counted(sums_.queries + unchecked_, "query", "queries");
    const char* separator = ": ";
    for (const Judgement j :
         {Judgement::right, Judgement::undecidable, Judgement::wrong, Judgement::unchecked}) {
      const bool is_unchecked = j == Judgement::unchecked;
      const std::uint64_t n = count(j) + (is_unchecked ? unchecked_ : 0);
      if (n == 0) continue;
      out += separator + render::group_digits(n) + " " +
             (is_unchecked ? "not checked" : std::string(name_of(j)));
      separator = ", ";
    }
    return out;
  }
  std::string advice() const { return sums_.queries > 0 ? profile::advice(sums_.prices) : ""; }

 private:
  void check(LiveQuery& live) {
    const std::array now{descriptions_.meshes.size(), descriptions_.trees.size()};
    if (!checker_ || now != known_) {
      bodies_.update();
      checker_.emplace(bodies_, profile::precision_of(descriptions_));
      known_ = now;
    }
    const auto trees = bodies_.trees_of(live.query);
    const auto walk = trees ? std::make_unique<profile::QueryWalk>(bodies_, live.query, *trees) : nullptr;
    const profile::QueryVerdict verdict = checker_->check(live.query, walk.get());
    sums_ += profile::sums_of(
        {verdict, profile::PriceBook(bodies_).add(live.query, walk.get(), verdict.exact, false)});
    live.verdict =
        verdict.outcome == Judgement::unchecked ? "not checked" : std::string(name_of(verdict.outcome));
    if (verdict.answer == Judgement::wrong || verdict.answer == Judgement::undecidable)
      live.explanation = verdict.remark;
    else if (!verdict.wrong.empty())
      live.explanation =
          sentence(verdict.wrong.front(), bodies_.tree((*trees)[0]), bodies_.tree((*trees)[1]));
  }

  /// Drops old queries, right ones first.
  void forget() {
    constexpr std::size_t kLast = 200, kMaxKept = 400, kMaxEvents = 8'000'000;
    while (kept_.size() > kLast || (events_ > kMaxEvents && kept_.size() > 1)) {
      auto old =
          std::find_if(kept_.begin(), kept_.end() - 1, [](const auto& q) { return q.verdict != "wrong"; });
      const bool is_recent = kept_.end() - old <= static_cast<std::ptrdiff_t>(kLast);
      if (is_recent && kept_.size() <= kMaxKept && events_ <= kMaxEvents) return;
      if (is_recent) old = kept_.begin();
      events_ -= old->query.events.size();
      kept_.erase(old);
    }
  }

  const capture::Capture& descriptions_;  ///< grow while the engine runs
  profile::CapturedBodies bodies_;
  std::optional<profile::Checker> checker_;
  std::array<std::size_t, 2> known_{};  ///< number of meshes and trees in `bodies_`
  std::deque<LiveQuery> kept_;
  profile::CheckSums sums_;  ///< of the checked queries
  std::uint64_t unchecked_ = 0, events_ = 0;
};

class Live {
 public:
  Live(const LiveOptions& options, const Globals& globals)
      : options_(options),
        globals_(globals),
        pipe_path_(folder_.path / "capture"),
        stream_(options.program.front()),
        queries_(stream_.descriptions()) {
    if (mkfifo(pipe_path_.c_str(), 0600) == 0)
      pipe_ = open(pipe_path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (pipe_ < 0)
      throw EnvironmentError(pipe_path_ + ": cannot make a named pipe: " + std::strerror(errno) +
                             "; set TMPDIR");
    fcntl(pipe_, F_SETPIPE_SZ, kPipeBytes);  // rarely makes the program wait; the system may refuse
    if (!options.record.empty()) record_.emplace(options.record);
    serve();
  }
  ~Live() {
    server_.stop();
    if (serving_.joinable()) serving_.join();
    close(pipe_);
  }
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;

  int run() {
    setenv("LRBCAP_OUT", pipe_path_.c_str(), 1);
    Program program(options_.program);
    note(globals_, {"live: http://127.0.0.1:" + std::to_string(port_) + "/"});
    // A program may continue after the end of its capture.
    while (!stop_.has_arrived() && !(is_over_ && options_.ends_with_program && program.has_ended())) {
      pollfd waiting[] = {{stop_.descriptor(), POLLIN, 0}, {pipe_, POLLIN, 0}};
      constexpr int kMilliseconds = 100;
      poll(waiting, is_over_ ? 1 : 2, kMilliseconds);
      const bool has_ended = program.has_ended();  // before the read that must find all it wrote
      read_pipe(has_ended);
    }
    program.end();
    read_pipe(true);
    return report(program);
  }

 private:
  static constexpr int kPipeBytes = 1 << 20;

  /// Returns true if more than half of the pipe waits to be read.
  bool is_behind() const {
    int waiting = 0;
    return ioctl(pipe_, FIONREAD, &waiting) == 0 && waiting > fcntl(pipe_, F_GETPIPE_SZ) / 2;
  }

  /// Reads all that waits in the pipe. Without a writer, the capture is over if it began or the program
  /// ended.
  void read_pipe(bool has_ended) {
    while (!is_over_ && !stop_.has_arrived()) {
      const ssize_t n = read(pipe_, buffer_.data(), buffer_.size());
      if (n < 0) return;
      const std::lock_guard lock(mutex_);
      is_over_ = n == 0 && (stream_.has_begun() || has_ended);
      if (n == 0) return;
      const auto bytes = std::span(buffer_).first(static_cast<std::size_t>(n));
      if (record_) record_->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      stream_.feed(bytes, [&](capture::Query query) {
        queries_.add(std::move(query), options_.ends_with_program || !is_behind());
      });
    }
  }

  /// Serves the page on a thread: GET only, on 127.0.0.1. Requests that name another host are rejected, so
  /// that no page of the web can read the answers by DNS rebinding.
  void serve() {
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      using Handled = httplib::Server::HandlerResponse;
      const std::string host = request.get_header_value("Host"), end = ":" + std::to_string(port_);
      if (request.get_header_value_count("Host") == 1 &&
          (host == "127.0.0.1" + end || host == "localhost" + end)) {
        const std::lock_guard lock(mutex_);
        make_page_for(request.path);
        return Handled::Unhandled;
      }
      response.status = 403;
      return Handled::Handled;
    });
    server_.Get("/", [](const httplib::Request&, httplib::Response& response) {
      const std::string style = render::page_root_css() + std::string(io::embedded_file("page.css"));
      response.set_content(report::filled(io::embedded_file("live.html"), {{"style", style}}),
                           "text/html; charset=utf-8");
    });
    server_.Get("/state", [this](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock(mutex_);
      response.set_content(one_line(state()), "application/json");
    });
    server_.set_keep_alive_max_count(1);  // so that stop() does not wait for clients
    server_.set_default_headers({{"Cache-Control", "no-store"}, {"X-Content-Type-Options", "nosniff"}});
    std::filesystem::create_directory(folder_.path / "queries");
    server_.set_mount_point("/queries", (folder_.path / "queries").string());
    port_ = options_.port == 0                                 ? server_.bind_to_any_port("127.0.0.1")
            : server_.bind_to_port("127.0.0.1", options_.port) ? options_.port
                                                               : -1;
    if (port_ < 0)
      throw EnvironmentError("--port " + std::to_string(options_.port) +
                             ": cannot serve there; choose another port, or 0 for any");
    serving_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::yield();  // stop() needs it
  }

  /// Makes the page of a query before the first request of a path such as "/queries/12/index.html".
  void make_page_for(const std::string& path) {
    constexpr std::string_view kQueries = "/queries/";
    if (!path.starts_with(kQueries)) return;
    const std::string number =
        path.substr(kQueries.size(), path.find('/', kQueries.size()) - kQueries.size());
    if (number.empty() || number.size() > 9 || number.find_first_not_of("0123456789") != std::string::npos)
      return;
    const std::filesystem::path folder = folder_.path / "queries" / number;
    const LiveQuery* const query = queries_.find(static_cast<std::uint32_t>(std::stoul(number)));
    if (query == nullptr || !is_shown(*query) || exists(folder)) return;
    capture::Capture one = stream_.descriptions();
    one.queries = {query->query};
    one.cut_off = false;
    write_query_page(one, command(), folder.string(), globals_);
  }

  static bool is_shown(const LiveQuery& q) {
    return q.query.trees[0] != kNull &&
           (q.query.trees[1] != kNull || q.query.probe.shape != capture::ProbeShape::none);
  }

  std::string command() const {
    std::string out;
    for (const std::string& word : options_.program) out += (out.empty() ? "" : " ") + shell_word(word);
    return out;
  }

  ordered_json state() const {
    ordered_json out{{"program", command()},        {"engine", stream_.descriptions().engine},
                     {"running", !is_over_},        {"summary", queries_.summary()},
                     {"advice", queries_.advice()}, {"queries", ordered_json::array()}};
    for (const LiveQuery& q : queries_.kept()) {
      std::uint64_t tests = 0;
      for (const capture::Event& e : q.query.events)
        if (e.kind == capture::EventKind::nodes || e.kind == capture::EventKind::triangles) tests += e.tests;
      out["queries"].push_back({{"number", q.query.number},
                                {"verdict", q.verdict},
                                {"us", q.query.duration_ns / 1000},
                                {"tests", tests},
                                {"pairs", q.query.pairs},
                                {"explanation", q.explanation},
                                {"run", is_shown(q)}});
    }
    return out;
  }

  int report(const Program& program) {
    const std::string name = printable_name(options_.program.front()), failure = program.failure();
    if (!stream_.has_begun())
      throw InputError(
          name + ": recorded nothing" + (failure.empty() ? "" : " (" + failure + ")") +
          "; compile it with -DLRBCAP_ENABLE, and open the capture with LRBCAP_OPEN(engine, NULL)");
    if (record_) record_->commit();
    if (stream_.descriptions().cut_off)
      note(globals_, {"the capture has no end: the program did not call LRBCAP_CLOSE(), or was ended"});
    const bool failed = !failure.empty() && !stop_.has_arrived();
    if (failed) note(globals_, {failure});
    const std::string& engine = stream_.descriptions().engine;
    std::string out = (engine.empty() ? name : printable_name(engine)) + ": " + queries_.summary() + "\n";
    int shown = 0;
    for (const LiveQuery& q : queries_.kept())
      if (constexpr int kShown = 10; q.verdict == "wrong" && ++shown <= kShown)
        out += "  query " + std::to_string(q.query.number) + ": " + q.explanation + "\n";
    print(out);
    return queries_.count(Judgement::wrong) > 0 || failed ? kMismatch : kOk;
  }

  const LiveOptions& options_;
  const Globals& globals_;
  io::TemporaryFolder folder_;
  const std::string pipe_path_;
  StopSignal stop_;  // before the thread, which must not receive the signals
  int pipe_ = -1, port_ = 0;
  std::optional<AtomicFile> record_;
  std::vector<std::byte> buffer_ = std::vector<std::byte>(1 << 18);

  std::mutex mutex_;  ///< guards the members below, which the server's threads read
  capture::Stream stream_;
  LiveQueries queries_;
  bool is_over_ = false;

  httplib::Server server_;
  std::thread serving_;
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

}  // namespace lrb::tools

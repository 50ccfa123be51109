#pragma once
/// A small HTTP/1.1 server for pages of this machine: GET only, on 127.0.0.1, single-threaded, without
/// waiting for slow readers. Requests that name another host are rejected, so that no page of the web can
/// read the answers by DNS rebinding.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <poll.h>

namespace lrb::cli {

/// The target of a valid GET request, without its query part; otherwise the status of the answer.
struct HttpRequest {
  int status = 200;    ///< 200, or 400, 403, 405
  std::string target;  ///< "/queries/12/index.html", with %XX decoded
};
/// Parses the head of a request, which ends with an empty line. `port`: of the server.
HttpRequest parse_request(std::string_view head, std::uint16_t port);

struct HttpAnswer {
  int status = 200;
  std::string type = "text/html; charset=utf-8";
  std::string content;
  /// Server-sent events: the connection stays open, and gets what LoopbackServer::send() is given.
  bool is_stream = false;
};

class LoopbackServer {
 public:
  /// `port` 0: any free one. Throws EnvironmentError if the port is in use.
  LoopbackServer(std::uint16_t port, std::function<HttpAnswer(const std::string& target)> answer);
  ~LoopbackServer();
  LoopbackServer(const LoopbackServer&) = delete;
  LoopbackServer& operator=(const LoopbackServer&) = delete;

  std::uint16_t port() const { return port_; }
  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/"; }
  /// Appends the descriptors to wait for.
  void add_to(std::vector<pollfd>& waiting) const;
  /// Accepts connections, reads requests and writes answers, as far as this is possible without waiting.
  void serve();
  /// Sends an event to all streams. A reader with more than 4 MB unread is disconnected; browsers reconnect.
  void send(const std::string& data);
  /// Returns the number of open streams.
  std::size_t streams() const;

 private:
  struct Connection {
    int descriptor = -1;
    std::string request, pending;
    bool is_stream = false, is_answered = false, is_closed = false;
  };
  void read(Connection& c);
  void write(Connection& c);

  std::function<HttpAnswer(const std::string& target)> answer_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::vector<Connection> connections_;
};

}  // namespace lrb::cli

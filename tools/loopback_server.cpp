#include "tools/loopback_server.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <lrbscope/error.hpp>

namespace lrb::cli {
namespace {

constexpr std::size_t kMaxRequest = 16'384, kMaxUnread = 4'000'000, kMaxConnections = 64;

std::string_view reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    default:
      return "Internal Server Error";
  }
}

std::string head_of(const HttpAnswer& answer) {
  std::string out = "HTTP/1.1 " + std::to_string(answer.status) + " " + std::string(reason_of(answer.status));
  out += "\r\nContent-Type: " + answer.type +
         "\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n";
  // Streams end with the connection.
  if (!answer.is_stream) out += "Content-Length: " + std::to_string(answer.content.size()) + "\r\n";
  return out + "Connection: close\r\n\r\n";
}

/// Decodes %XX. Returns nullopt for a malformed sequence, and for NUL.
std::optional<std::string> decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    const std::string digits(text.substr(i + 1, 2));
    if (digits.size() != 2 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
      return std::nullopt;
    const int code = std::stoi(digits, nullptr, 16);
    if (code == 0) return std::nullopt;
    out += static_cast<char>(code);
    i += 2;
  }
  return out;
}

/// Returns the value of a header, or nullopt if it is missing or given twice.
std::optional<std::string> header(std::string_view head, std::string_view wanted) {
  std::optional<std::string> out;
  std::size_t at = head.find("\r\n");
  while (at != std::string_view::npos && at + 2 < head.size()) {
    const std::size_t begin = at + 2, end = std::min(head.size(), head.find("\r\n", begin));
    const std::string_view line = head.substr(begin, end - begin);
    const std::size_t colon = line.find(':');
    const bool is_wanted =
        colon == wanted.size() && std::equal(wanted.begin(), wanted.end(), line.begin(), [](char x, char y) {
          return x == (y >= 'A' && y <= 'Z' ? y - 'A' + 'a' : y);
        });
    if (is_wanted) {
      if (out) return std::nullopt;
      const std::size_t first = line.find_first_not_of(" \t", colon + 1);
      const std::size_t last = line.find_last_not_of(" \t");
      out = first == std::string_view::npos ? "" : std::string(line.substr(first, last + 1 - first));
    }
    at = end;
  }
  return out;
}

}  // namespace

HttpRequest parse_request(std::string_view head, std::uint16_t port) {
  const std::string_view line = head.substr(0, head.find("\r\n"));
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last || !line.substr(last + 1).starts_with("HTTP/1."))
    return {400, {}};
  if (line.substr(0, first) != "GET") return {405, {}};
  const std::string_view path = line.substr(first + 1, last - first - 1);
  const auto target = decoded(path.substr(0, path.find('?')));
  if (!target || !target->starts_with('/')) return {400, {}};
  const auto host = header(head, "host");
  const std::string at_port = ":" + std::to_string(port);
  if (!host || (*host != "127.0.0.1" + at_port && *host != "localhost" + at_port)) return {403, {}};
  return {200, *target};
}

LoopbackServer::LoopbackServer(std::uint16_t port, std::function<HttpAnswer(const std::string&)> answer)
    : answer_(std::move(answer)) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  socklen_t size = sizeof address;
  if (listener_ < 0 || setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || listen(listener_, 16) != 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    const std::string why = std::strerror(errno);
    if (listener_ >= 0) close(listener_);
    throw EnvironmentError("--port " + std::to_string(port) + ": cannot serve there: " + why +
                           "; choose another port, or 0 for any");
  }
  port_ = ntohs(address.sin_port);
}

LoopbackServer::~LoopbackServer() {
  for (const Connection& c : connections_) close(c.descriptor);
  close(listener_);
}

void LoopbackServer::add_to(std::vector<pollfd>& waiting) const {
  waiting.push_back({listener_, POLLIN, 0});
  for (const Connection& c : connections_)
    waiting.push_back({c.descriptor, static_cast<short>(c.pending.empty() ? POLLIN : POLLIN | POLLOUT), 0});
}

void LoopbackServer::serve() {
  while (true) {
    const int accepted = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (accepted < 0) break;
    if (connections_.size() < kMaxConnections) {
      connections_.emplace_back();
      connections_.back().descriptor = accepted;
    } else {
      close(accepted);
    }
  }
  for (Connection& c : connections_) {
    read(c);
    write(c);
  }
  std::erase_if(connections_, [](const Connection& c) {
    if (c.is_closed) close(c.descriptor);
    return c.is_closed;
  });
}

void LoopbackServer::read(Connection& c) {
  char buffer[4096];
  while (!c.is_closed) {
    const ssize_t n = recv(c.descriptor, buffer, sizeof buffer, 0);
    if (n < 0) {
      if (errno != EAGAIN && errno != EINTR) c.is_closed = true;
      break;
    }
    // The reader may have closed its half after the request.
    if (n == 0) {
      if (c.is_stream || !c.is_answered) c.is_closed = true;
      break;
    }
    if (c.is_answered) continue;  // one request for each connection
    c.request.append(buffer, static_cast<std::size_t>(n));
    const std::size_t end = c.request.find("\r\n\r\n");
    if (end == std::string::npos && c.request.size() <= kMaxRequest) continue;
    c.is_answered = true;
    const HttpRequest request =
        end == std::string::npos ? HttpRequest{400, {}} : parse_request(c.request.substr(0, end + 2), port_);
    HttpAnswer answer;
    if (request.status == 200) {
      answer = answer_(request.target);
    } else {
      answer = {request.status, "text/plain", std::string(reason_of(request.status)) + "\n"};
    }
    c.is_stream = answer.is_stream;
    c.pending = head_of(answer) + answer.content;
  }
}

void LoopbackServer::write(Connection& c) {
  while (!c.is_closed && !c.pending.empty()) {
    const ssize_t n = ::send(c.descriptor, c.pending.data(), c.pending.size(), MSG_NOSIGNAL);
    if (n < 0) {
      if (errno != EAGAIN && errno != EINTR) c.is_closed = true;
      return;
    }
    c.pending.erase(0, static_cast<std::size_t>(n));
  }
  if (c.is_answered && !c.is_stream && c.pending.empty()) c.is_closed = true;
}

void LoopbackServer::send(const std::string& data) {
  for (Connection& c : connections_) {
    if (!c.is_stream) continue;
    if (c.pending.size() + data.size() > kMaxUnread)
      c.is_closed = true;
    else
      c.pending += "data: " + data + "\n\n";
  }
}

std::size_t LoopbackServer::streams() const {
  return static_cast<std::size_t>(std::count_if(connections_.begin(), connections_.end(),
                                                [](const Connection& c) { return c.is_stream; }));
}

}  // namespace lrb::cli

// Any bytes on a connection: head, framing, pipelining and rejections. The server reads the same requests and
// sends well-formed answers, however the bytes are divided into packets.

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "server/connections/connection.h"
#include "server/routes.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/target.h"

namespace fleetplan::fuzz {

namespace TEST_FILE {

/// The requests that reached the service, in order.
using Requests = std::vector<std::string>;

struct Conversation {
  Requests requests;
  std::string answers;  // the bytes that the server sent
};

server::Settings settings() {
  server::Settings settings;
  settings.limits.max_body = 500;
  settings.log_level = "off";
  return settings;
}

std::string joined(const Requests& requests) {
  std::string text;
  for (const std::string& request : requests) text += request + '\n';
  return text;
}

/// Until the connection ends.
void serve(server::Connection&& connection) {
  while (const auto wait = connection.go_on()) {
    pollfd wanted{connection.fd(), static_cast<short>(wait->for_input ? POLLIN : POLLOUT), 0};
    ::poll(&wanted, 1, 1000);
  }
}

/// Sends the bytes in packets of the given size (0: all at once), closes the sending side, and serves the
/// connection until it ends.
Conversation converse(std::string_view bytes, std::size_t packet) {
  static const server::Settings kSettings = settings();
  static const server::StaticFiles kFiles("");
  static const server::Service kService;
  static const server::Backend kBackend{kSettings, kService, kFiles};
  static const server::RouteTable kRoutes = server::main_routes(kBackend);
  static const server::CrossOrigin kCrossOrigin({"https://a.example"});
  static const server::RequestLog kLog(kSettings.log_level);
  static server::Metrics metrics(kRoutes);
  static server::BodyMemory memory(1 << 20, 1, 1);
  static server::UnsentAnswers unsent(1 << 20);
  static server::StopSignal stop;
  std::array<int, 2> ends{};  // keeps packets apart, so that each is read separately
  require(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) == 0, "no socket pair");
  const int buffer_size = 1 << 20;
  ::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &buffer_size, sizeof buffer_size);
  ::setsockopt(ends[1], SOL_SOCKET, SO_SNDBUF, &buffer_size, sizeof buffer_size);
  if (packet == 0) packet = bytes.size();
  for (std::size_t at = 0; at < bytes.size(); at += packet) {
    const auto part = bytes.substr(at, packet);
    require(::send(ends[1], part.data(), part.size(), MSG_DONTWAIT) > 0, "no room for a packet");
  }
  ::shutdown(ends[1], SHUT_WR);

  Conversation conversation;
  std::atomic<bool> draining{false};
  std::atomic<std::size_t> active{0};
  const auto answer = [&](server::Exchange& exchange) {
    conversation.requests.push_back(exchange.head.method + ' ' + exchange.head.path + '\n' + exchange.body);
    return server::Sent{};
  };
  const server::Steps steps(server::Steps::Port::main, kSettings, kRoutes, kCrossOrigin, draining, metrics,
                            kLog);
  serve(server::Connection(ends[0], {kSettings, steps, memory, unsent, draining, active, stop, answer}));
  require(active == 0, "an exchange has no end");

  std::array<char, 1 << 16> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by recv
  ssize_t got = 0;
  while ((got = ::recv(ends[1], buffer.data(), buffer.size(), MSG_DONTWAIT)) > 0) {
    conversation.answers.append(buffer.data(), static_cast<std::size_t>(got));
  }
  ::close(ends[1]);
  return conversation;
}

/// Checks the first answer and returns what follows it. An answer is a status line, fields and, unless the
/// request was HEAD, a problem of the announced length.
std::string_view after_first_answer(std::string_view answers) {
  constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  if (answers.starts_with(kContinue)) return answers.substr(kContinue.size());
  const auto end = answers.find("\r\n\r\n");
  require(answers.starts_with("HTTP/1.1 ") && end != std::string_view::npos, "an answer has no head",
          std::string(answers));
  const auto head = answers.substr(0, end + 4);
  answers.remove_prefix(head.size());
  require(head.find("\r\nX-Request-Id: ") != std::string_view::npos, "an answer has no id",
          std::string(head));
  if (head.starts_with("HTTP/1.1 204 ")) return answers;
  const auto length = head.find("\r\nContent-Length: ");
  require(length != std::string_view::npos, "an answer has no length", std::string(head));
  if (answers.empty() || answers.starts_with("HTTP/1.1 ")) return answers;
  const std::size_t size = std::stoul(std::string(head.substr(length + 18)));
  require(size <= answers.size(), "an answer ends early", std::string(answers));
  require(nlohmann::json::accept(answers.substr(0, size)), "a rejection is not JSON", std::string(answers));
  return answers.substr(size);
}

/// The statuses of the answers. The rest can differ, because ids are random, and 100 Continue is not sent to
/// a client whose body has already arrived.
std::string statuses(std::string_view answers) {
  std::string statuses;
  while (!answers.empty()) {
    if (!answers.starts_with("HTTP/1.1 100 ")) statuses += answers.substr(0, 12);
    answers = after_first_answer(answers);
  }
  return statuses;
}

void run(Input input) {
  if (input.size() < 2) return;
  const std::string_view bytes = text_of(input).substr(1);
  const std::size_t packet = std::max<std::size_t>(1 + input[0], bytes.size() / 100);
  const Conversation whole = converse(bytes, 0);
  const Conversation cut = converse(bytes, packet);
  require(whole.requests == cut.requests, "the requests depend on the packets",
          joined(whole.requests) + "\n--- in packets of " + std::to_string(packet) + " bytes:\n" +
              joined(cut.requests));
  require(statuses(whole.answers) == statuses(cut.answers), "the answers depend on the packets",
          whole.answers + "\n---\n" + cut.answers);
}

const Target target("http", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz

// Any bytes on a connection: head, framing, pipelining and refusals. However the bytes are cut into packets,
// the server reads the same requests from them and sends back proper answers.

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/guard/connection.h"
#include "server/http/guard/stop_signal.h"
#include "server/routes.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/target.h"

namespace fleetplan::fuzz {

namespace {

/// What the service was asked, in order.
using Requests = std::vector<std::string>;

struct Conversation {
  Requests requests;
  std::string answers;  // the refusals, as they were sent
};

server::Settings settings() {
  server::Settings settings;
  settings.limits.max_body = 500;
  settings.log_level = "off";
  return settings;
}

/// Sends the bytes in packets of some size (0: all at once) and then no more, and serves the connection until
/// its end.
Conversation converse(std::string_view bytes, std::size_t packet) {
  static const server::Settings kSettings = settings();
  static const server::StaticFiles kFiles("");
  static const server::Service kService;
  static const server::Backend kBackend{kSettings, kService, kFiles};
  static const server::RouteTable kRoutes = server::main_routes(kBackend);
  static const server::CrossOrigin kCrossOrigin({"https://a.example"});
  static const server::RequestLog kLog(kSettings.log_level);
  static server::Metrics metrics(kRoutes);
  static server::BodyMemory memory(0, 1);
  static server::StopSignal stop;
  std::array<int, 2> ends{};  // packets keep their bounds, so that each is read by itself
  require(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) == 0, "no socket pair");
  const int room = 1 << 20;
  ::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
  ::setsockopt(ends[1], SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
  if (packet == 0) packet = bytes.size();
  for (std::size_t at = 0; at < bytes.size(); at += packet) {
    const auto part = bytes.substr(at, packet);
    require(::send(ends[1], part.data(), part.size(), MSG_DONTWAIT) > 0, "no room for a packet");
  }
  ::shutdown(ends[1], SHUT_WR);

  Conversation held;
  std::atomic<bool> draining{false};
  std::atomic<std::size_t> active{0};
  const auto answer = [&](server::Exchange& exchange) {
    held.requests.push_back(exchange.head.method + ' ' + exchange.head.path + '\n' + exchange.body);
    return server::Sent{};
  };
  const server::Steps steps(server::Steps::Port::main, kSettings, kRoutes, kCrossOrigin, draining, metrics,
                            kLog);
  server::Connection(ends[0], {kSettings, steps, memory, draining, active, stop.fd(), answer}).serve();
  require(active == 0, "an exchange has no end");

  std::array<char, 1 << 16> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by recv
  ssize_t got = 0;
  while ((got = ::recv(ends[1], buffer.data(), buffer.size(), MSG_DONTWAIT)) > 0) {
    held.answers.append(buffer.data(), static_cast<std::size_t>(got));
  }
  ::close(ends[1]);
  return held;
}

/// Takes an answer off the front: a status line, fields, and a problem of the size that they tell, unless the
/// request was for the head only.
void take_answer(std::string_view& answers) {
  constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  if (answers.starts_with(kContinue)) return answers.remove_prefix(kContinue.size());
  const auto end = answers.find("\r\n\r\n");
  require(answers.starts_with("HTTP/1.1 ") && end != std::string_view::npos, "an answer has no head",
          std::string(answers));
  const auto head = answers.substr(0, end + 4);
  answers.remove_prefix(head.size());
  require(head.find("\r\nX-Request-Id: ") != std::string_view::npos, "an answer has no id",
          std::string(head));
  if (head.starts_with("HTTP/1.1 204 ")) return;
  const auto length = head.find("\r\nContent-Length: ");
  require(length != std::string_view::npos, "an answer has no length", std::string(head));
  if (answers.empty() || answers.starts_with("HTTP/1.1 ")) return;
  const std::size_t size = std::stoul(std::string(head.substr(length + 18)));
  require(size <= answers.size(), "an answer ends early", std::string(answers));
  require(nlohmann::json::accept(answers.substr(0, size)), "a refusal is not JSON", std::string(answers));
  answers.remove_prefix(size);
}

/// The statuses, as everything else of an answer may differ: ids are random.
std::string statuses(std::string_view answers) {
  std::string statuses;
  while (!answers.empty()) {
    statuses += answers.substr(0, 12);
    take_answer(answers);
  }
  return statuses;
}

}  // namespace

}  // namespace fleetplan::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetplan::fuzz;
  if (size < 2) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t packet = std::max<std::size_t>(1 + data[0], bytes.size() / 100);
  const Conversation whole = converse(bytes, 0);
  const Conversation cut = converse(bytes, packet);
  require(whole.requests == cut.requests, "packets make a difference to the requests");
  require(statuses(whole.answers) == statuses(cut.answers), "packets make a difference to the answers",
          whole.answers + "\n---\n" + cut.answers);
  return 0;
}

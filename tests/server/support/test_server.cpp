#include "tests/server/support/test_server.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <utility>

namespace fleetplan::server {

namespace {

Settings on_free_port(Settings settings) {
  settings.port = 0;
  settings.log_level = "off";
  return settings;
}

}  // namespace

bool Gate::pass(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  ++waiting_;
  changed_.notify_all();
  return changed_.wait(lock, stop, [&] { return open_; });
}

void Gate::open() {
  const std::lock_guard lock(mutex_);
  open_ = true;
  changed_.notify_all();
}

void Gate::await_waiting(int jobs) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_ >= jobs; });
}

Service StubService::service() {
  const auto endpoint = [this](std::string_view body, const api::RequestContext& context) {
    return answer(body, context);
  };
  const auto list = [] { return api::Reply{200, api::kJson, R"({"examples":["tiny"]})"}; };
  const auto openapi = [] { return api::Reply{200, api::kJson, R"({"openapi":"3.1.0"})"}; };
  return {.plan = endpoint,
          .validate = endpoint,
          .simulate = endpoint,
          .margins = endpoint,
          .advance = endpoint,
          .dependencies = endpoint,
          .retime = endpoint,
          .matrix = endpoint,
          .assign = endpoint,
          .vda5050 = endpoint,
          .import_vda5050 = endpoint,
          .example_list = list,
          .openapi = openapi,
          .examples = {{"tiny", R"({"robots":[]})"}, {"narrow-door", "{}"}}};
}

api::Reply StubService::answer(std::string_view body, const api::RequestContext& context) {
  if (body == "no memory") throw std::bad_alloc();
  if (body == "throw") throw std::runtime_error("a secret detail");
  if (!has_turn(context)) return api::too_busy(context.request_id);
  if (body.starts_with("gate") && !gate.pass(context.stop)) ++stopped;
  if (body == "large") return {200, api::kJson, std::string(200'000, 'x')};
  return {200, api::kJson, R"({"size":)" + std::to_string(body.size()) + "}"};
}

bool has_turn(const api::RequestContext& context) {
  const api::TurnNeed need{
      .stop = core::StopCondition(core::StopCondition::Clock::time_point::max(), context.stop)};
  return context.turn->request(need) && context.turn->await();
}

TestServer::TestServer(Settings settings) : server(on_free_port(std::move(settings)), stub.service()) {
  start();
}

TestServer::TestServer(Settings settings, Service service)
    : server(on_free_port(std::move(settings)), std::move(service)) {
  start();
}

void TestServer::start() {
  if (const auto fault = server.bind()) throw std::runtime_error(*fault);
  thread_ = std::thread([this] { server.run(); });
}

TestServer::~TestServer() { stop(); }

void TestServer::stop() {
  if (!thread_.joinable()) return;
  stub.gate.open();
  server.stop();
  thread_.join();
}

httplib::Client TestServer::client() const {
  httplib::Client client("127.0.0.1", server.port());
  client.set_keep_alive(true);
  client.set_tcp_nodelay(true);
  client.set_read_timeout(60);
  return client;
}

std::vector<std::string> values_of(const httplib::Result& answer, const std::string& field) {
  std::vector<std::string> values;
  const auto [begin, end] = answer->headers.equal_range(field);
  for (auto entry = begin; entry != end; ++entry) values.push_back(entry->second);
  return values;
}

RawConnection::RawConnection(int port) : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot connect");
  }
}

RawConnection::~RawConnection() { reset(); }

void RawConnection::reset() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

void RawConnection::send(const std::string& text) const {
  ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL);
}

void RawConnection::end_of_sending() const { ::shutdown(fd_, SHUT_WR); }

std::string RawConnection::receive() {
  while (true) {
    const auto head_end = input_.find("\r\n\r\n");
    if (head_end != std::string::npos) {
      const auto field = input_.find("Content-Length: ");
      const std::size_t length = field < head_end ? std::stoul(input_.substr(field + 16)) : 0;
      const std::size_t size = head_end + 4 + length;
      if (input_.size() >= size) {
        std::string answer = input_.substr(0, size);
        input_.erase(0, size);
        return answer;
      }
    }
    if (!receive_more()) return {};
  }
}

bool RawConnection::receive_more() {
  std::array<char, 65536> buffer{};
  const ssize_t got = ::recv(fd_, buffer.data(), buffer.size(), 0);
  if (got > 0) input_.append(buffer.data(), static_cast<std::size_t>(got));
  return got > 0;
}

std::string RawConnection::receive_past(const std::string& text) {
  std::size_t searched = 0;
  std::size_t found = 0;
  while ((found = input_.find(text, searched)) == std::string::npos) {
    searched = input_.size() - std::min(input_.size(), text.size());
    if (!receive_more()) return {};
  }
  std::string past = input_.substr(0, found + text.size());
  input_.erase(0, past.size());
  return past;
}

std::string RawConnection::receive_all() {
  while (receive_more()) {
  }
  return std::exchange(input_, {});
}

bool RawConnection::closed_by_server() const {
  std::array<char, 4096> buffer{};
  ssize_t got = 0;
  while ((got = ::recv(fd_, buffer.data(), buffer.size(), 0)) > 0) {
  }
  return got <= 0;
}

}  // namespace fleetplan::server

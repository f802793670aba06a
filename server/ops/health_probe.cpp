
#include "server/ops/health_probe.h"

#include "server/http/http_library.h"

namespace fleetplan::server {

namespace {

/// The time for the probe: shorter than a container engine waits for its check, so that its report contains
/// the fault.
constexpr std::chrono::seconds kPatience{4};

/// Returns the address to probe. A service on all addresses is reachable by the loopback.
std::string probed_address(const std::string& host) {
  if (host == "0.0.0.0") return "127.0.0.1";
  if (host == "::") return "::1";
  return host;
}

}  // namespace

std::optional<std::string> health_fault(const Settings& settings) {
  const int port = settings.admin_port.value_or(settings.port);
  if (port == 0) return "--healthcheck cannot use port 0; name one";
  const std::string host = probed_address(settings.host);
  const std::string where = host + " port " + std::to_string(port);
  httplib::Client client(host, port);
  client.set_connection_timeout(kPatience);
  client.set_read_timeout(kPatience);
  const auto answer = client.Get("/healthz");
  if (!answer) return "no answer from " + where + ": " + httplib::to_string(answer.error());
  if (answer->status != 200) return where + " answered /healthz with " + std::to_string(answer->status);
  return std::nullopt;
}

}  // namespace fleetplan::server

#include <unistd.h>

#include <iostream>

#include "server/command/commands.h"
#include "server/ops/health_probe.h"
#include "server/ops/process.h"
#include "server/ops/settings/settings.h"
#include "server/run.h"
#include "server/service.h"

int main(int argc, char** argv) {
  using namespace fleetplan::server;
  open_standard_descriptors();
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const Streams streams{std::cin, std::cout, std::cerr, isatty(STDERR_FILENO) == 1};
  if (const auto code = run_command(arguments, planning_service, streams)) return *code;
  if (!arguments.empty() && arguments[0] == "serve") arguments.erase(arguments.begin());
  const auto parsed = parse_settings(std::move(arguments));
  if (const auto* exit = std::get_if<SettingsExit>(&parsed)) {
    (exit->code == 0 ? std::cout : std::cerr) << exit->text;
    return exit->code;
  }
  const auto& settings = std::get<Settings>(parsed);
  if (!settings.healthcheck) {
    Service service = planning_service();
    service.example_list();  // so that no client waits for it
    return run(settings, std::move(service));
  }
  const auto fault = health_fault(settings);
  if (fault) std::cerr << "fleetplan: " << *fault << '\n';
  return fault ? 1 : 0;
}

#include <iostream>

#include "server/ops/health_probe.h"
#include "server/ops/settings/settings.h"
#include "server/ops/standard_descriptors.h"
#include "server/run.h"
#include "server/service.h"

int main(int argc, char** argv) {
  using namespace fleetplan::server;
  open_standard_descriptors();
  const auto parsed = parse_settings({argv + 1, argv + argc});
  if (const auto* exit = std::get_if<SettingsExit>(&parsed)) {
    (exit->code == 0 ? std::cout : std::cerr) << exit->text;
    return exit->code;
  }
  const auto& settings = std::get<Settings>(parsed);
  if (!settings.healthcheck) return run(settings, planning_service());
  const auto fault = health_fault(settings);
  if (fault) std::cerr << "fleetplan: " << *fault << '\n';
  return fault ? 1 : 0;
}

#include <iostream>

#include "server/run.h"
#include "server/service.h"
#include "server/settings.h"

int main(int argc, char** argv) {
  using namespace fleetplan::server;
  const auto parsed = parse_settings({argv + 1, argv + argc});
  if (const auto* exit = std::get_if<SettingsExit>(&parsed)) {
    (exit->code == 0 ? std::cout : std::cerr) << exit->text;
    return exit->code;
  }
  return run(std::get<Settings>(parsed), planning_service());
}

#pragma once

#include <string>

namespace fleetplan {

/// Something that is wrong with a problem or with options.
struct Fault {
  std::string place;   // the member, such as "robots[3].goals[0]" or "options.horizon"
  std::string detail;  // a sentence for people, with units
};

}  // namespace fleetplan

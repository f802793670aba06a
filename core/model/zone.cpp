#include "core/model/zone.h"

#include <algorithm>

namespace fleetplan::core {

bool Zone::is_for(std::size_t robot) const {
  return robots.empty() || std::binary_search(robots.begin(), robots.end(), robot);
}

}  // namespace fleetplan::core

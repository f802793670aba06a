#include <fleetplan/fleetplan.h>

namespace fleetplan {

const char* version() { return FLEETPLAN_VERSION; }

}  // namespace fleetplan

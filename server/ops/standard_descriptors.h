#pragma once

namespace fleetplan::server {

/// Opens the null device as each of the descriptors 0 to 2 that is closed. Otherwise a connection could get
/// that number and receive the log. Call it before anything else is opened.
void open_standard_descriptors();

}  // namespace fleetplan::server

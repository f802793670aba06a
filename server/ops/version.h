#pragma once

namespace fleetplan::server {

/// The version of this build, e.g. "0.1.0" (set by the build system).
inline constexpr const char* kVersion = FLEETPLAN_VERSION;

}  // namespace fleetplan::server

#pragma once

namespace fleetplan::support {

/// Whether this is a build with AddressSanitizer, which runs several times slower. Long tests then try a part
/// of their cases; the release build tries all of them.
#ifdef FLEETPLAN_ADDRESS_SANITIZER
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace fleetplan::support

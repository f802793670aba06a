#pragma once

namespace fleetplan::support {

/// Whether this is a build with a sanitizer, which runs several times slower. Long tests then try a part of
/// their cases; the release build tries all of them.
#if defined(FLEETPLAN_ADDRESS_SANITIZER) || defined(FLEETPLAN_THREAD_SANITIZER)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace fleetplan::support

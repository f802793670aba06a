#pragma once

namespace fleetplan::core {

/// The overlap, metres, up to which two disks, or a disk and a wall, are in contact. Contact is allowed.
/// Requests may start and end in contact, the search plans from and to such poses, and the check of a plan
/// accepts them. The tolerance is wide enough for plans that went through decimal text and world coordinates:
/// at 1e9 m, doubles are 1.2e-7 m apart.
inline constexpr double kContactTolerance = 5e-7;

/// The fraction of a disk that keeps clear of a wall at a start, whatever overlap is allowed.
inline constexpr double kSmallestDisk = 1e-3;

/// The search subtracts this from every required distance (metres), so that its own rounding (about 1e-12)
/// has no effect. Far below the contact tolerance, so that poses of plans stay within it.
inline constexpr double kSearchSlack = 5e-10;

/// Positions that differ by less are the same (metres). For example, decimal text of the centre of a cell.
inline constexpr double kSamePosition = 1e-9;

/// No plan takes longer (seconds): three years.
inline constexpr double kLongestPlan = 1e8;

/// No robot travels for longer than it needs for this distance (metres). So rounding of times, half of 1.2e-7
/// m at full speed, stays below the contact tolerance.
inline constexpr double kLongestTravel = 1e9;

/// Directions that differ by less are the same (radians): far above rounding, far below a visible bend.
inline constexpr double kSameHeading = 1e-12;

/// Every translation, rotation or wait in a plan is at least so large (metres, radians, seconds).
inline constexpr double kLeastAction = 1e-9;

/// Services and added waits take at least this long (seconds): longer than kLeastAction, however it is
/// rounded.
inline constexpr double kShortestWait = 2.0 * kLeastAction;

/// Arrivals and departures that differ by less are the same (seconds): rounding of sums of durations.
inline constexpr double kSameTime = 1e-11;

}  // namespace fleetplan::core

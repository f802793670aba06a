#pragma once

namespace fleetplan::core {

/// Two disks, or a disk and a wall, that overlap by no more than this are in contact, and contact is allowed
/// (metres). The API guarantees it; it is wide enough for coordinates that went through decimal text.
inline constexpr double kContactTolerance = 1e-9;

/// What the search subtracts from every required distance (metres): half of the contact tolerance, so that
/// neither its own rounding (about 1e-12) nor that of a start in contact with a neighbour has any effect.
inline constexpr double kSearchSlack = 0.5 * kContactTolerance;

/// Directions that differ by less are the same (radians): far above rounding, far below a visible bend.
inline constexpr double kSameHeading = 1e-12;

/// Arrivals and departures that differ by less are the same (seconds): rounding of sums of durations.
inline constexpr double kSameTime = 1e-11;

}  // namespace fleetplan::core

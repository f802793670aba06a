#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// The letters that cells are drawn with: of the rows of a request, or of MovingAI's maps, whose swamp, S, is
/// free as well.
enum class CellLetters { of_rows, of_movingai };

/// Where the first character is that is not such a letter.
std::optional<std::size_t> first_other_letter(std::string_view row, CellLetters letters);

/// The character of UTF-8 that begins at the offset.
std::string_view character_at(std::string_view text, std::size_t offset);

/// The grid of valid rows of one length, the top one first. Ends early when the stop is met.
core::OccupancyGrid draw(const std::vector<std::string_view>& rows, double resolution, core::Work& stop);

}  // namespace fleetplan::api

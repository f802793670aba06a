#include "api/request/zones/parse_mask.h"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "api/request/map/image/decode_image.h"

namespace fleetplan::api {

namespace {

constexpr std::int8_t kLeastOccupied = 65;  // percent
constexpr std::int8_t kWhole = 100;
/// Metres: so much larger than its cells is a part. More than what decides whether a position is inside, so
/// that the border of two parts is.
constexpr double kOverlap = 2e-6;

/// Cells from the first column to the last one, which is not included.
struct Run {
  int first = 0;
  int last = 0;
  std::int8_t percent = 0;
  bool operator<(const Run& other) const {
    return std::tie(first, last, percent) < std::tie(other.first, other.last, other.percent);
  }
};

/// The runs of one value in a row; those of 0 are left out.
template <class Value>
std::vector<Run> runs_of_row(int columns, const Value& value) {
  std::vector<Run> runs;
  for (int column = 0; column < columns; ++column) {
    const std::int8_t here = value(column);
    if (here == 0) continue;
    if (runs.empty() || runs.back().last != column || runs.back().percent != here) {
      runs.push_back({column, column, here});
    }
    runs.back().last = column + 1;
  }
  return runs;
}

MaskPart part(const Run& run, int first_row, int last_row, double resolution) {
  const core::Position low =
      resolution * core::Position(run.first, first_row) - core::Position(kOverlap, kOverlap);
  const core::Position high =
      resolution * core::Position(run.last, last_row) + core::Position(kOverlap, kOverlap);
  return {run.percent, {low, {high.x(), low.y()}, high, {low.x(), high.y()}}};
}

/// Joins equal runs of rows above each other. Ends soon after there are more than `most` parts.
template <class Value>
std::vector<MaskPart> parts_of(const Raster& raster, double resolution, std::size_t most, core::Work& stop,
                               const Value& value) {
  std::vector<MaskPart> parts;
  std::map<Run, int> open;  // and the rows where they begin
  for (int row = 0; row <= raster.rows && parts.size() <= most; ++row) {
    if (stop.met_after(static_cast<std::size_t>(raster.columns))) break;
    std::map<Run, int> next;
    if (row < raster.rows) {
      for (const Run& run :
           runs_of_row(raster.columns, [&](int column) { return value(raster.at(column, row)); })) {
        const auto begun = open.find(run);
        next.emplace(run, begun == open.end() ? row : begun->second);
        if (begun != open.end()) open.erase(begun);
      }
    }
    for (const auto& [run, first_row] : open) parts.push_back(part(run, first_row, row, resolution));
    open = std::move(next);
  }
  return parts;
}

}  // namespace

std::vector<MaskPart> parse_mask(const JsonReader& member, const core::OccupancyGrid& map, bool by_percent,
                                 Quota& corners) {
  const std::size_t faults = member.fault_count();
  const JsonReader image = member.object(kImageMembers);
  if (!image) return {};
  const std::optional<Raster> raster = decode_image(image, map.cell_count());
  if (!raster) return {};
  if (raster->columns != map.columns() || raster->rows != map.rows()) {
    member.fault(fault::kWrongSize, "The mask has " + std::to_string(raster->columns) + " x " +
                                        std::to_string(raster->rows) + " pixels, but the map has " +
                                        std::to_string(map.columns()) + " x " + std::to_string(map.rows()) +
                                        " cells; a mask has one pixel for each cell of the map.");
  }
  if (member.fault_count() != faults) return {};
  constexpr std::size_t kCorners = 4;
  std::vector<MaskPart> parts = parts_of(*raster, map.resolution(), corners.left() / kCorners, member.stop(),
                                         [&](std::int8_t percent) -> std::int8_t {
                                           if (by_percent) return percent > 0 ? percent : std::int8_t{0};
                                           return percent >= kLeastOccupied ? kWhole : std::int8_t{0};
                                         });
  return corners.take(kCorners * parts.size(), member) ? parts : std::vector<MaskPart>{};
}

}  // namespace fleetplan::api

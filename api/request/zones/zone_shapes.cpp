#include "api/request/zones/zone_shapes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "api/request/map/image/decode_image.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

using Corners = std::vector<core::Position>;

constexpr std::array<std::string_view, 2> kCornerMembers{"x", "y"};
constexpr std::size_t kFewestCorners = 3;
/// The most corners of one polygon: in the worst case, every side is compared with every other one.
constexpr std::size_t kMostCorners = 1000;
/// The work of comparing two sides, in bytes of text.
constexpr std::size_t kWorkOfAComparison = 8;

double turn(const core::Position& a, const core::Position& b, const core::Position& c) {
  return core::cross_product(b - a, c - a);
}

/// Whether a point on the line of a segment lies within its box.
bool lies_between(const core::Position& a, const core::Position& b, const core::Position& point) {
  return point.x() >= std::min(a.x(), b.x()) && point.x() <= std::max(a.x(), b.x()) &&
         point.y() >= std::min(a.y(), b.y()) && point.y() <= std::max(a.y(), b.y());
}

/// Whether two segments have a point in common.
bool meet(const core::Position& a, const core::Position& b, const core::Position& c,
          const core::Position& d) {
  const double abc = turn(a, b, c);
  const double abd = turn(a, b, d);
  const double cda = turn(c, d, a);
  const double cdb = turn(c, d, b);
  const auto differ = [](double p, double q) { return (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0); };
  if (differ(abc, abd) && differ(cda, cdb)) return true;
  return (abc == 0.0 && lies_between(a, b, c)) || (abd == 0.0 && lies_between(a, b, d)) ||
         (cda == 0.0 && lies_between(c, d, a)) || (cdb == 0.0 && lies_between(c, d, b));
}

/// The sides of a polygon; side k leads from corner k to the next one.
class Sides {
 public:
  explicit Sides(const Corners& corners) : corners_(corners) {}

  /// Returns two sides that meet elsewhere than at their common corner, the earlier one first; none if there
  /// are none, or if the reading is stopped.
  std::optional<std::pair<std::size_t, std::size_t>> touching_sides(core::Work& stop) const {
    std::vector<std::size_t> order(corners_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return left(i) < left(j); });
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size() && left(order[j]) <= right(order[i]); ++j) {
        if (stop.met_after(kWorkOfAComparison)) return std::nullopt;
        const auto [first, second] = std::minmax(order[i], order[j]);
        if (are_at_fault(first, second)) return std::pair(first, second);
      }
    }
    return std::nullopt;
  }

 private:
  const core::Position& begin(std::size_t side) const { return corners_[side]; }
  const core::Position& end(std::size_t side) const { return corners_[(side + 1) % corners_.size()]; }
  double left(std::size_t side) const { return std::min(begin(side).x(), end(side).x()); }
  double right(std::size_t side) const { return std::max(begin(side).x(), end(side).x()); }

  bool are_at_fault(std::size_t first, std::size_t second) const {
    if (second == first + 1) return leads_back(first, second);
    if (first == 0 && second + 1 == corners_.size()) return leads_back(second, first);
    return meet(begin(first), end(first), begin(second), end(second));
  }

  /// Whether the side after another one leads back along it.
  bool leads_back(std::size_t side, std::size_t next) const {
    return turn(begin(side), end(side), end(next)) == 0.0 &&
           (end(side) - begin(side)).dot(end(next) - begin(next)) < 0.0;
  }

  const Corners& corners_;
};

/// Reads corners, in the map frame. Returns none if one has a fault.
Corners parse_corners(const JsonReader& list, const WorldFrame& frame) {
  const std::size_t faults = list.fault_count();
  Corners corners;
  corners.reserve(list.size());
  for (const JsonReader item : list.items()) {
    const JsonReader json = item.object(kCornerMembers);
    if (!json) continue;
    const auto x = json.require("x").number(kCoordinate);
    const auto y = json.require("y").number(kCoordinate);
    if (!x || !y) continue;
    const core::Position corner = frame.to_map({*x, *y});
    if (!corners.empty() && corners.back() == corner) {
      item.fault(fault::kBadPolygon, "This corner equals the one before; leave it out.");
    }
    corners.push_back(corner);
  }
  if (corners.size() > 1 && corners.front() == corners.back()) {
    list.item(list.size() - 1)
        .fault(fault::kBadPolygon,
               "The last corner equals the first one; leave it out, the polygon is closed.");
  }
  return list.fault_count() == faults ? corners : Corners{};
}

}  // namespace

std::vector<core::Position> parse_polygon(const JsonReader& member, const WorldFrame& frame, Quota& corners) {
  const JsonReader list = member.array();
  if (!list || !corners.take(list)) return {};
  if (list.size() < kFewestCorners) {
    list.fault(fault::kBadPolygon,
               "polygon must have at least 3 corners, not " + std::to_string(list.size()) + '.');
    return {};
  }
  if (list.size() > kMostCorners) {
    list.fault(fault::kOutOfRange, "polygon has " + std::to_string(list.size()) + " corners; it may have " +
                                       std::to_string(kMostCorners) + ". Divide it into several zones.");
    return {};
  }
  Corners read = parse_corners(list, frame);
  if (read.empty()) return {};
  if (const auto met = Sides(read).touching_sides(list.stop())) {
    const std::string first = std::to_string(met->first);
    const std::string second = std::to_string(met->second);
    list.fault(fault::kBadPolygon,
               "The sides that begin at the corners " + first + " and " + second +
                   " (from 0) cross or touch each other; list the corners in order along the border, and "
                   "divide an area that touches itself into several zones.");
    return {};
  }
  return read;
}

namespace {

constexpr std::int8_t kLeastOccupied = 65;  // percent
constexpr std::int8_t kWhole = 100;
/// How much larger than its cells a part of a mask is, metres. It is more than what decides whether a
/// position is inside, so that the border of two parts is inside.
constexpr double kOverlap = 2e-6;

/// A run of cells from the first column to the last one, which is not included.
struct Run {
  int first = 0;
  int last = 0;
  std::int8_t percent = 0;
  bool operator<(const Run& other) const {
    return std::tie(first, last, percent) < std::tie(other.first, other.last, other.percent);
  }
};

/// Returns the runs of one value in a row; runs of 0 are left out.
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
  std::map<Run, int> open;  // open runs, with the rows where they begin
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

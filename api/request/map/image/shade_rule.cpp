#include "api/request/map/image/shade_rule.h"

#include <cmath>
#include <cstddef>

namespace fleetplan::api {

namespace {

std::int8_t by_thresholds(const ShadeRule& rule, double occupied) {
  if (occupied > rule.occupied_thresh) return kFullOccupancy;
  if (occupied < rule.free_thresh) return 0;
  if (rule.mode == ShadeMode::trinary) return kUnknownOccupancy;
  const double range = rule.occupied_thresh - rule.free_thresh;
  if (range <= 0.0) return kUnknownOccupancy;  // a single shade is neither; map_server divides by 0
  return static_cast<std::int8_t>(std::rint((occupied - rule.free_thresh) / range * 100.0));
}

}  // namespace

OccupancyOfPixels::OccupancyOfPixels(const ShadeRule& rule, const ImageHeader& image)
    : rule_(rule), largest_(image.largest), has_alpha_(image.has_alpha()) {
  const std::int64_t pixels = std::int64_t{image.columns} * image.rows;
  if (image.channels != 1 || pixels <= image.largest) return;
  std::vector<std::int8_t> known;
  known.reserve(static_cast<std::size_t>(image.largest) + 1);
  for (int gray = 0; gray <= image.largest; ++gray) {
    const std::uint16_t channel[] = {static_cast<std::uint16_t>(gray)};
    known.push_back(computed(channel));
  }
  known_ = std::move(known);
}

std::int8_t OccupancyOfPixels::computed(std::span<const std::uint16_t> channels) const {
  const std::size_t colours = channels.size() - (has_alpha_ ? 1 : 0);
  double sum = 0.0;  // of red, green and blue
  for (std::size_t index = 0; index < colours; ++index) sum += channels[index];
  if (colours == 1) sum *= 3.0;
  double mean = sum / 3.0;
  if (has_alpha_) {
    if (rule_.mode == ShadeMode::scale && channels.back() < largest_) return kUnknownOccupancy;
    if (rule_.mode == ShadeMode::trinary) mean = (sum + channels.back()) / 4.0;  // alpha counts as a colour
  }
  const double shade = mean / largest_;
  if (rule_.mode != ShadeMode::raw) return by_thresholds(rule_, rule_.negate ? shade : 1.0 - shade);
  const double percent = std::round(shade * 255.0);
  return percent <= kFullOccupancy ? static_cast<std::int8_t>(percent) : kUnknownOccupancy;
}

}  // namespace fleetplan::api

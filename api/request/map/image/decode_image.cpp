#include "api/request/map/image/decode_image.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "api/json/faults.h"
#include "api/request/map/image/base64.h"
#include "api/request/map/image/image_reader.h"
#include "api/request/map/image/shade_rule.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 3> kModes{"trinary", "scale", "raw"};
constexpr Range kShare{0.0, 1.0, "of full occupancy"};

/// map_server accepts numbers and booleans.
std::optional<bool> parse_negate(const JsonReader& member) {
  const auto number = member.natural();
  return number && *number <= 1 ? std::optional(*number == 1) : member.boolean();
}

std::optional<ShadeRule> parse_rule(const JsonReader& image) {
  const std::size_t before = image.fault_count();
  ShadeRule rule;
  if (const auto mode = image.find("mode").word(kModes)) rule.mode = static_cast<ShadeMode>(*mode);
  rule.negate = parse_negate(image.find("negate")).value_or(false);
  const JsonReader occupied = image.find("occupied_thresh");
  const JsonReader free = image.find("free_thresh");
  rule.occupied_thresh = occupied.number(kShare).value_or(rule.occupied_thresh);
  rule.free_thresh = free.number(kShare).value_or(rule.free_thresh);
  if (image.fault_count() != before) return std::nullopt;
  if (rule.free_thresh <= rule.occupied_thresh) return rule;
  const std::string wanted = free ? "at most occupied_thresh" : "at least free_thresh";
  const double other = free ? rule.occupied_thresh : rule.free_thresh;
  const std::string given = (free && occupied) || (!free && !occupied) ? "" : ", by default";
  (free ? free : occupied).must_be(fault::kOutOfRange, wanted + " (" + number_text(other) + given + ")");
  return std::nullopt;
}

/// The base64 text of the one member that is there.
JsonReader parse_file(const JsonReader& image) {
  const JsonReader pgm = image.find("pgm");
  const JsonReader png = image.find("png");
  if (pgm && png) {
    png.fault(fault::kDuplicate, "The image is given as pgm and as png; give one of them.");
    return {};
  }
  const JsonReader file = png ? png : image.require("pgm", "; give the file in base64, as pgm or png");
  if (!file || file.string()) return file;
  file.must_be(fault::kWrongType, "a string, the file in base64");
  return {};
}

/// Decodes rows from the top until the stop is met.
Result<Raster, std::string> decode(ImageReader& reader, const ShadeRule& rule, core::Work& stop) {
  const ImageHeader& header = reader.header();
  const OccupancyOfPixels occupancy(rule, header);
  const auto columns = static_cast<std::size_t>(header.columns);
  const auto channels = static_cast<std::size_t>(header.channels);
  Raster raster{header.columns, header.rows,
                std::vector<std::int8_t>(columns * static_cast<std::size_t>(header.rows))};
  std::int8_t* line = raster.occupancy.data() + raster.occupancy.size();
  for (int row = 0; row < header.rows && !stop.met_after(columns * channels); ++row) {
    const auto pixels = reader.next_row();
    if (!pixels) return pixels.failure();
    line -= columns;
    for (std::size_t column = 0; column < columns; ++column) {
      line[column] = occupancy.of(pixels->subspan(column * channels, channels));
    }
  }
  return raster;
}

}  // namespace

std::optional<Raster> decode_image(const JsonReader& image, std::int64_t most) {
  const auto rule = parse_rule(image);
  const JsonReader file = parse_file(image);
  if (!rule || !file) return std::nullopt;
  core::Work& stop = file.stop();
  const bool is_png = file.value().key() == "png";
  const auto damaged = [&](const std::string& detail) {
    if (!stop.met()) file.fault(fault::kBadImage, "The image cannot be read. " + detail);
    return std::nullopt;
  };
  const auto bytes = decode_base64(*file.string(), stop);
  if (!bytes) return damaged("It " + bytes.failure() + ".");
  if (stop.met()) return std::nullopt;
  auto opened = is_png ? open_png(*bytes, most, stop) : open_pgm(*bytes, most);
  if (!opened) {
    if (!opened.failure().too_large) return damaged(opened.failure().detail);
    file.fault(fault::kOutOfRange, "The image is too large. " + opened.failure().detail);
    return std::nullopt;
  }
  auto raster = decode(**opened, *rule, stop);
  if (!raster) return damaged(raster.failure());
  if (stop.met()) return std::nullopt;
  return std::move(*raster);
}

}  // namespace fleetplan::api

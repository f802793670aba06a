#include "api/request/map/image/decode_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "api/json/errors.h"

namespace fleetplan::api {

namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kInvalid = 0x80;  // more than 6 bits

constexpr std::array<std::uint8_t, 256> make_values() {
  std::array<std::uint8_t, 256> values{};
  for (auto& value : values) value = kInvalid;
  for (std::size_t index = 0; index < kAlphabet.size(); ++index) {
    values[static_cast<unsigned char>(kAlphabet[index])] = static_cast<std::uint8_t>(index);
  }
  return values;
}
constexpr std::array<std::uint8_t, 256> kValues = make_values();

std::uint32_t value_of(char letter) { return kValues[static_cast<unsigned char>(letter)]; }

std::string letter_fault(std::string_view text, std::size_t from) {
  const auto bad = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(from), text.end(),
                                [](char letter) { return value_of(letter) == kInvalid; });
  const std::size_t at = static_cast<std::size_t>(bad - text.begin());
  const std::string place = " at character " + std::to_string(at + 1);
  if (*bad == '\n' || *bad == '\r' || *bad == ' ') {
    return "has white space" + place + "; write base64 on one line, as base64 -w 0 does";
  }
  if (*bad == '=') return "has padding" + place + ", before its end";
  if (*bad == '-' || *bad == '_') return "is base64url" + place + "; write + for - and / for _";
  const bool is_visible = *bad > ' ' && *bad < 0x7f;
  return "has " + (is_visible ? in_quotes({&*bad, 1}) : "a character") + place + ", which is not of base64";
}

}  // namespace

Result<Bytes, std::string> decode_base64(std::string_view text, core::Work& work) {
  if (text.starts_with("data:")) {
    constexpr std::size_t kLongestPrefix = 64;
    const std::string_view prefix = text.substr(0, text.substr(0, kLongestPrefix).find(',') + 1);
    return "is a data URL; leave out its prefix" + (prefix.empty() ? "" : ' ' + in_quotes(prefix)) +
           " and give the base64 alone";
  }
  if (text.size() % 4 != 0) {
    return "has " + std::to_string(text.size()) +
           " characters of base64, not a multiple of 4; is it cut off?";
  }
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  const std::size_t letters = text.size() - padding;
  const std::size_t whole = letters / 4 * 4;
  Bytes bytes(letters / 4 * 3 + (padding == 0 ? 0 : 3 - padding));
  std::uint8_t* target = bytes.data();
  for (std::size_t begin = 0; begin < whole; begin += core::Work::kStride) {
    const std::size_t end = std::min(whole, begin + core::Work::kStride);
    std::uint32_t seen = 0;
    for (std::size_t at = begin; at < end; at += 4) {
      const std::uint32_t a = value_of(text[at]);
      const std::uint32_t b = value_of(text[at + 1]);
      const std::uint32_t c = value_of(text[at + 2]);
      const std::uint32_t d = value_of(text[at + 3]);
      seen |= a | b | c | d;
      *target++ = static_cast<std::uint8_t>(a << 2U | b >> 4U);
      *target++ = static_cast<std::uint8_t>(b << 4U | c >> 2U);
      *target++ = static_cast<std::uint8_t>(c << 6U | d);
    }
    if ((seen & kInvalid) != 0) return letter_fault(text.substr(0, letters), begin);
    if (work.met_after(end - begin)) return bytes;
  }
  if (padding == 0) return bytes;
  const std::uint32_t a = value_of(text[whole]);
  const std::uint32_t b = value_of(text[whole + 1]);
  const std::uint32_t c = padding == 1 ? value_of(text[whole + 2]) : 0;
  if (((a | b | c) & kInvalid) != 0) return letter_fault(text.substr(0, letters), whole);
  *target++ = static_cast<std::uint8_t>(a << 2U | b >> 4U);
  if (padding == 1) *target = static_cast<std::uint8_t>(b << 4U | c >> 2U);
  const std::uint32_t left = padding == 1 ? c & 3U : b & 15U;
  if (left != 0) return std::string("has bits after its last byte; is it cut off?");
  return bytes;
}

namespace {

std::int8_t by_thresholds_of_humble(const ShadeRule& rule, double occupied) {
  if (occupied > rule.occupied_thresh) return kFullOccupancy;
  if (occupied < rule.free_thresh) return 0;
  if (rule.mode == ShadeMode::trinary) return kUnknownOccupancy;
  const double range = rule.occupied_thresh - rule.free_thresh;
  if (range <= 0.0) return kUnknownOccupancy;  // a single shade is neither; map_server divides by 0
  return static_cast<std::int8_t>(std::rint((occupied - rule.free_thresh) / range * 100.0));
}

/// The same with Jazzy, in single precision, as map_server computes.
std::int8_t by_thresholds(const ShadeRule& rule, float occupied) {
  const auto least_occupied = static_cast<float>(rule.occupied_thresh);
  const auto max_free = static_cast<float>(rule.free_thresh);
  if (occupied <= max_free) return 0;
  if (occupied >= least_occupied) return kFullOccupancy;
  if (rule.mode == ShadeMode::trinary) return kUnknownOccupancy;
  const auto range = static_cast<float>(rule.occupied_thresh - rule.free_thresh);
  const float percent = std::round((occupied - max_free) / range * 100.0F);
  return static_cast<std::int8_t>(std::min(percent, static_cast<float>(kFullOccupancy)));
}

/// Returns the gray of a pixel, 0 to 255, as GraphicsMagick has it with 16 bits for each channel: the luma of
/// Rec. 601 in 16 bits, rounded, of which the upper 8 bits are taken.
int gray_of(std::span<const std::uint16_t> channels, int largest) {
  constexpr std::uint64_t kLargest16 = 65535;
  constexpr std::uint64_t kStep = 257;  // of 8 bits in 16
  const auto wide = [&](std::uint16_t channel) {
    const auto most = static_cast<std::uint64_t>(largest);
    return (2 * kLargest16 * channel + most) / (2 * most);
  };
  if (channels.size() < 3) return static_cast<int>(wide(channels[0]) / kStep);
  const std::uint64_t luma =
      (299 * wide(channels[0]) + 587 * wide(channels[1]) + 114 * wide(channels[2]) + 500) / 1000;
  return static_cast<int>(luma / kStep);
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
  if (rule_.release == Release::humble) return computed_as_humble(channels);
  if (has_alpha_ && channels.back() < largest_) return kUnknownOccupancy;
  const int gray = gray_of(channels, static_cast<int>(largest_));
  if (rule_.mode == ShadeMode::raw) {
    return gray <= kFullOccupancy ? static_cast<std::int8_t>(gray) : kUnknownOccupancy;
  }
  const float shade = static_cast<float>(gray) / 255.0F;
  return by_thresholds(rule_, rule_.negate ? shade : 1.0F - shade);
}

std::int8_t OccupancyOfPixels::computed_as_humble(std::span<const std::uint16_t> channels) const {
  const std::size_t colours = channels.size() - (has_alpha_ ? 1 : 0);
  double sum = 0.0;  // sum of red, green and blue
  for (std::size_t index = 0; index < colours; ++index) sum += channels[index];
  if (colours == 1) sum *= 3.0;
  double mean = sum / 3.0;
  if (has_alpha_) {
    if (rule_.mode == ShadeMode::scale && channels.back() < largest_) return kUnknownOccupancy;
    if (rule_.mode == ShadeMode::trinary) mean = (sum + channels.back()) / 4.0;  // alpha counts as a colour
  }
  const double shade = mean / largest_;
  if (rule_.mode != ShadeMode::raw) return by_thresholds_of_humble(rule_, rule_.negate ? shade : 1.0 - shade);
  const double percent = std::round(shade * 255.0);
  return percent <= kFullOccupancy ? static_cast<std::int8_t>(percent) : kUnknownOccupancy;
}

namespace {

constexpr std::array<std::string_view, 3> kModes{"trinary", "scale", "raw"};
constexpr std::array<std::string_view, 2> kReleases{"jazzy", "humble"};  // see Release
constexpr Range kShare{0.0, 1.0, "of full occupancy"};

/// Reads `negate`. map_server accepts numbers and booleans.
std::optional<bool> parse_negate(const JsonReader& member) {
  const auto number = member.natural();
  return number && *number <= 1 ? std::optional(*number == 1) : member.boolean();
}

std::optional<ShadeRule> parse_rule(const JsonReader& image) {
  const std::size_t before = image.fault_count();
  ShadeRule rule;
  if (const auto mode = image.find("mode").word(kModes)) rule.mode = static_cast<ShadeMode>(*mode);
  if (const auto release = image.find("release").word(kReleases)) {
    rule.release = static_cast<Release>(*release);
  }
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

/// Returns the base64 text of the one member that is there.
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

/// Counts the pixels whose meaning a reader of the image should hear of.
class Notable {
 public:
  Notable(const ShadeRule& rule, const ImageHeader& header, const Meanings* meanings)
      : meanings_(meanings), looks_for_gray_(rule.mode == ShadeMode::trinary && !rule.negate) {
    ShadeRule humble = rule;
    humble.release = Release::humble;
    if (meanings != nullptr) before_.emplace(humble, header);
    // An alpha channel makes it free with Humble, whatever the thresholds.
    constexpr std::uint16_t kGray[] = {kUnknownGray};
    const bool is_free = OccupancyOfPixels(rule, {1, 1, 1, 255}).of(kGray) == 0;
    looks_for_gray_ = looks_for_gray_ && is_free && header.largest % 255 == 0;
    unknown_gray_ = static_cast<std::uint16_t>(kUnknownGray * (header.largest / 255));
  }

  void look_at(std::span<const std::uint16_t> channels, std::int8_t percent) {
    if (before_ && meaning(percent) != meaning(before_->of(channels))) ++changed_;
    if (looks_for_gray_ && percent == 0 && channels[0] == unknown_gray_) {
      if (channels.size() < 3 || (channels[1] == channels[0] && channels[2] == channels[0])) ++free_unknown_;
    }
  }

  std::size_t changed() const { return changed_; }
  std::size_t free_unknown() const { return free_unknown_; }

 private:
  std::int8_t meaning(std::int8_t percent) const {
    return (*meanings_)[static_cast<std::size_t>(percent - kUnknownOccupancy)];
  }

  const Meanings* meanings_;
  std::optional<OccupancyOfPixels> before_;
  bool looks_for_gray_;
  std::uint16_t unknown_gray_ = 0;
  std::size_t changed_ = 0;
  std::size_t free_unknown_ = 0;
};

/// Decodes rows from the top until `work` is met. `meanings` of the pixels are compared with their meanings
/// with Humble. Null: they are not compared.
Result<DecodedImage, std::string> decode(ImageReader& reader, const ShadeRule& rule, const Meanings* meanings,
                                         core::Work& work) {
  const ImageHeader& header = reader.header();
  const OccupancyOfPixels occupancy(rule, header);
  Notable notable(rule, header, meanings);
  const auto columns = static_cast<std::size_t>(header.columns);
  const auto channels = static_cast<std::size_t>(header.channels);
  Raster raster{header.columns, header.rows,
                std::vector<std::int8_t>(columns * static_cast<std::size_t>(header.rows))};
  std::int8_t* line = raster.occupancy.data() + raster.occupancy.size();
  for (int row = 0; row < header.rows && !work.met_after(columns * channels); ++row) {
    const auto pixels = reader.next_row();
    if (!pixels) return pixels.failure();
    line -= columns;
    for (std::size_t column = 0; column < columns; ++column) {
      const auto pixel = pixels->subspan(column * channels, channels);
      line[column] = occupancy.of(pixel);
      notable.look_at(pixel, line[column]);
    }
  }
  return DecodedImage{std::move(raster), rule, notable.changed(), notable.free_unknown()};
}

}  // namespace

std::string changed_pixels_warning(const std::string& image, std::size_t pixels) {
  return "Of " + image + ", " + std::to_string(pixels) + (pixels == 1 ? " pixel means" : " pixels mean") +
         " something else than with map_server of ROS 2 Humble, as it was read before: colours count by "
         "their "
         "luminance, thresholds themselves are occupied or free, and pixels that are not opaque are unknown, "
         "as in Jazzy. Give \"release\": \"humble\" for the old reading, or \"jazzy\" to confirm the new "
         "one.";
}

std::optional<DecodedImage> decode_image(const JsonReader& image, std::int64_t max_pixels,
                                         const Meanings& meanings) {
  const auto rule = parse_rule(image);
  const JsonReader file = parse_file(image);
  if (!rule || !file) return std::nullopt;
  core::Work& work = file.work();
  const bool is_png = file.value().key() == "png";
  const auto damaged = [&](const std::string& detail) {
    if (!work.met()) file.fault(fault::kBadImage, "The image cannot be read. " + detail);
    return std::nullopt;
  };
  const auto bytes = decode_base64(*file.string(), work);
  if (!bytes) return damaged("It " + bytes.failure() + ".");
  if (work.met()) return std::nullopt;
  auto opened = is_png ? open_png(*bytes, max_pixels, work) : open_pgm(*bytes, max_pixels);
  if (!opened) {
    if (!opened.failure().too_large) return damaged(opened.failure().detail);
    file.fault(fault::kOutOfRange, "The image is too large. " + opened.failure().detail);
    return std::nullopt;
  }
  auto decoded = decode(**opened, *rule, image.find("release") ? nullptr : &meanings, work);
  if (!decoded) return damaged(decoded.failure());
  if (work.met()) return std::nullopt;
  return std::move(*decoded);
}

}  // namespace fleetplan::api

#pragma once

// Images of maps, from the text of the request to the raster. Pixels are read row by row. They become
// occupancy in the same way as in map_server of ROS 2 (nav2_map_server/src/map_io.cpp).

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// The first lines of an image.
struct ImageHeader {
  int columns = 0;
  int rows = 0;
  int channels = 1;  // channels of a pixel: gray; gray and alpha; red, green and blue; these and alpha
  int largest = 0;   // value of a channel, 1 to 65535; alpha: opaque

  bool has_alpha() const { return channels == 2 || channels == 4; }
};

/// Reads the pixels of an image row by row, from the top. The bytes must outlive it.
class ImageReader {
 public:
  using Row =
      std::span<const std::uint16_t>;  // the channels of the pixels from the left; valid until the next one

  virtual ~ImageReader() = default;
  const ImageHeader& header() const { return header_; }
  /// Returns the next row, or why it cannot be read, as a sentence. A next row must exist.
  virtual Result<Row, std::string> next_row() = 0;

 protected:
  explicit ImageReader(const ImageHeader& header) : header_(header) {}

 private:
  ImageHeader header_;
};

/// A fault of the header of an image, in a sentence.
struct ImageFault {
  std::string detail;
  bool too_large = false;  // more pixels than wanted, or too many in a row or column; otherwise damaged
};

using OpenedImage = Result<std::unique_ptr<ImageReader>, ImageFault>;

inline constexpr int kLongestSide = 1'000'000;  // pixels, as in libpng

/// Returns the fault of an image of this size, if it has more than `max_pixels` or is too long.
std::optional<ImageFault> size_fault(std::uint64_t columns, std::uint64_t rows, std::int64_t max_pixels);

/// Opens a portable graymap, plain (P2) or raw (P5), of at most `max_pixels`.
OpenedImage open_pgm(std::span<const std::uint8_t> bytes, std::int64_t max_pixels);

/// Opens a PNG of at most `max_pixels`. Palettes, grays of fewer than 8 bits and transparent colours are
/// expanded. Everything that is not needed for the pixels, or follows them, stays unread. When `work` is met,
/// reading ends with any result.
OpenedImage open_png(std::span<const std::uint8_t> bytes, std::int64_t max_pixels, core::Work& work);

inline constexpr std::int8_t kUnknownOccupancy = -1;

/// Occupancy of cells as in nav_msgs/OccupancyGrid: 0 to 100 percent, or -1 where it is unknown.
struct Raster {
  int columns = 0;
  int rows = 0;
  std::vector<std::int8_t> occupancy;  // row by row from the bottom, each from the left

  std::int8_t at(int column, int row) const {
    return occupancy[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
  }
};

using Bytes = std::vector<std::uint8_t>;

/// Decodes a base64 text of RFC 4648, section 4: padded, without line breaks. The failure says what is wrong,
/// after "it ". When `work` is met, returns what was decoded so far.
Result<Bytes, std::string> decode_base64(std::string_view text, core::Work& work);

inline constexpr std::int8_t kFullOccupancy = 100;  // percent

enum class ShadeMode { trinary, scale, raw };

/// The release of ROS 2 whose map_server reads an image. `jazzy`: Jazzy (from 1.3.7), Kilted and Lyrical.
/// `humble`: Humble and older releases.
enum class Release { jazzy, humble };

/// The members of a map.yaml that define what a shade means.
struct ShadeRule {
  ShadeMode mode = ShadeMode::trinary;
  bool negate = false;            // white is occupied
  double occupied_thresh = 0.65;  // occupied from here on, with Humble above; 0 to 1
  double free_thresh = 0.196;     // free up to here, with Humble below; at most occupied_thresh
  Release release = Release::jazzy;
};

/// The gray with which map_saver writes unknown cells, of 255.
inline constexpr int kUnknownGray = 205;

/// The occupancy of pixels of one image: 0 to 100 percent, or kUnknownOccupancy.
class OccupancyOfPixels {
 public:
  OccupancyOfPixels(const ShadeRule& rule, const ImageHeader& image);

  /// Returns the occupancy of a pixel with these channels.
  std::int8_t of(std::span<const std::uint16_t> channels) const {
    return known_.empty() ? computed(channels) : known_[channels[0]];
  }

 private:
  std::int8_t computed(std::span<const std::uint16_t> channels) const;
  std::int8_t computed_as_humble(std::span<const std::uint16_t> channels) const;

  ShadeRule rule_;
  double largest_;
  bool has_alpha_;
  std::vector<std::int8_t> known_;  // occupancy of each gray, if keeping it saves time
};

/// What the percentages from kUnknownOccupancy to kFullOccupancy mean to the reader of an image, by
/// percentage - kUnknownOccupancy.
using Meanings = std::array<std::int8_t, kFullOccupancy - kUnknownOccupancy + 1>;

struct DecodedImage {
  Raster raster;
  ShadeRule rule;
  /// The number of pixels that mean something else with Humble. Only counted if the image names no release.
  std::size_t changed = 0;
  std::size_t free_unknown = 0;  // pixels of kUnknownGray that are free in the mode trinary
};

/// Returns the occupancy that map_server of ROS publishes for an image. The members are `pgm` or `png`, in
/// base64, the members of its map.yaml that give shades a meaning (see ShadeRule), and `release`. Other
/// members are ignored.
///
/// The image may have at most `max_pixels`, which is checked before they are decoded. Returns none if it has
/// a fault, or if the reading of the document is stopped.
std::optional<DecodedImage> decode_image(const JsonReader& image, std::int64_t max_pixels,
                                         const Meanings& meanings);

/// Returns a warning about pixels that mean something else with Humble. `image` names it.
std::string changed_pixels_warning(const std::string& image, std::size_t pixels);

}  // namespace fleetplan::api

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "api/json/result.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// The first lines of an image.
struct ImageHeader {
  int columns = 0;
  int rows = 0;
  int channels = 1;  // channels of a pixel: gray; gray and alpha; red, green and blue; these and alpha
  int largest = 0;   // value of a channel, 1 to 65535; alpha: opaque

  bool has_alpha() const { return channels == 2 || channels == 4; }
};

/// Reads the pixels of an image row by row, from the top. The bytes have to outlive it.
class ImageReader {
 public:
  using Row =
      std::span<const std::uint16_t>;  // the channels of the pixels from the left; valid until the next one

  virtual ~ImageReader() = default;
  const ImageHeader& header() const { return header_; }
  /// Returns the next row, of which there must be one, or why it cannot be read, in a sentence.
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

/// Returns the fault of an image of this size, if it has more than `most` pixels or is too long.
std::optional<ImageFault> size_fault(std::uint64_t columns, std::uint64_t rows, std::int64_t most);

/// Opens a portable graymap, plain (P2) or raw (P5), of at most `most` pixels.
OpenedImage open_pgm(std::span<const std::uint8_t> bytes, std::int64_t most);

/// Opens a PNG of at most `most` pixels. Palettes, grays of fewer than 8 bits and transparent colours are
/// expanded. Whatever is not needed for the pixels, or follows them, stays unread. `stop` ends the reading,
/// with any result.
OpenedImage open_png(std::span<const std::uint8_t> bytes, std::int64_t most, core::Work& stop);

}  // namespace fleetplan::api

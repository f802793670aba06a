#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/request/map/image/decode_image.h"

namespace fleetplan::api {

std::optional<ImageFault> size_fault(std::uint64_t columns, std::uint64_t rows, std::int64_t max_pixels) {
  const std::string size = std::to_string(columns) + " x " + std::to_string(rows);
  if (columns > kLongestSide || rows > kLongestSide) {
    return ImageFault{"Its " + size + " pixels are too many; it must be at most " +
                          std::to_string(kLongestSide) + " pixels wide and high.",
                      true};
  }
  if (columns * rows <= static_cast<std::uint64_t>(max_pixels)) return std::nullopt;
  return ImageFault{"It has " + size + " = " + std::to_string(columns * rows) +
                        " pixels; this service accepts at most " + std::to_string(max_pixels) +
                        ". Use a coarser resolution or a part of the map.",
                    true};
}

namespace {

constexpr int kLargestGray = 65535;

bool is_space(std::uint8_t byte) { return byte == ' ' || (byte >= '\t' && byte <= '\r'); }

/// Reads numbers in ASCII with white space and comments between them.
class NumberReader {
 public:
  explicit NumberReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  /// Returns the next whole number. If it is large, returns any number of at least 2^32. Returns none if
  /// there is no number.
  std::optional<std::uint64_t> next() {
    skip();
    const std::size_t first = at_;
    std::uint64_t value = 0;
    for (; at_ < bytes_.size() && bytes_[at_] >= '0' && bytes_[at_] <= '9'; ++at_) {
      if (value < (std::uint64_t{1} << 32U)) value = value * 10 + (bytes_[at_] - '0');
    }
    if (at_ == first) return std::nullopt;
    return value;
  }

 private:
  void skip() {
    // Bounded: each byte is passed once.
    for (; at_ < bytes_.size(); ++at_) {
      if (bytes_[at_] == '#') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
        if (at_ == bytes_.size()) return;
      } else if (!is_space(bytes_[at_])) {
        return;
      }
    }
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 2;  // after the magic number
};

std::string pixel_fault(std::size_t row, std::size_t column, std::uint64_t gray, int largest) {
  return "Pixel " + std::to_string(column) + " of row " + std::to_string(row) + " (from 0) is " +
         std::to_string(gray) + ", above the largest gray " + std::to_string(largest) +
         " that the header names.";
}

/// The pixels of a graymap with its header read.
class PgmReader : public ImageReader {
 protected:
  explicit PgmReader(const ImageHeader& header)
      : ImageReader(header), grays_(static_cast<std::size_t>(header.columns)) {}

  /// Returns the row, if all of its grays are in range.
  Result<Row, std::string> checked() {
    const int largest = header().largest;
    const auto bright =
        std::find_if(grays_.begin(), grays_.end(), [&](std::uint16_t gray) { return gray > largest; });
    if (bright != grays_.end()) {
      return pixel_fault(row_, static_cast<std::size_t>(bright - grays_.begin()), *bright, largest);
    }
    ++row_;
    return Row(grays_);
  }

  std::vector<std::uint16_t> grays_;  // grays of the row
  std::size_t row_ = 0;
};

class PlainReader final : public PgmReader {
 public:
  PlainReader(const ImageHeader& header, const NumberReader& numbers)
      : PgmReader(header), numbers_(numbers) {}

  Result<Row, std::string> next_row() override {
    for (std::size_t column = 0; column < grays_.size(); ++column) {
      const auto gray = numbers_.next();
      if (!gray) {
        const std::size_t read = row_ * grays_.size() + column;
        return std::to_string(read) + " of its " +
               std::to_string(std::int64_t{header().columns} * header().rows) +
               " pixels are followed by something else: it is truncated or damaged.";
      }
      if (*gray > kLargestGray) return pixel_fault(row_, column, *gray, header().largest);
      grays_[column] = static_cast<std::uint16_t>(*gray);
    }
    return checked();
  }

 private:
  NumberReader numbers_;
};

class RawReader final : public PgmReader {
 public:
  RawReader(const ImageHeader& header, std::span<const std::uint8_t> pixels)
      : PgmReader(header), pixels_(pixels) {}

  Result<Row, std::string> next_row() override {
    const std::uint8_t* byte = pixels_.data() + at_;
    if (header().largest <= 255) {
      std::copy_n(byte, grays_.size(), grays_.begin());
      at_ += grays_.size();
    } else {  // the high byte comes first
      for (std::uint16_t& gray : grays_) {
        gray = static_cast<std::uint16_t>(byte[0] << 8 | byte[1]);
        byte += 2;
      }
      at_ += 2 * grays_.size();
    }
    return checked();
  }

 private:
  std::span<const std::uint8_t> pixels_;
  std::size_t at_ = 0;
};

std::string kind_fault(std::span<const std::uint8_t> bytes) {
  const bool is_netpbm = bytes.size() >= 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '7';
  if (!is_netpbm) return "It does not begin as a PGM image (P2 or P5).";
  return std::string("It is a netpbm image of the kind P") + static_cast<char>(bytes[1]) +
         ", not a graymap: convert it to PGM (P5).";
}

std::string header_fault(const char* what, int max) {
  return std::string("Its header has no ") + what + " from 1 to " + std::to_string(max) +
         "; is it truncated or damaged?";
}

/// Returns where raw pixels begin: after one byte of white space. After two if lines end with carriage return
/// and line feed, as some editors write them.
std::size_t raw_begin(std::span<const std::uint8_t> bytes, std::size_t header_end, std::uint64_t size) {
  const bool two =
      bytes.size() == header_end + 2 + size && bytes[header_end] == '\r' && bytes[header_end + 1] == '\n';
  return header_end + (two ? 2 : 1);
}

}  // namespace

OpenedImage open_pgm(std::span<const std::uint8_t> bytes, std::int64_t max_pixels) {
  if (bytes.size() < 2 || bytes[0] != 'P' || (bytes[1] != '2' && bytes[1] != '5')) {
    return ImageFault{kind_fault(bytes)};
  }
  NumberReader numbers(bytes);
  const auto columns = numbers.next();
  if (columns.value_or(0) == 0) return ImageFault{header_fault("width", kLongestSide)};
  const auto rows = numbers.next();
  if (rows.value_or(0) == 0) return ImageFault{header_fault("height", kLongestSide)};
  const auto largest = numbers.next();
  if (largest.value_or(0) == 0 || *largest > kLargestGray)
    return ImageFault{header_fault("largest gray", kLargestGray)};
  if (auto fault = size_fault(*columns, *rows, max_pixels)) return *fault;

  const ImageHeader header{static_cast<int>(*columns), static_cast<int>(*rows), 1,
                           static_cast<int>(*largest)};
  const std::uint64_t pixels = *columns * *rows;
  if (bytes[1] == '2') {
    if (numbers.left() < 2 * pixels) {  // each pixel has a digit and white space before it
      return ImageFault{"Its " + std::to_string(pixels) + " pixels do not fit in the " +
                        std::to_string(numbers.left()) + " bytes after its header: it is truncated."};
    }
    return std::unique_ptr<ImageReader>(std::make_unique<PlainReader>(header, numbers));
  }
  const std::uint64_t size = pixels * (*largest > 255 ? 2 : 1);
  const std::size_t begin = std::min(raw_begin(bytes, numbers.at(), size), bytes.size());
  if (bytes.size() - begin < size) {
    return ImageFault{"Its pixels need " + std::to_string(size) + " bytes, but " +
                      std::to_string(bytes.size() - begin) + " follow its header: it is truncated."};
  }
  return std::unique_ptr<ImageReader>(std::make_unique<RawReader>(header, bytes.subspan(begin)));
}

}  // namespace fleetplan::api

#pragma once

// Images of every form of PNG: what is in the file, and what the reader has to make of it.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/fuzz/choices.h"
#include "tests/support/png_chunks.h"

namespace fleetplan::fuzz {

enum ColourType { kGray = 0, kColours = 2, kPalette = 3, kGrayAlpha = 4, kColoursAlpha = 6 };

/// An image as samples, as many for each pixel as its colour type has.
struct MadeImage {
  int columns = 1;
  int rows = 1;
  int colour_type = kGray;
  int depth = 8;
  bool interlaced = false;
  bool has_transparency = false;  // a chunk tRNS
  std::string palette{};          // three bytes for each colour
  std::string transparency{};     // the data of tRNS
  std::vector<std::uint16_t> samples{};

  int samples_of_pixel() const {
    switch (colour_type) {
      case kColours:
        return 3;
      case kGrayAlpha:
        return 2;
      case kColoursAlpha:
        return 4;
      default:
        return 1;
    }
  }
  std::uint16_t sample(int column, int row, int index) const {
    return samples[static_cast<std::size_t>((row * columns + column) * samples_of_pixel() + index)];
  }
};

inline MadeImage make_image(Choices& choices) {
  constexpr std::array<int, 5> kTypes{kGray, kColours, kPalette, kGrayAlpha, kColoursAlpha};
  MadeImage image;
  image.columns = 1 + choices.below(20);
  image.rows = 1 + choices.below(20);
  image.colour_type = kTypes[static_cast<std::size_t>(choices.below(5))];
  const bool any_depth = image.colour_type == kGray;
  const bool is_palette = image.colour_type == kPalette;
  image.depth = any_depth    ? 1 << choices.below(5)
                : is_palette ? 1 << choices.below(4)
                             : 8 << choices.below(2);
  image.interlaced = choices.one_in(2);
  const int colours = is_palette ? 1 + choices.below(1 << image.depth) : 0;
  image.palette = choices.bytes(3 * colours);
  image.has_transparency = image.colour_type <= kPalette && choices.one_in(2);
  const int most = is_palette ? colours : 1 << image.depth;
  for (int k = 0; k < image.columns * image.rows * image.samples_of_pixel(); ++k) {
    int value = choices.byte();
    if (image.depth == 16) value = value << 8 | choices.byte();
    image.samples.push_back(static_cast<std::uint16_t>(value % most));
  }
  if (!image.has_transparency) return image;
  if (is_palette) {
    image.transparency = choices.bytes(1 + choices.below(colours));
    return image;
  }
  for (int index = 0; index < image.samples_of_pixel(); ++index) {  // the colour of the first pixel
    const std::uint16_t value = image.sample(0, 0, index);
    image.transparency += {static_cast<char>(value >> 8U), static_cast<char>(value)};
  }
  return image;
}

/// Every `column_step`-th pixel from `column` on of every `row_step`-th row: a pass, or the whole.
struct Pass {
  int column, row, column_step, row_step;
};

/// The bytes of the pass before compression, with the filters none, sub and up.
inline std::string filtered(const MadeImage& image, const Pass& pass, Choices& choices) {
  std::string text;
  std::string above;
  for (int row = pass.row; row < image.rows && pass.column < image.columns; row += pass.row_step) {
    std::string line;
    int bits = 0;
    for (int column = pass.column; column < image.columns; column += pass.column_step) {
      for (int index = 0; index < image.samples_of_pixel(); ++index, bits += image.depth) {
        const std::uint16_t value = image.sample(column, row, index);
        if (image.depth == 16) line += static_cast<char>(value >> 8U);
        if (bits % 8 == 0) line += '\0';
        const int shift = image.depth >= 8 ? 0 : 8 - image.depth - bits % 8;
        line.back() = static_cast<char>(line.back() | static_cast<std::uint8_t>(value) << shift);
      }
    }
    above.resize(line.size());
    const std::size_t pixel =
        static_cast<std::size_t>(std::max(1, image.depth * image.samples_of_pixel() / 8));
    const int filter = choices.below(3);
    text += static_cast<char>(filter);
    for (std::size_t at = 0; at < line.size(); ++at) {
      const char left = at < pixel ? '\0' : line[at - pixel];
      const char predicted = filter == 0 ? '\0' : filter == 1 ? left : above[at];
      text += static_cast<char>(line[at] - predicted);
    }
    above = line;
  }
  return text;
}

inline std::string pixels_of(const MadeImage& image, Choices& choices) {
  constexpr std::array<Pass, 7> kPasses{
      {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};
  if (!image.interlaced) return filtered(image, {0, 0, 1, 1}, choices);
  std::string text;
  for (const Pass& pass : kPasses) text += filtered(image, pass, choices);
  return text;
}

/// The channels that the reader has to find.
inline std::vector<std::uint16_t> expected_channels(const MadeImage& image) {
  std::vector<std::uint16_t> channels;
  const auto add = [&](unsigned value) { channels.push_back(static_cast<std::uint16_t>(value)); };
  const auto byte = [](const std::string& text, int at) {
    return std::uint8_t(text[static_cast<std::size_t>(at)]);
  };
  const unsigned largest = (1U << static_cast<unsigned>(image.depth)) - 1;
  for (int pixel = 0; pixel < image.columns * image.rows; ++pixel) {
    const int column = pixel % image.columns;
    const int row = pixel / image.columns;
    if (image.colour_type == kPalette) {
      const int colour = image.sample(column, row, 0);
      for (int part = 0; part < 3; ++part) add(byte(image.palette, 3 * colour + part) * 257U);
      const bool is_opaque = colour >= static_cast<int>(image.transparency.size());
      if (image.has_transparency) add((is_opaque ? 255U : byte(image.transparency, colour)) * 257U);
      continue;
    }
    bool is_transparent = true;
    for (int index = 0; index < image.samples_of_pixel(); ++index) {
      add(image.sample(column, row, index) * (65535U / largest));
      is_transparent = is_transparent && image.sample(column, row, index) == image.sample(0, 0, index);
    }
    if (image.has_transparency) add(is_transparent ? 0 : 65535U);
  }
  return channels;
}

}  // namespace fleetplan::fuzz

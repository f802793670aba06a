#pragma once

// Images of maps for tests, as bytes and as base64.

#include <png.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::api {

using Samples = std::vector<std::vector<std::uint8_t>>;  // rows of bytes, the top one first

/// A raw graymap of rows of grays.
inline std::string pgm(const Samples& rows, const std::string& header_end = "255\n") {
  std::string text =
      "P5\n" + std::to_string(rows.front().size()) + " " + std::to_string(rows.size()) + "\n" + header_end;
  for (const auto& row : rows) text.append(row.begin(), row.end());
  return text;
}

/// How pixels are stored in a PNG.
struct PngForm {
  int colour_type = PNG_COLOR_TYPE_GRAY;
  int bit_depth = 8;
  int interlace = PNG_INTERLACE_NONE;
  std::vector<png_color> palette{};
  std::vector<std::uint8_t> palette_alpha{};
  int transparent_gray = -1;  // none
};

/// A PNG of rows of packed samples. Samples of 16 bits have the high byte first.
inline std::string png(int columns, const Samples& rows, const PngForm& form = {}) {
  std::string file;
  png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(writer);
  if (setjmp(png_jmpbuf(writer)) != 0) throw std::logic_error("the image of a test cannot be written");
  png_set_write_fn(
      writer, &file,
      [](png_structp png, png_bytep bytes, std::size_t size) {
        static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), size);
      },
      nullptr);
  png_set_IHDR(writer, info, static_cast<png_uint_32>(columns), static_cast<png_uint_32>(rows.size()),
               form.bit_depth, form.colour_type, form.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (!form.palette.empty())
    png_set_PLTE(writer, info, form.palette.data(), static_cast<int>(form.palette.size()));
  if (!form.palette_alpha.empty()) {
    png_set_tRNS(writer, info, form.palette_alpha.data(), static_cast<int>(form.palette_alpha.size()),
                 nullptr);
  }
  if (form.transparent_gray >= 0) {
    png_color_16 transparent{};
    transparent.gray = static_cast<png_uint_16>(form.transparent_gray);
    png_set_tRNS(writer, info, nullptr, 0, &transparent);
  }
  png_write_info(writer, info);
  std::vector<png_bytep> lines;
  for (const auto& row : rows) lines.push_back(const_cast<png_bytep>(row.data()));
  png_write_image(writer, lines.data());
  png_write_end(writer, nullptr);
  png_destroy_write_struct(&writer, &info);
  return file;
}

}  // namespace fleetplan::api

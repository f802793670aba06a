#pragma once

// PNG files for tests, chunk by chunk, also such as no encoder would write.

#include <zlib.h>

#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

namespace fleetplan::support {

inline std::string big_endian(std::uint32_t value) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8)
    text += static_cast<char>(value >> static_cast<unsigned>(shift));
  return text;
}

/// Returns a chunk with its length and its check sum.
inline std::string chunk(std::string_view name, const std::string& data = {}) {
  const std::string checked = std::string(name) + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + checked +
         big_endian(static_cast<std::uint32_t>(sum));
}

inline std::string png_of(std::initializer_list<std::string> chunks) {
  std::string file = "\x89PNG\r\n\x1a\n";
  for (const std::string& each : chunks) file += each;
  return file;
}

/// Returns the first chunk. `colour_type` and `interlace` are numbers of the format.
inline std::string png_header(std::uint32_t columns, std::uint32_t rows, int depth = 8, int colour_type = 0,
                              int interlace = 0) {
  return chunk("IHDR", big_endian(columns) + big_endian(rows) + static_cast<char>(depth) +
                           static_cast<char>(colour_type) + std::string(2, '\0') +
                           static_cast<char>(interlace));
}

/// Returns the bytes compressed as pixels and texts are.
inline std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string compressed(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(compressed.data()), &size,
               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != Z_OK) {
    throw std::logic_error("the data of a test cannot be compressed");
  }
  compressed.resize(size);
  return compressed;
}

}  // namespace fleetplan::support

// Files of PNG chunks in any order. The reader's result does not depend on what was in the memory that it
// allocates, and valid files have their pixels. The first byte selects a valid file or any.

#include <array>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "api/request/map/image/decode_image.h"
#include "tests/fuzz/made_image.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/target.h"

namespace {

/// What fresh memory is filled with, of the library's allocations too.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): operator new has no other way to know
// it
int fill = 0;

}  // namespace

// NOLINTBEGIN(cppcoreguidelines-no-malloc, cppcoreguidelines-owning-memory, misc-new-delete-overloads)
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  void* memory = std::malloc(size);
  if (memory != nullptr) std::memset(memory, fill, size);
  return memory;
}
void* operator new(std::size_t size) {
  void* memory = operator new(size, std::nothrow);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
// NOLINTEND(cppcoreguidelines-no-malloc, cppcoreguidelines-owning-memory, misc-new-delete-overloads)

namespace fleetplan::fuzz {

namespace TEST_FILE {

using support::big_endian;
using support::chunk;
using support::deflated;
using support::png_header;

constexpr std::int64_t kMax = 4096;  // pixels
constexpr int kMaxChunks = 12;

struct Outcome {
  int columns = 0;
  int rows = 0;
  int channels_of_pixel = 0;
  std::vector<std::uint16_t> channels;
  std::string fault;
  bool too_large = false;

  bool operator==(const Outcome&) const = default;
};

/// What the reader makes of a file while fresh memory is filled with `pattern`.
Outcome read(const std::string& file, int pattern) {
  fill = pattern;
  core::Work stop = core::Work::unbounded();
  const auto opened =
      api::open_png({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, kMax, stop);
  if (!opened) return {0, 0, 0, {}, opened.failure().detail, opened.failure().too_large};
  const api::ImageHeader& header = (*opened)->header();
  Outcome outcome{header.columns, header.rows, header.channels, {}, {}, false};
  for (int row = 0; row < header.rows; ++row) {
    const auto pixels = (*opened)->next_row();
    if (!pixels) {
      outcome.fault = pixels.failure();
      return outcome;
    }
    require(pixels->size() == static_cast<std::size_t>(header.columns * header.channels),
            "a row of another length");
    outcome.channels.insert(outcome.channels.end(), pixels->begin(), pixels->end());
  }
  return outcome;
}

std::string header_of(const MadeImage& image) {
  return png_header(static_cast<std::uint32_t>(image.columns), static_cast<std::uint32_t>(image.rows),
                    image.depth, image.colour_type, image.interlaced ? 1 : 0);
}

/// A chunk that the pixels do not need.
std::string needless_chunk(Choices& choices) {
  constexpr std::array<const char*, 18> kNames{"zTXt", "iTXt", "tEXt", "iCCP", "gAMA", "cHRM",
                                               "sBIT", "bKGD", "hIST", "pHYs", "tIME", "eXIf",
                                               "sPLT", "sRGB", "oFFs", "pCAL", "abCd", "vpAg"};
  const std::string name = kNames[static_cast<std::size_t>(choices.below(static_cast<int>(kNames.size())))];
  switch (choices.below(4)) {
    case 0:
      return chunk(name);
    case 1: {  // sizes where a header has them
      const auto columns = static_cast<std::uint32_t>(choices.below(64));
      return chunk(name, big_endian(columns) + big_endian(1) + std::string("\x08\0\0\0\0", 5));
    }
    case 2:
      return chunk(name, std::string("a\0\0", 3) + deflated(std::string(10'000, '\0')));
    default:
      return chunk(name, choices.bytes(choices.below(64)));
  }
}

/// A file of the image, with chunks between that change nothing.
std::string valid_file(const MadeImage& image, Choices& choices) {
  std::string file = support::png_of({header_of(image)});
  if (choices.one_in(3)) file += needless_chunk(choices);
  if (!image.palette.empty()) file += chunk("PLTE", image.palette);
  if (image.has_transparency) file += chunk("tRNS", image.transparency);
  if (choices.one_in(3)) file += needless_chunk(choices);
  std::string pixels = pixels_of(image, choices);
  if (choices.one_in(4)) pixels += std::string(100'000, '\0');  // more than the image has
  std::string compressed = deflated(pixels);
  while (!compressed.empty()) {
    const bool is_last = choices.one_in(2) || !choices.any_left();
    const std::size_t size = is_last ? compressed.size() : static_cast<std::size_t>(choices.byte());
    file += chunk("IDAT", compressed.substr(0, size));
    compressed.erase(0, size);
  }
  if (choices.one_in(4)) file += chunk("zTXt", std::string(2000, 'x'));
  return choices.one_in(8) ? file : file + chunk("IEND");
}

/// A header whose size and form may be of another image, or of none.
std::string any_header(const MadeImage& image, Choices& choices) {
  MadeImage other = image;
  switch (choices.below(4)) {
    case 0:
      return header_of(image);
    case 1:
      other.columns = 1 + choices.below(64);
      other.rows = 1 + choices.below(64);
      return header_of(other);
    case 2:
      other.columns = static_cast<int>(choices.word());
      other.rows = static_cast<int>(choices.word());
      other.depth = choices.byte();
      return header_of(other);
    default:
      return chunk("IHDR", choices.bytes(choices.below(16)));
  }
}

std::string any_chunk(const MadeImage& image, const std::string& compressed, Choices& choices) {
  switch (choices.below(8)) {
    case 0:
      return any_header(image, choices);
    case 1:
      return chunk("PLTE", choices.bytes(choices.below(32)));
    case 2:
      return chunk("tRNS", choices.bytes(choices.below(12)));
    case 3:
      return needless_chunk(choices);
    case 4:
      return chunk("IDAT", compressed.substr(0, choices.byte()));
    case 5:
      return chunk("IDAT", choices.bytes(choices.below(64)));
    case 6: {
      const std::string name = choices.one_in(2) ? "IEND" : choices.bytes(4);
      return chunk(name, choices.bytes(choices.below(16)));
    }
    default:
      return chunk("IDAT", compressed);
  }
}

/// A few chunks in any order, with lengths and check sums that may be wrong.
std::string any_file(const MadeImage& image, Choices& choices) {
  const std::string compressed = deflated(pixels_of(image, choices));
  std::string file = support::png_of({});
  if (!choices.one_in(4)) file += any_header(image, choices);
  if (!choices.one_in(4)) file += chunk("PLTE", image.palette);
  if (!choices.one_in(4)) file += chunk("tRNS", image.transparency);
  for (int k = 0; k < kMaxChunks && choices.any_left(); ++k) file += any_chunk(image, compressed, choices);
  const std::size_t at = choices.word() % file.size();
  if (choices.one_in(4)) file[at] = static_cast<char>(choices.byte());
  if (choices.one_in(8)) file.resize(at);
  return file;
}

void try_file(Choices choices) {
  const bool is_valid = choices.one_in(2);
  const MadeImage image = make_image(choices);
  const std::string file = is_valid ? valid_file(image, choices) : any_file(image, choices);
  const Outcome outcome = read(file, 0);
  for (const int pattern : {0xff, 0x5a})
    require(read(file, pattern) == outcome, "the result depends on fresh memory");
  if (!is_valid) return;
  require(outcome.fault.empty(), "a valid file is rejected", outcome.fault);
  require(outcome.columns == image.columns && outcome.rows == image.rows, "another size");
  require(outcome.channels == expected_channels(image), "other pixels");
}

void run(Input input) { try_file(Choices(input)); }

const Target target("png", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz

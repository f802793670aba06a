// PNG by libpng. Its errors leave by longjmp, over frames of the library and of the small functions here that
// call it; none of these has an object with a destructor.

#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <new>
#include <string_view>
#include <vector>

#include "api/request/map/image/image_reader.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::uint8_t, 8> kSignature{137, 80, 78, 71, 13, 10, 26, 10};
constexpr std::size_t kSizesAt = 16;                      // of width and height, four bytes each
constexpr png_alloc_size_t kMostChunkMemory = 1U << 20U;  // bytes, of a chunk other than pixels

/// What the library is told, and what it tells.
struct Source {
  std::span<const std::uint8_t> bytes;
  std::size_t at = 0;
  std::array<char, 96> error{};
  bool out_of_memory = false;
};

// Functions that the library calls.

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
  auto* source = static_cast<Source*>(png_get_error_ptr(png));
  std::strncpy(source->error.data(), text, source->error.size() - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*text*/) {}

void on_read(png_structp png, png_bytep target, std::size_t size) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (source->bytes.size() - source->at < size) png_error(png, "the file ends too early");
  std::memcpy(target, source->bytes.data() + source->at, size);
  source->at += size;
}

/// What the library allocates counts as memory of the job, too.
png_voidp on_allocate(png_structp png, png_alloc_size_t size) {
  void* memory = ::operator new(size, std::nothrow);
  if (memory == nullptr) static_cast<Source*>(png_get_mem_ptr(png))->out_of_memory = true;
  return memory;
}

void on_free(png_structp /*png*/, png_voidp memory) { ::operator delete(memory); }

// Calls of the library: false after an error.

bool read_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp): the library has no other way
  png_read_info(png, info);
  png_set_expand(png);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);  // of channels of 16 bits
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return true;
}

bool read_row(png_structp png, std::uint8_t* row) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp)
  png_read_row(png, row, nullptr);
  return true;
}

/// What follows the pixels: the check sums of the last ones, above all.
bool read_end(png_structp png) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp)
  png_read_end(png, nullptr);
  return true;
}

/// The structures of the library.
class Handle {
 public:
  explicit Handle(std::span<const std::uint8_t> bytes)
      : source_{bytes},
        png_(png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &source_, on_error, on_warning, &source_,
                                      on_allocate, on_free)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, &source_, on_read);
    png_set_user_limits(png_, kLongestSide, kLongestSide);
    png_set_chunk_malloc_max(png_, kMostChunkMemory);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { png_destroy_read_struct(&png_, &info_, nullptr); }

  png_structp png() const { return png_; }
  png_infop info() const { return info_; }
  /// Why a call failed. Throws std::bad_alloc if it was memory.
  std::string error() const {
    if (source_.out_of_memory) throw std::bad_alloc();
    return "It is damaged: " + std::string(source_.error.data()) + ".";
  }

 private:
  Source source_;
  png_structp png_;
  png_infop info_ = nullptr;
};

class PngReader final : public ImageReader {
 public:
  PngReader(std::unique_ptr<Handle> handle, const ImageHeader& header, core::Work& stop)
      : ImageReader(header),
        handle_(std::move(handle)),
        stop_(stop),
        wide_(png_get_bit_depth(handle_->png(), handle_->info()) == 16),
        interlaced_(png_get_interlace_type(handle_->png(), handle_->info()) != PNG_INTERLACE_NONE),
        row_bytes_(png_get_rowbytes(handle_->png(), handle_->info())),
        bytes_(row_bytes_ * (interlaced_ ? static_cast<std::size_t>(header.rows) : 1)),
        channels_(static_cast<std::size_t>(header.columns) * static_cast<std::size_t>(header.channels)) {}

  Result<Row, std::string> next_row() override {
    const bool first = row_ == 0;
    const bool last = ++row_ == header().rows;
    std::uint8_t* bytes = bytes_.data();
    if (interlaced_) {
      if (first && !read_passes()) return handle_->error();
      bytes += row_bytes_ * static_cast<std::size_t>(row_ - 1);
    } else if (!read_row(handle_->png(), bytes)) {
      return handle_->error();
    }
    if (last && !stop_.met() && !read_end(handle_->png())) return handle_->error();
    unpack(bytes);
    return Row(channels_);
  }

 private:
  bool read_passes() {
    for (int pass = 0; pass < PNG_INTERLACE_ADAM7_PASSES; ++pass) {
      for (int row = 0; row < header().rows; ++row) {
        if (!read_row(handle_->png(), bytes_.data() + row_bytes_ * static_cast<std::size_t>(row)))
          return false;
        if (stop_.met_after(row_bytes_)) return true;
      }
    }
    return true;
  }

  void unpack(const std::uint8_t* bytes) {
    if (wide_) {
      std::memcpy(channels_.data(), bytes, row_bytes_);
    } else {
      for (std::uint16_t& channel : channels_) channel = static_cast<std::uint16_t>(*bytes++ * 257U);
    }
  }

  std::unique_ptr<Handle> handle_;
  core::Work& stop_;
  bool wide_;  // channels of 16 bits
  bool interlaced_;
  std::size_t row_bytes_;
  std::vector<std::uint8_t> bytes_;  // of a row; of an interlaced image, of all
  std::vector<std::uint16_t> channels_;
  int row_ = 0;
};

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24U | std::uint32_t{bytes[1]} << 16U | std::uint32_t{bytes[2]} << 8U |
         bytes[3];
}

}  // namespace

OpenedImage open_png(std::span<const std::uint8_t> bytes, std::int64_t most, core::Work& stop) {
  const bool is_png =
      bytes.size() >= kSignature.size() && std::equal(kSignature.begin(), kSignature.end(), bytes.begin());
  if (!is_png) return ImageFault{"It does not begin as a PNG image."};
  if (bytes.size() < kSizesAt + 8) return ImageFault{"It is damaged: the file ends too early."};
  const std::uint32_t columns = big_endian(bytes.data() + kSizesAt);
  const std::uint32_t rows = big_endian(bytes.data() + kSizesAt + 4);
  if (auto fault = size_fault(columns, rows, most)) return *fault;
  auto handle = std::make_unique<Handle>(bytes);
  if (!read_header(handle->png(), handle->info())) return ImageFault{handle->error()};
  const ImageHeader header{static_cast<int>(columns), static_cast<int>(rows),
                           png_get_channels(handle->png(), handle->info()), 65535};
  return std::unique_ptr<ImageReader>(std::make_unique<PngReader>(std::move(handle), header, stop));
}

}  // namespace fleetplan::api

// Reads PNG with libpng. The library says everything that is known about an image; nothing is read past it.
// Its errors leave by longjmp, over frames of the library and of the small functions here that call it. None
// of these frames has an object with a destructor.
//
// The library asks for all bytes by on_read, which asks the work. It reads little between two calls
// (kReadAtOnce). Chunks that it does not need are skipped without being decompressed.

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <new>
#include <string_view>
#include <vector>

#include "api/request/map/image/decode_image.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::uint8_t, 8> kSignature{137, 80, 78, 71, 13, 10, 26, 10};
constexpr std::array<std::uint8_t, 4> kHeaderName{'I', 'H', 'D', 'R'};
constexpr std::size_t kFirstNameAt = kSignature.size() + 4;  // after the first chunk's length
constexpr png_alloc_size_t kMaxChunk = 1U << 20U;            // bytes of a chunk other than pixels
constexpr png_uint_32 kNoKeptChunks = 1;                     // in libpng 0 stands for no limit
/// The bytes of compressed pixels that are read at once. They decompress to a megabyte at most.
constexpr std::size_t kReadAtOnce = 1024;
/// The most bytes that are read behind the last pixel: the end of the compressed data and the check sums, in
/// a second chunk perhaps. Whatever else follows stays unread.
constexpr std::size_t kMaxBehindPixels = 64;

/// What the library and this reader tell each other.
struct Source {
  std::span<const std::uint8_t> bytes;
  core::Work* work = nullptr;
  std::size_t at = 0;
  png_uint_32 rows = PNG_UINT_32_MAX;  // unknown at first
  std::size_t behind_pixels = 0;       // bytes read there
  std::array<char, 96> error{};
  bool out_of_memory = false;
};

// The functions below are called by the library.

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
  auto* source = static_cast<Source*>(png_get_error_ptr(png));
  std::strncpy(source->error.data(), text, source->error.size() - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*text*/) {}

/// Whether all pixels are decompressed: rows count from 0 again in each of the passes of an interlaced image.
bool has_all_pixels(png_structp png, const Source& source) {
  return png_get_current_pass_number(png) == PNG_INTERLACE_ADAM7_PASSES ||
         png_get_current_row_number(png) == source.rows;
}

void on_read(png_structp png, png_bytep target, std::size_t size) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (source->work->met_after(size)) png_error(png, "the reading was stopped");
  if (has_all_pixels(png, *source)) {
    source->behind_pixels += size;
    if (source->behind_pixels > kMaxBehindPixels) png_error(png, "data behind the pixels");
  }
  if (source->bytes.size() - source->at < size) png_error(png, "the file ends too early");
  std::memcpy(target, source->bytes.data() + source->at, size);
  source->at += size;
}

/// Allocates for the library. The bytes count as memory of the job, too.
png_voidp on_allocate(png_structp png, png_alloc_size_t size) {
  void* memory = ::operator new(size, std::nothrow);
  if (memory == nullptr) static_cast<Source*>(png_get_mem_ptr(png))->out_of_memory = true;
  return memory;
}

void on_free(png_structp /*png*/, png_voidp memory) { ::operator delete(memory); }

// The functions below call the library. They return false after an error.

bool try_to_read_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp): the library has no other way
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr,
                              -1);  // all but IHDR, PLTE, tRNS, IDAT, IEND
  png_set_compression_buffer_size(png, kReadAtOnce);
  png_read_info(png, info);
  return true;
}

/// Sets how the pixels are to be given, and allocates memory for a row.
bool try_to_begin_rows(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp)
  png_set_expand(png);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);  // 16-bit channels
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return true;
}

bool try_to_read_row(png_structp png, std::uint8_t* row) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp)
  png_read_row(png, row, nullptr);
  return true;
}

/// The structures of the library.
class Handle {
 public:
  Handle(std::span<const std::uint8_t> bytes, core::Work& work)
      : source_{bytes, &work},
        png_(png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &source_, on_error, on_warning, &source_,
                                      on_allocate, on_free)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, &source_, on_read);
    png_set_user_limits(png_, kLongestSide, kLongestSide);
    png_set_chunk_malloc_max(png_, kMaxChunk);
    png_set_chunk_cache_max(png_, kNoKeptChunks);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { png_destroy_read_struct(&png_, &info_, nullptr); }

  png_structp png() const { return png_; }
  png_infop info() const { return info_; }

  bool read_header() { return try_to_read_header(png_, info_); }
  std::uint32_t columns() const { return png_get_image_width(png_, info_); }
  std::uint32_t rows() const { return png_get_image_height(png_, info_); }
  bool begin_rows() {
    source_.rows = rows();
    return try_to_begin_rows(png_, info_);
  }
  /// Reads a row. Returns false if its pixels cannot be read. Data that end the reading behind the last row
  /// are no fault.
  bool read_row(std::uint8_t* row) {
    return try_to_read_row(png_, row) || source_.behind_pixels > kMaxBehindPixels;
  }
  /// Returns why a call failed. Throws std::bad_alloc if it was memory.
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
  PngReader(std::unique_ptr<Handle> handle, const ImageHeader& header, core::Work& work)
      : ImageReader(header),
        handle_(std::move(handle)),
        work_(work),
        wide_(png_get_bit_depth(handle_->png(), handle_->info()) == 16),
        interlaced_(png_get_interlace_type(handle_->png(), handle_->info()) != PNG_INTERLACE_NONE),
        row_bytes_(png_get_rowbytes(handle_->png(), handle_->info())),
        bytes_(row_bytes_ * (interlaced_ ? static_cast<std::size_t>(header.rows) : 1)),
        channels_(wide_ ? row_bytes_ / 2 : row_bytes_) {}

  Result<Row, std::string> next_row() override {
    std::uint8_t* bytes = bytes_.data();
    if (interlaced_) {
      if (row_ == 0 && !read_passes()) return handle_->error();
      bytes += row_bytes_ * static_cast<std::size_t>(row_++);
    } else if (!handle_->read_row(bytes)) {
      return handle_->error();
    }
    unpack(bytes);
    return Row(channels_);
  }

 private:
  bool read_passes() {
    for (int pass = 0; pass < PNG_INTERLACE_ADAM7_PASSES; ++pass) {
      for (int row = 0; row < header().rows; ++row) {
        if (!handle_->read_row(bytes_.data() + row_bytes_ * static_cast<std::size_t>(row))) return false;
        if (work_.met_after(row_bytes_)) return true;
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
  core::Work& work_;
  bool wide_;  // channels have 16 bits
  bool interlaced_;
  std::size_t row_bytes_;
  std::vector<std::uint8_t> bytes_;  // bytes of a row; for an interlaced image, of all rows
  std::vector<std::uint16_t> channels_;
  int row_ = 0;  // for an interlaced image, the next row
};

/// Returns the fault of the first bytes.
std::optional<ImageFault> beginning_fault(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kSignature.size() || !std::equal(kSignature.begin(), kSignature.end(), bytes.begin()))
    return ImageFault{"It does not begin as a PNG image."};
  if (bytes.size() < kFirstNameAt + kHeaderName.size())
    return ImageFault{"It is damaged: the file ends too early."};
  if (std::equal(kHeaderName.begin(), kHeaderName.end(), bytes.begin() + kFirstNameAt)) return std::nullopt;
  return ImageFault{
      "Its first chunk is not the header, IHDR, as PNG requires. Save it as PNG again with an image editor."};
}

}  // namespace

OpenedImage open_png(std::span<const std::uint8_t> bytes, std::int64_t max_pixels, core::Work& work) {
  if (auto fault = beginning_fault(bytes)) return *fault;
  auto handle = std::make_unique<Handle>(bytes, work);
  const bool has_header = handle->read_header();
  // The library knows the size also if it rejects it.
  if (auto fault = size_fault(handle->columns(), handle->rows(), max_pixels)) return *fault;
  if (!has_header || !handle->begin_rows()) return ImageFault{handle->error()};
  const ImageHeader header{static_cast<int>(handle->columns()), static_cast<int>(handle->rows()),
                           png_get_channels(handle->png(), handle->info()), 65535};
  return std::unique_ptr<ImageReader>(std::make_unique<PngReader>(std::move(handle), header, work));
}

}  // namespace fleetplan::api


#include "server/http/request/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

namespace fleetplan::server {

namespace {

constexpr std::size_t kPiece = 64 * 1024;
constexpr int kGzipOnly = 16 + MAX_WBITS;
/// The level of compression. Answers are numbers, mostly: higher levels take several times as long for a few
/// percent.
constexpr int kLevel = 4;
constexpr int kMemoryLevel = 8;  // zlib's default

/// Decodes one member after the other.
class Inflater {
 public:
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): zlib fills the buffer
  Inflater(std::string_view coded, const core::StopCondition& stop) : stop_(stop), left_(coded.size()) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(coded.data()));  // zlib only reads it
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Returns the next decoded bytes, valid until the next call; empty at the end, if the rest is not valid,
  /// or if the stop condition is met.
  std::string_view next() {
    while (valid_ && !ended_) {
      stopped_ = stop_.met();
      if (stopped_) break;
      feed();
      stream_.next_out = reinterpret_cast<Bytef*>(buffer_.data());
      stream_.avail_out = kPiece;
      const int result = inflate(&stream_, Z_NO_FLUSH);
      valid_ = result == Z_OK || result == Z_STREAM_END;
      if (result == Z_STREAM_END) end_member();
      if (valid_ && stream_.avail_out < kPiece) return {buffer_.data(), kPiece - stream_.avail_out};
    }
    return {};
  }

  /// Whether, at the end, all of it was valid.
  bool complete() const { return valid_ && ended_; }
  bool stopped() const { return stopped_; }

 private:
  /// Feeds more input: zlib counts it in 32 bits.
  void feed() {
    if (stream_.avail_in > 0) return;
    stream_.avail_in = static_cast<uInt>(std::min(left_, kPiece));
    left_ -= stream_.avail_in;
  }

  void end_member() {
    ended_ = stream_.avail_in == 0 && left_ == 0;
    if (!ended_) valid_ = inflateReset(&stream_) == Z_OK;
  }

  const core::StopCondition& stop_;
  z_stream stream_{};
  std::size_t left_;  // bytes of the input that are not fed yet
  bool stopped_ = false;
  bool valid_ = true;
  bool ended_ = false;
  std::array<char, kPiece> buffer_;
};

/// Encodes one member.
class Deflater {
 public:
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): zlib fills the buffer
  Deflater() {
    if (deflateInit2(&stream_, kLevel, Z_DEFLATED, kGzipOnly, kMemoryLevel, Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  /// Appends the code of a piece to `coded`.
  void add(std::string_view piece, bool is_last, std::string& coded) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));  // zlib only reads it
    stream_.avail_in = static_cast<uInt>(piece.size());
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(buffer_.data());
      stream_.avail_out = kPiece;
      deflate(&stream_, is_last ? Z_FINISH : Z_NO_FLUSH);
      coded.append(buffer_.data(), kPiece - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

 private:
  z_stream stream_{};
  std::array<char, kPiece> buffer_;
};

}  // namespace

std::optional<std::string> gzip(std::string_view text, const core::StopCondition& stop) {
  Deflater deflater;
  std::string coded;
  for (std::size_t begin = 0; begin == 0 || begin < text.size(); begin += kPiece) {
    if (stop.met()) return std::nullopt;
    deflater.add(text.substr(begin, kPiece), begin + kPiece >= text.size(), coded);
  }
  return coded;
}

std::variant<std::string, BodyFault> gunzip(std::string_view coded, std::uint64_t limit,
                                            BodyMemory::Share& share, const core::StopCondition& stop) {
  Inflater inflater(coded, stop);
  std::string decoded;
  for (auto part = inflater.next(); !part.empty(); part = inflater.next()) {
    if (part.size() > limit - decoded.size()) {
      return BodyFault{BodyFault::Kind::too_large, "The body of " + std::to_string(coded.size()) +
                                                       " bytes exceeds the limit of " +
                                                       std::to_string(limit) + " bytes when decompressed." +
                                                       std::string(api::kLargeMapRemedy)};
    }
    if (!share.grow_to(coded.size() + decoded.size() + part.size())) {
      return BodyFault{BodyFault::Kind::no_room, BodyMemory::kFull};
    }
    decoded += part;
  }
  if (inflater.complete()) return decoded;
  if (inflater.stopped())
    return BodyFault{BodyFault::Kind::stopped, "The body was not decompressed in time."};
  return malformed_body("The body is not valid, complete gzip, which its Content-Encoding declares.");
}

}  // namespace fleetplan::server

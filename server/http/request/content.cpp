#include "server/http/request/content.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>

#include "server/http/text.h"

namespace fleetplan::server {

namespace {

struct Weighted {
  std::string name;  // lower case, without parameters
  double quality;    // 0 to 1
};

Weighted parse_weighted(std::string_view item) {
  const auto parts = split(item, ';');
  Weighted weighted{parts.empty() ? std::string() : lower_case(parts.front()), 1.0};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string parameter = lower_case(parts[i]);
    if (!parameter.starts_with("q=")) continue;
    weighted.quality = std::clamp(std::strtod(parameter.c_str() + 2, nullptr), 0.0, 1.0);
  }
  return weighted;
}

/// Returns the quality of a media type by the most specific range of an Accept field; 0 when there is none.
double quality(std::string_view accept, std::string_view type) {
  const std::string_view family = type.substr(0, type.find('/') + 1);
  int best_rank = 0;
  double quality = 0.0;
  for (const auto item : split(accept, ',')) {
    const Weighted range = parse_weighted(item);
    const int rank = range.name == type                        ? 3
                     : range.name == std::string(family) + '*' ? 2
                     : range.name == "*/*"                     ? 1
                                                               : 0;
    if (rank == 0 || rank < best_rank) continue;
    quality = rank > best_rank ? range.quality : std::max(quality, range.quality);
    best_rank = rank;
  }
  return quality;
}

}  // namespace

std::optional<PlanForm> plan_form(std::string_view accept) {
  if (trimmed(accept).empty()) return PlanForm::json;
  const double json = quality(accept, "application/json");
  const double events = quality(accept, "text/event-stream");
  if (json <= 0.0 && events <= 0.0) return std::nullopt;
  return events > json ? PlanForm::events : PlanForm::json;
}

bool accepts_gzip(std::string_view accept_encoding) {
  bool by_star = false;
  for (const auto item : split(accept_encoding, ',')) {
    const Weighted coding = parse_weighted(item);
    if (coding.name == "gzip" || coding.name == "x-gzip") return coding.quality > 0.0;
    if (coding.name == "*") by_star = coding.quality > 0.0;
  }
  return by_star;
}

std::optional<std::string> content_type_fault(std::string_view content_type) {
  const auto parts = split(content_type, ';');
  const std::string type = parts.empty() ? std::string() : lower_case(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string parameter = lower_case(parts[i]);
    if (parameter.starts_with("charset=") && parameter != "charset=utf-8" &&
        parameter != "charset=\"utf-8\"" && parameter != "charset=us-ascii") {
      return "JSON must be encoded in UTF-8: send 'Content-Type: application/json'.";
    }
  }
  if (type.empty()) return "The body has no Content-Type: send 'Content-Type: application/json'.";
  if (type == "application/json" || type.ends_with("+json")) return std::nullopt;
  if (type == "application/x-www-form-urlencoded") {
    return "The body is declared a web form, as 'curl -d' does: use 'curl --json', or add "
           "-H 'Content-Type: application/json'.";
  }
  return std::string("The body is declared ") + in_quotes(type) + ": send 'Content-Type: application/json'.";
}

ContentCoding content_coding(std::string_view content_encoding) {
  const std::string coding = lower_case(trimmed(content_encoding));
  if (coding.empty() || coding == "identity") return ContentCoding::identity;
  if (coding == "gzip" || coding == "x-gzip") return ContentCoding::gzip;
  return ContentCoding::unknown;
}

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

  /// Returns the next decoded bytes, valid until the next call. Empty at the end, if the rest is not valid,
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

#include "server/http/guard/body_reader.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>
#include <utility>

namespace fleetplan::server {

namespace {

/// A body that arrives more slowly falls behind; the `patience` limits how far.
constexpr std::size_t kLeastBytesPerMs = 100;
constexpr std::size_t kMaxChunkLine = 4096;
constexpr std::size_t kMaxTrailerLines = 100;
constexpr std::size_t kMaxSizeDigits = 16;
/// Of all chunks of a body. Extensions are read, but do not count towards the limit of the body.
constexpr std::uint64_t kMaxExtensionBytes = 64 * 1024;

BodyFault malformed(std::string detail) { return {BodyFault::Kind::malformed, std::move(detail)}; }

BodyFault too_large(const std::string& size, std::uint64_t limit) {
  return {BodyFault::Kind::too_large,
          std::string("The body has ") + size + " bytes; the limit is " + std::to_string(limit) + "."};
}

/// Input of one body from a socket, against a slow client.
class Source {
 public:
  Source(Socket& socket, std::string& input, BodyMemory::Share& share, std::chrono::milliseconds patience)
      : socket_(socket), input_(input), share_(share), patience_(patience), begin_(Socket::Clock::now()) {}
  /// The rest stays in the input.
  ~Source() { drop_taken(); }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Moves `count` bytes to `body`; false when they do not arrive or there is no room.
  bool take(std::uint64_t count, std::string& body) {
    while (count > 0) {
      if (taken_ == input_.size() && !more()) return false;
      const auto part = std::min<std::uint64_t>(count, input_.size() - taken_);
      has_room_ = share_.grow_to(body.size() + part);
      if (!has_room_) return false;
      body.append(input_, taken_, part);
      taken_ += part;
      count -= part;
    }
    return true;
  }

  /// A line without its CR LF, valid until more is taken; none when it does not arrive or is too long.
  std::optional<std::string_view> take_line() {
    std::size_t end = 0;
    while ((end = input_.find("\r\n", taken_)) == std::string::npos) {
      if (input_.size() - taken_ > kMaxChunkLine || !more()) return std::nullopt;
    }
    const auto line = std::string_view(input_).substr(taken_, end - taken_);
    taken_ = end + 2;
    return line;
  }

  /// Why something could not be taken.
  BodyFault fault() const {
    if (!has_room_) {
      return {BodyFault::Kind::no_room, BodyMemory::kFull};
    }
    switch (last_) {
      case Socket::Read::timeout:
        return {BodyFault::Kind::too_slow,
                "The body did not arrive in time: it may pause for " + std::to_string(patience_.count()) +
                    " ms and fall as far behind " + std::to_string(kLeastBytesPerMs) + " kB/s."};
      case Socket::Read::stopped:
        return {BodyFault::Kind::stopped, "The service is shutting down: try another replica."};
      case Socket::Read::end:
        return malformed("The body ended early.");
      case Socket::Read::some:
        break;
    }
    return malformed("A line between two chunks is too long.");
  }

 private:
  /// False when there is no more input, or none in time.
  bool more() {
    drop_taken();
    const std::size_t before = input_.size();
    const auto whole = begin_ + std::chrono::milliseconds(received_ / kLeastBytesPerMs);
    last_ = socket_.read_some(input_, std::min(whole, Socket::Clock::now()) + patience_);
    if (last_ != Socket::Read::some) return false;
    received_ += input_.size() - before;
    return true;
  }

  void drop_taken() {
    input_.erase(0, taken_);
    taken_ = 0;
  }

  Socket& socket_;
  std::string& input_;
  BodyMemory::Share& share_;
  bool has_room_ = true;
  std::size_t taken_ = 0;  // of the input; dropped together, as many small pieces may be taken from it
  std::chrono::milliseconds patience_;
  Socket::Clock::time_point begin_;
  Socket::Read last_ = Socket::Read::some;
  std::size_t received_ = 0;  // bytes, chunk sizes included
};

std::optional<std::uint64_t> parse_chunk_size(std::string_view line) {
  std::uint64_t size = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), size, 16);
  if (error != std::errc{}) return std::nullopt;
  const bool at_end = end == line.data() + line.size() || *end == ';' || *end == ' ' || *end == '\t';
  return at_end ? std::optional(size) : std::nullopt;
}

std::variant<std::string, BodyFault> read_chunked(Source& source, std::uint64_t limit) {
  std::string body;
  std::uint64_t extensions = 0;
  while (true) {
    const auto line = source.take_line();
    if (!line) return source.fault();
    const auto size = parse_chunk_size(*line);
    if (!size) return malformed("A chunk does not begin with its size in hexadecimal.");
    extensions += line->size() > kMaxSizeDigits ? line->size() : 0;
    if (extensions > kMaxExtensionBytes) return malformed("The chunks have too many extensions.");
    if (*size == 0) break;
    if (*size > limit - body.size()) {
      const auto read = static_cast<std::uint64_t>(body.size());
      const auto at_least = read + std::min(*size, std::numeric_limits<std::uint64_t>::max() - read);
      return too_large("at least " + std::to_string(at_least), limit);
    }
    if (!source.take(*size, body)) return source.fault();
    const auto rest = source.take_line();
    if (!rest) return source.fault();
    if (!rest->empty()) return malformed("A chunk is longer than its declared size.");
  }
  for (std::size_t lines = 0; lines <= kMaxTrailerLines; ++lines) {
    const auto line = source.take_line();
    if (!line) return source.fault();
    if (line->empty()) return body;
  }
  return malformed("The body has too many trailers.");
}

}  // namespace

std::variant<std::string, BodyFault> read_body(Socket& socket, std::string& input, const RequestHead& head,
                                               std::uint64_t limit, BodyMemory::Share& share,
                                               std::chrono::milliseconds patience) {
  Source source(socket, input, share, patience);
  if (head.chunked) return read_chunked(source, limit);
  const std::uint64_t length = head.content_length.value_or(0);
  if (length > limit) return too_large(std::to_string(length), limit);
  std::string body;
  body.reserve(std::min<std::uint64_t>(length, 1 << 20));  // a promise alone buys no memory
  if (!source.take(length, body)) return source.fault();
  return body;
}

}  // namespace fleetplan::server

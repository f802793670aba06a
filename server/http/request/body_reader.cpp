#include "server/http/request/body_reader.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <new>
#include <utility>

#include "server/http/request/request_head.h"

namespace fleetplan::server {

namespace {

/// The bytes that are reserved at a time, so that a body that arrives in small pieces does not reserve each.
constexpr std::int64_t kStep = 256 * 1024;
constexpr std::int64_t kSmallStep = 4 * 1024;

std::int64_t in_steps(std::int64_t bytes, std::int64_t step) { return (bytes + step - 1) / step * step; }

bool take(std::atomic<std::int64_t>& from, std::int64_t bytes) {
  std::int64_t left = from;
  do {
    if (left < bytes) return false;
  } while (!from.compare_exchange_weak(left, left - bytes));
  return true;
}

}  // namespace

BodyMemory::BodyMemory(std::uint64_t max_body, std::size_t requests, std::size_t small)
    : left_(in_steps(static_cast<std::int64_t>(max_body), kStep) * static_cast<std::int64_t>(requests + 1)),
      small_left_(static_cast<std::int64_t>(kSmall) * static_cast<std::int64_t>(small)) {}

BodyMemory::Share::~Share() {
  memory_.left_ += held_;
  memory_.small_left_ += held_small_;
}

bool BodyMemory::Share::grow_to(std::uint64_t bytes) {
  const bool is_small = bytes <= kSmall;
  std::int64_t& held = is_small ? held_small_ : held_;
  const auto wanted = static_cast<std::int64_t>(bytes);
  if (wanted <= held) return true;
  const std::int64_t more = in_steps(wanted - held, is_small ? kSmallStep : kStep);
  if (!take(is_small ? memory_.small_left_ : memory_.left_, more)) return false;
  held += more;
  return true;
}

namespace {

constexpr std::size_t kMaxSizeDigits = 16;

void skip_blanks(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

bool skip(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

bool skip_token(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_token_char);
  const auto size = static_cast<std::size_t>(end - text.begin());
  text.remove_prefix(size);
  return size > 0;
}

/// Skips a quoted string after its opening quote, the closing one included.
bool skip_quoted(std::string_view& text) {
  while (!text.empty()) {
    const char c = text.front();
    text.remove_prefix(1);
    if (c == '"') return true;
    if (c == '\\') {
      if (text.empty() || !is_field_value_char(text.front())) return false;
      text.remove_prefix(1);
    } else if (!is_field_value_char(c)) {
      return false;
    }
  }
  return false;
}

bool skip_extension(std::string_view& text) {
  skip_blanks(text);
  if (!skip(text, ';')) return false;
  skip_blanks(text);
  if (!skip_token(text)) return false;
  auto value = text;
  skip_blanks(value);
  if (!skip(value, '=')) return true;
  skip_blanks(value);
  const bool valid = skip(value, '"') ? skip_quoted(value) : skip_token(value);
  text = value;
  return valid;
}

}  // namespace

std::optional<ChunkLine> parse_chunk_line(std::string_view line) {
  ChunkLine chunk{};
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), chunk.size, 16);
  const auto digits = static_cast<std::size_t>(end - line.data());
  if (error != std::errc{} || digits > kMaxSizeDigits) return std::nullopt;
  line.remove_prefix(digits);
  chunk.extension_bytes = line.size();
  while (!line.empty()) {
    if (!skip_extension(line)) return std::nullopt;
  }
  return chunk;
}

namespace {

constexpr std::size_t kMaxLine = 4096;
constexpr std::size_t kMaxTrailers = 100;
/// The most bytes of extensions of all chunks of a body. They are read, but do not count towards the limit of
/// the body.
constexpr std::uint64_t kMaxExtensionBytes = 64 * 1024;
/// The most bytes that are reserved for a promised body; a promise alone gets no more memory.
constexpr std::uint64_t kMaxReserved = 64 * 1024;

}  // namespace

api::ErrorCode code_of(BodyFault::Kind kind) {
  switch (kind) {
    case BodyFault::Kind::too_large:
      return api::ErrorCode::body_too_large;
    case BodyFault::Kind::no_room:
      return api::ErrorCode::overloaded;
    case BodyFault::Kind::too_slow:
      return api::ErrorCode::request_timeout;
    case BodyFault::Kind::stopped:
      return api::ErrorCode::draining;
    case BodyFault::Kind::malformed:
      break;
  }
  return api::ErrorCode::malformed_request;
}

BodyFault malformed_body(std::string detail) { return {BodyFault::Kind::malformed, std::move(detail)}; }

BodyFault too_large_body(const std::string& size, std::uint64_t limit) {
  return {BodyFault::Kind::too_large, api::too_large_body_detail(size, limit)};
}

BodyReader::BodyReader(const RequestHead& head, std::uint64_t limit, BodyMemory::Share* share)
    : chunked_(head.chunked),
      limit_(limit),
      share_(share),
      part_(chunked_ ? Part::size_line : Part::data),
      left_(chunked_ ? 0 : head.content_length.value_or(0)) {
  if (share_ != nullptr) body_.reserve(std::min(left_, kMaxReserved));
}

BodyReader::State BodyReader::take(std::string& input) {
  if (!chunked_ && left_ + size_ > limit_) {
    return fail(too_large_body(std::to_string(left_ + size_), limit_));
  }
  const State state = take_parts(input);
  input.erase(0, std::exchange(taken_, 0));
  return state;
}

BodyReader::State BodyReader::fail(BodyFault fault) {
  fault_ = std::move(fault);
  return State::failed;
}

BodyReader::State BodyReader::take_parts(std::string_view input) {
  while (part_ != Part::end) {
    const State state = part_ == Part::data ? take_data(input) : take_line(input);
    if (state != State::complete) return state;
  }
  return State::complete;
}

BodyReader::State BodyReader::take_data(std::string_view input) {
  const auto size = std::min<std::uint64_t>(left_, input.size() - taken_);
  if (share_ != nullptr) {
    if (!share_->grow_to(size_ + size)) return fail({BodyFault::Kind::no_room, BodyMemory::kFull});
    try {
      body_.append(input, taken_, size);
    } catch (const std::bad_alloc&) {
      return fail({BodyFault::Kind::no_room, BodyMemory::kFull});
    }
  }
  taken_ += size;
  size_ += size;
  left_ -= size;
  if (left_ > 0) return State::incomplete;
  part_ = chunked_ ? Part::data_end : Part::end;
  return State::complete;
}

BodyReader::State BodyReader::take_line(std::string_view input) {
  const auto end = input.find('\n', taken_);
  if (std::min(end, input.size()) - taken_ > kMaxLine) {
    return fail(malformed_body("A line between two chunks is too long."));
  }
  if (end == std::string_view::npos) return State::incomplete;
  if (end == taken_ || input[end - 1] != '\r') {
    return fail(malformed_body("The lines between the chunks of a body must end in CR LF."));
  }
  const auto line = input.substr(taken_, end - 1 - taken_);
  taken_ = end + 1;
  if (part_ == Part::size_line) return begin_chunk(line);
  if (part_ == Part::trailers) return take_trailer(line);
  if (!line.empty()) return fail(malformed_body("A chunk is longer than its declared size."));
  part_ = Part::size_line;
  return State::complete;
}

BodyReader::State BodyReader::begin_chunk(std::string_view line) {
  const auto chunk = parse_chunk_line(line);
  if (!chunk) {
    return fail(malformed_body("A chunk does not begin with its size in hexadecimal and valid extensions."));
  }
  extensions_ += chunk->extension_bytes;
  if (extensions_ > kMaxExtensionBytes) return fail(malformed_body("The chunks have too many extensions."));
  if (chunk->size > limit_ - size_) {
    const auto at_least = size_ + std::min(chunk->size, std::numeric_limits<std::uint64_t>::max() - size_);
    return fail(too_large_body("at least " + std::to_string(at_least), limit_));
  }
  left_ = chunk->size;
  part_ = left_ > 0 ? Part::data : Part::trailers;
  return State::complete;
}

BodyReader::State BodyReader::take_trailer(std::string_view line) {
  if (line.empty()) {
    part_ = Part::end;
    return State::complete;
  }
  if (++trailers_ > kMaxTrailers) return fail(malformed_body("The body has too many trailers."));
  if (is_field_line(line)) return State::complete;
  return fail(malformed_body("A trailer of the body is not of the form 'name: value'."));
}

}  // namespace fleetplan::server

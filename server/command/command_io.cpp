#include "server/command/command_io.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <istream>
#include <ostream>

namespace fleetplan::server {

InputFault input_fault(const std::string& file, std::size_t line, const std::string& detail) {
  return {shown_name(file) + ':' + (line > 0 ? std::to_string(line) + ':' : "") + ' ' + detail};
}

api::Result<std::string, InputFault> read_file(const std::string& name, std::istream& in, std::size_t most) {
  std::ifstream file;
  if (name != "-") file.open(name, std::ios::binary);
  std::istream& source = name == "-" ? in : file;
  if (name != "-" && !file.is_open()) return input_fault(name, 0, "cannot read the file; does it exist?");
  std::string text;
  std::array<char, std::size_t{1} << 16> part{};
  while (source && text.size() <= most) {
    source.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(source.gcount()));
  }
  if (source.bad()) return input_fault(name, 0, "cannot read the file; is it a folder?");
  if (text.size() > most) {
    return input_fault(name, 0, "the file has more than " + std::to_string(most) + " bytes.");
  }
  return text;
}

std::string shown_name(const std::string& file) { return file == "-" ? "stdin" : file; }

bool write_file(const std::string& name, const std::string& text) {
  std::ofstream file(name, std::ios::binary);
  file << text;
  file.close();
  return !file.fail();
}

int write_output(const std::string& name, const std::string& text, const Streams& streams) {
  if (name.empty()) {
    streams.out << text << std::flush;
  } else if (!write_file(name, text)) {
    return fail(streams, kFailed, "cannot write " + name);
  }
  return kSolved;
}

int fail(const Streams& streams, int code, const std::string& message) {
  streams.err << "fleetplan: " << message << '\n';
  return code;
}

std::optional<double> read_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

}  // namespace fleetplan::server

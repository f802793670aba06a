#include "server/http/static_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "server/http/text.h"

namespace fleetplan::server {

namespace fs = std::filesystem;

namespace {

std::string content_type_of(const fs::path& file) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".txt", "text/plain; charset=utf-8"},
  }};
  const std::string extension = lower_case(file.extension().string());
  for (const auto& [known, type] : kTypes) {
    if (extension == known) return std::string(type);
  }
  return "application/octet-stream";
}

/// Returns a hash of the content, FNV-1a of 64 bits: it only tells one version of a file from another.
std::string etag_of(std::string_view body) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : body) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  std::string etag(1, '"');
  etag += std::to_string(hash) + '-' + std::to_string(body.size()) + '"';
  return etag;
}

/// Whether the name ends with a content hash as esbuild writes it, such as main-7BDWMQTA.css.
bool has_content_hash(const fs::path& file) {
  constexpr std::size_t kLength = 8;
  const std::string name = file.filename().string();
  const std::string stem = name.substr(0, name.find('.'));
  if (stem.size() <= kLength + 1 || stem[stem.size() - kLength - 1] != '-') return false;
  return std::all_of(stem.end() - kLength, stem.end(),
                     [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '2' && c <= '7'); });
}

bool is_plain_name(std::string_view segment) {
  return !segment.empty() && segment.front() != '.' && segment.find('\\') == std::string_view::npos;
}

}  // namespace

StaticFiles::StaticFiles(const fs::path& root) {
  std::error_code ignored;
  if (!root.empty()) root_ = fs::canonical(root, ignored);
}

std::optional<fs::path> StaticFiles::locate(std::string_view path) const {
  if (!has_root() || !path.starts_with('/')) return std::nullopt;
  path.remove_prefix(1);
  fs::path file = root_;
  if (path.empty()) path = "index.html";
  if (path.ends_with('/')) return std::nullopt;
  while (!path.empty()) {
    const std::string_view segment = path.substr(0, path.find('/'));
    if (!is_plain_name(segment)) return std::nullopt;
    file /= segment;
    path.remove_prefix(std::min(segment.size() + 1, path.size()));
  }
  std::error_code error;
  file = fs::canonical(file, error);
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  const auto [root_end, ignored] = std::mismatch(root_.begin(), root_.end(), file.begin(), file.end());
  if (root_end != root_.end()) return std::nullopt;  // a link led out
  return file;
}

std::optional<StaticFile> StaticFiles::read(std::string_view path) const {
  const auto file = locate(path);
  if (!file) return std::nullopt;
  std::ifstream stream(*file, std::ios::binary);
  if (!stream) return std::nullopt;
  StaticFile found;
  found.body.assign(std::istreambuf_iterator<char>(stream), {});
  found.content_type = content_type_of(*file);
  found.etag = etag_of(found.body);
  found.cache_control = has_content_hash(*file) ? "public, max-age=31536000, immutable" : "no-cache";
  return found;
}

fs::path default_web_root() {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  fs::path installed = executable.parent_path().parent_path() / "share" / "fleetplan" / "web";
  if (!error && fs::is_directory(installed, error)) return installed;
  return fs::is_directory(FLEETPLAN_BUILT_WEB, error) ? fs::path(FLEETPLAN_BUILT_WEB) : fs::path();
}

}  // namespace fleetplan::server

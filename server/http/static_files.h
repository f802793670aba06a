#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::server {

/// A file of the page, ready to send.
struct StaticFile {
  std::string content_type;
  std::string body;
  std::string etag;  // strong, with its quotes
};

/// The files below one folder, and nothing else: no listings, no hidden files, no way out by `..` or a link.
class StaticFiles {
 public:
  /// An empty root has no files.
  explicit StaticFiles(const std::filesystem::path& root);

  bool has_root() const { return !root_.empty(); }

  /// `path`: decoded, beginning with '/'; "/" is index.html. Read anew each time, so that a page may change
  /// under a running server.
  std::optional<StaticFile> read(std::string_view path) const;

  bool contains(std::string_view path) const { return locate(path).has_value(); }

 private:
  std::optional<std::filesystem::path> locate(std::string_view path) const;

  std::filesystem::path root_;  // canonical
};

/// Where the page is when no setting says so: the source's `web`, as known when built, if it exists; else
/// ../share/fleetplan/web beside the executable; else nowhere (empty).
std::filesystem::path default_web_root();

}  // namespace fleetplan::server

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
  std::string etag;           // strong, with its quotes
  std::string cache_control;  // for a year if its name has a hash of its content, else to be revalidated
};

/// The files below one folder, and nothing else: no listings, no hidden files, no way out by `..` or a link.
class StaticFiles {
 public:
  /// Serves the files below `root`; an empty root has none.
  explicit StaticFiles(const std::filesystem::path& root);

  bool has_root() const { return !root_.empty(); }

  /// Reads a file. `path` is decoded and begins with '/'; "/" is index.html. Files are read anew each time,
  /// so the page may change under a running server.
  std::optional<StaticFile> read(std::string_view path) const;

  bool contains(std::string_view path) const { return locate(path).has_value(); }

 private:
  std::optional<std::filesystem::path> locate(std::string_view path) const;

  std::filesystem::path root_;  // canonical
};

/// Returns the folder of the page when no setting names one. It is the first of these that exists:
///
/// - ../share/fleetplan/web beside the executable,
/// - the page that was built with this program.
///
/// Empty if there is neither.
std::filesystem::path default_web_root();

}  // namespace fleetplan::server

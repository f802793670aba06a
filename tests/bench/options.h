#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace fleetplan::bench {

/// What to measure, and where to write it.
struct Options {
  std::vector<std::string> inputs;  // files and folders; none: the paper's halls
  std::vector<std::string> halls;   // "empty", "rects"
  std::vector<std::uint64_t> seeds;
  std::vector<std::size_t> robots;                     // none: all of a file, or as many as the reference has
  double budget = 60.0;                                // seconds for a plan
  nlohmann::json planning = nlohmann::json::object();  // options of the requests, over their own
  int repeats = 1;
  bool scaling = false;
  std::string csv;  // files to write; empty: none
  std::string svg;
  std::string reference;  // results to compare with; empty: none
  std::string root;       // folder that the files of the reference are relative to
};

/// Why not to go on: help (code 0) or a mistake (2), with what to print.
struct Exit {
  int code = 0;
  std::string text;
};

std::variant<Options, Exit> parse_options(std::vector<std::string> arguments);

/// Whole numbers separated by commas, and ranges "1-5" and "15-300:15" with their step; none for anything
/// else.
std::optional<std::vector<std::uint64_t>> parse_numbers(const std::string& text);

}  // namespace fleetplan::bench

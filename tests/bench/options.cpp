#include "tests/bench/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "tests/bench/paper_claims.h"

namespace fleetplan::bench {
namespace {

using nlohmann::json;

constexpr const char* kQuickSeeds = "1-3";
constexpr const char* kQuickRobots = "60-300:60";
constexpr const char* kFullSeeds = "1-100";

/// Longer lists are mistakes.
constexpr std::uint64_t kMostNumbers = 100'000;

std::string full_robots() {
  return std::to_string(kFewestRobots) + "-" + std::to_string(kMostRobots) + ":" +
         std::to_string(kRobotsStep);
}

/// One natural number from the front of `text`, which loses it.
std::optional<std::uint64_t> take_number(std::string_view& text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

Exit mistake(const std::string& message) {
  return {2, message + "\nRun with --help for more information.\n"};
}

/// Flags, and the values that do not fit Options as they are.
class Flags {
 public:
  Flags()
      : app_(
            "Measures the planner, in process: parse, plan, verify and write, as POST /v1/plan does.\n"
            "Without files: the two workloads of the AA-SIPP(m) paper (ECMR 2019), made by seed.",
            "fleetplan_bench") {
    app_.get_formatter()->column_width(30);
    app_.add_option("FILE", options_.inputs, "Request files, or folders of them (at any depth)");
    app_.add_flag("--full", full_,
                  "The paper's whole protocol: seeds 1-100, 15 to 300 robots in steps of 15");
    app_.add_flag("--scaling", options_.scaling, "Tables of time against robots and against the map's size");
    app_.add_option("--halls", options_.halls, "Of the paper: empty, rects, or both")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"empty", "rects"}));
    app_.add_option("--seeds", seeds_, std::string("Of the workloads, as 1-3,7; default ") + kQuickSeeds);
    app_.add_option(
        "--robots", robots_,
        std::string("Take the first so many, as 60,100-300:50; default ") + kQuickRobots + ", of a file all");
    app_.add_option("--budget", options_.budget, "Seconds for a plan")
        ->check(CLI::Range(0.001, 86'400.0))
        ->capture_default_str();
    app_.add_option("--mode", mode_, "first solution, or anytime: improve until the budget is spent")
        ->check(CLI::IsMember({"first", "anytime"}));
    app_.add_option("--options", planning_, "More options of the requests, as {\"connectivity\": 4}");
    app_.add_option("--repeat", options_.repeats, "Plan everything so often and take the median time")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app_.add_option(
            "--output", output_,
            "Folder to write to: every run to a CSV file, and the paper's workloads drawn to paper.svg")
        ->take_last();
    app_.add_option("--csv", options_.csv, "Write every run to this file instead");
    app_.add_option("--svg", options_.svg, "Draw the paper's workloads to this file instead");
    app_.add_option("--reference", options_.reference,
                    "Compare with a CSV of file,robots,solved,attempts,seconds,flowtime,makespan;\n"
                    "without files: run the files it names");
    app_.add_option("--root", options_.root, "Folder of the reference's files, by default its own");
  }

  std::variant<Options, Exit> parse(std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    try {
      app_.parse(std::move(arguments));
    } catch (const CLI::ParseError& error) {
      std::ostringstream text;
      const int code = app_.exit(error, text, text);
      return Exit{code == 0 ? 0 : 2, text.str()};
    }
    return finish();
  }

 private:
  std::variant<Options, Exit> finish() {
    if (options_.halls.empty()) options_.halls = {"empty", "rects"};
    const bool own_workloads = options_.inputs.empty() && options_.reference.empty();
    if (seeds_.empty()) seeds_ = full_ ? kFullSeeds : kQuickSeeds;
    if (robots_.empty() && own_workloads) robots_ = full_ ? full_robots() : kQuickRobots;
    const auto seeds = parse_numbers(seeds_);
    if (!seeds) return mistake("--seeds: '" + seeds_ + "' are no numbers");
    options_.seeds = *seeds;
    if (!robots_.empty()) {
      const auto robots = parse_numbers(robots_);
      if (!robots || std::count(robots->begin(), robots->end(), 0u) > 0)
        return mistake("--robots: '" + robots_ + "' are no numbers of robots");
      options_.robots.assign(robots->begin(), robots->end());
    }
    if (!planning_.empty()) {
      options_.planning = json::parse(planning_, nullptr, false);
      if (!options_.planning.is_object()) return mistake("--options: '" + planning_ + "' is no JSON object");
    }
    options_.planning["time_budget_ms"] = std::ceil(options_.budget * 1000.0);
    if (!mode_.empty()) options_.planning["mode"] = mode_;
    if (!output_.empty()) name_outputs();
    if (options_.root.empty())
      options_.root = std::filesystem::path(options_.reference).parent_path().string();
    if (options_.root.empty()) options_.root = ".";
    return options_;
  }

  void name_outputs() {
    const std::filesystem::path folder = output_;
    std::string name = "paper";
    if (options_.scaling) {
      name = "scaling";
    } else if (!options_.reference.empty()) {
      name = "comparison";
    } else if (!options_.inputs.empty()) {
      name = "files";
    }
    if (options_.csv.empty()) options_.csv = (folder / (name + ".csv")).string();
    if (options_.svg.empty()) options_.svg = (folder / (name + ".svg")).string();
  }

  CLI::App app_;
  Options options_;
  bool full_ = false;
  std::string output_;
  std::string seeds_;
  std::string robots_;
  std::string mode_;
  std::string planning_;
};

}  // namespace

std::variant<Options, Exit> parse_options(std::vector<std::string> arguments) {
  return Flags().parse(std::move(arguments));
}

std::optional<std::vector<std::uint64_t>> parse_numbers(const std::string& text) {
  std::vector<std::uint64_t> numbers;
  std::string_view rest = text;
  do {
    const auto first = take_number(rest);
    if (!first) return std::nullopt;
    std::uint64_t last = *first;
    std::uint64_t step = 1;
    if (take(rest, '-')) {
      const auto end = take_number(rest);
      const auto by = end && take(rest, ':') ? take_number(rest) : std::optional<std::uint64_t>(1);
      if (!end || !by || *by == 0 || *end < *first || (*end - *first) / *by > kMostNumbers)
        return std::nullopt;
      last = *end;
      step = *by;
    }
    for (std::uint64_t count = 0; count <= (last - *first) / step; ++count)
      numbers.push_back(*first + count * step);
  } while (take(rest, ','));
  if (!rest.empty()) return std::nullopt;
  return numbers;
}

}  // namespace fleetplan::bench

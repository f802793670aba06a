// Requests of up to 2000 robots, 300,000 cells and extreme ranges, with small budgets of steps and memory.
// However little there is of them, the answer is a verified plan or a well-formed rejection, and it comes
// soon after the budget is spent. Time is measured by the steps of StopCondition, which are the same on every
// machine.

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "api/endpoints/plan_endpoint.h"
#include "core/runtime/stop_condition.h"
#include "tests/fuzz/refusals.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/target.h"

namespace fleetplan::fuzz {

namespace {

using Json = nlohmann::json;

/// Choices made by the bytes of an input; zeros after its end.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  int byte() {
    if (bytes_.empty()) return 0;
    const int value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  /// 0 to `most`, small numbers more often.
  int up_to(int most) {
    const int share = byte();
    return static_cast<int>(static_cast<std::int64_t>(share) * share * most / (255 * 255));
  }
  bool yes() { return byte() % 2 == 1; }
  template <class T, std::size_t N>
  T one_of(const std::array<T, N>& values) {
    return values[static_cast<std::size_t>(byte()) % N];
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

struct Effort {
  std::string body;
  std::size_t robots = 0;
  std::int64_t steps = 0;  // until the time is up
  std::size_t memory = 0;  // bytes
};

/// Rows of free cells with walls that leave gaps.
Json rows_of(int columns, int rows, Choices& choices) {
  const int wall_every = 2 + choices.up_to(60);
  const int gap = 1 + choices.up_to(20);
  const bool has_walls = choices.yes();
  Json lines = Json::array();
  for (int row = 0; row < rows; ++row) {
    std::string line(static_cast<std::size_t>(columns), '.');
    if (has_walls && row % wall_every == wall_every - 1) {
      for (int column = 0; column < columns; ++column) {
        if ((column + row / wall_every) % (4 * gap) >= gap) line[static_cast<std::size_t>(column)] = '#';
      }
    }
    lines.push_back(line);
  }
  return lines;
}

/// The centres of every so many free cells.
std::vector<Json> places_of(const Json& lines, int distance, double resolution) {
  std::vector<Json> places;
  const int rows = static_cast<int>(lines.size());
  for (int row = 0; row < rows; row += distance) {
    const auto& line = lines[static_cast<std::size_t>(row)].get_ref<const std::string&>();
    for (int column = 0; column < static_cast<int>(line.size()); column += distance) {
      if (line[static_cast<std::size_t>(column)] == '#') continue;
      places.push_back({{"x", (column + 0.5) * resolution}, {"y", (rows - row - 0.5) * resolution}});
    }
  }
  return places;
}

/// Robots at a distance from each other. The goal of each is the start of another one, or a place further on.
Json robots_of(int count, const Json& lines, double resolution, Choices& choices) {
  const std::vector<Json> places = places_of(lines, 1 + choices.up_to(20), resolution);
  const int most = static_cast<int>(places.size());
  const int shift = choices.up_to(most);
  const int parked_every = 1 + choices.byte();
  const std::string padding(choices.one_of(std::array<std::size_t, 3>{0, 30, 250}), 'x');
  Json robots = Json::array();
  for (int k = 0; k < std::min(count, most); ++k) {
    Json robot{{"id", std::to_string(k) + padding}, {"start", places[static_cast<std::size_t>(k)]}};
    if (k % parked_every != parked_every - 1) {
      robot["goal"] = places[static_cast<std::size_t>((k + shift) % most)];
    }
    robots.push_back(robot);
  }
  return robots;
}

Effort effort_of(Choices choices) {
  const int columns = 1 + choices.up_to(600);
  const int rows = 1 + choices.up_to(500);
  const auto resolution = choices.one_of(std::array{1.0, 0.05, 1e-3, 1000.0});
  const auto radius = resolution * choices.one_of(std::array{0.3, 0.5, 0.49999, 1e-6, 3.0});
  const Json lines = rows_of(columns, rows, choices);
  const int robots = 1 + choices.up_to(1999);
  Json request{
      {"map", {{"rows", lines}, {"resolution", resolution}}},
      {"robots", robots_of(robots, lines, resolution, choices)},
      {"robot_defaults",
       {{"radius", radius},
        {"linear_speed", choices.one_of(std::array{1.0, 1e-3, 1e3})},
        {"angular_speed", choices.one_of(std::array{1.0, 1e-3, 1e6})}}},
      {"options",
       {{"time_budget_ms", 100'000},
        {"mode", choices.yes() ? "anytime" : "first"},
        {"max_iterations", 40},
        {"reordering", choices.one_of(std::array{"raise_failed", "random", "none"})},
        {"inflation", resolution * choices.one_of(std::array{0.0, 0.01, 0.9, 10.0})},
        {"start_safe_interval", choices.one_of(std::array{3.0, 0.0, 1000.0})},
        {"wait_before_move", choices.one_of(std::array{0.0, 1.0})}}},
  };
  const std::int64_t steps = choices.up_to(3000);
  const std::size_t memory = static_cast<std::size_t>(1 + choices.up_to(63)) << 20;
  return {request.dump(), request["robots"].size(), steps, memory};
}

/// Steps after the last one of the time: each robot may be asked about a few times, and each loop ends.
std::int64_t allowed_lateness(std::size_t robots) { return 500 + 16 * static_cast<std::int64_t>(robots); }

/// All that an answer has for each robot besides its actions.
std::size_t allowed_size(const Json& answer, std::size_t request) {
  std::size_t actions = 0;
  for (const Json& plan : answer.at("plans")) actions += plan.at("actions").size();
  return 4096 + 64 * request + 1024 * actions;
}

void check(const Effort& effort) {
  api::RequestContext context;
  context.request_id = "id";
  context.limits.max_plan_memory = effort.memory;
  core::StepClock& clock = core::step_clock;
  clock = {0, effort.steps};
  const api::Reply reply = api::plan_endpoint(effort.body, context);
  const std::int64_t late = clock.steps - effort.steps;
  clock = {};
  require(late <= allowed_lateness(effort.robots), "an answer is late", std::to_string(late));
  if (reply.status != 200) return require_proper_refusal(effort.body, reply);
  const Json answer = Json::parse(reply.body, nullptr, false);
  require(answer.is_object(), "an answer is not JSON", reply.body);
  require(answer.at("verified") == true, "an answer is not verified", reply.body);
  require(answer.at("plans").size() + answer.at("unplanned").size() == effort.robots,
          "an answer has other robots than its request", reply.body);
  require(reply.body.size() <= allowed_size(answer, effort.body.size()),
          "an answer is not linear in its request", std::to_string(reply.body.size()));
}

}  // namespace

}  // namespace fleetplan::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetplan::fuzz;
  check(effort_of(Choices({data, size})));
  return 0;
}

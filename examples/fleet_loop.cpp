// Keeps two robots busy in the way of a fleet manager: plan, drive for a while, advance, plan again. It asks
// what the service answers, in its own process, without a server.
//
//   cmake -S examples -B build/examples && cmake --build build/examples && build/examples/fleet_loop

#include <fleetplan/service.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

namespace {

using fleetplan::Endpoint;

// A corridor with a passing bay; lengths in metres, times in seconds.
constexpr const char* kRequest = R"({
  "map": {"resolution": 1.0, "rows": ["####.####", "........."]},
  "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
  "robots": [
    {"id": "amr-1", "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 8.5, "y": 0.5}},
    {"id": "amr-2", "start": {"x": 8.5, "y": 0.5, "theta": 3.14159265}, "goal": {"x": 0.5, "y": 0.5}}],
  "options": {"time_budget_ms": 2000}})";

constexpr double kPeriod = 2.0;       // from plan to plan
constexpr double kNewOrderAt = 10.0;  // then amr-1 is sent back, into the passing bay
constexpr const char* kNewOrder = R"("goals": [{"robot": "amr-1", "goals": [{"x": 4.5, "y": 1.5}]}])";

/// Returns the end of the string, list, object, number or word of an answer that begins at `at`.
std::size_t end_of_value(const std::string& json, std::size_t at) {
  int depth = 0;
  for (bool in_string = false; at < json.size(); ++at) {
    const char c = json[at];
    if (in_string) {
      if (c == '\\') ++at;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if (depth == 0 && (c == ',' || c == '}' || c == ']')) {
      break;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return at;
}

/// Returns the text of a member of an answer. A program that reads more than this has a library for JSON.
std::string member(const std::string& answer, const std::string& name) {
  for (std::size_t at = 1; at < answer.size();) {
    const std::size_t colon = answer.find("\":", at);
    if (colon == std::string::npos) break;
    const std::size_t end = end_of_value(answer, colon + 2);
    if (answer.compare(at + 1, colon - at - 1, name) == 0) return answer.substr(colon + 2, end - colon - 2);
    at = end + 1;
  }
  throw std::runtime_error("the answer has no " + name);
}

/// Returns the body of an answer. Throws what is wrong with the request.
std::string asked(Endpoint endpoint, const std::string& body) {
  fleetplan::Answer answer = fleetplan::answer(endpoint, body);
  if (!answer.ok()) throw std::runtime_error(answer.body);
  return answer.body;
}

void loop() {
  std::string request = kRequest;
  for (double now = 0.0; now < 60.0; now += kPeriod) {
    const std::string plan = asked(Endpoint::plan, request);
    const double makespan = std::strtod(member(plan, "makespan").c_str(), nullptr);
    std::printf("%4.1f s: %s, %.2f s to go\n", now, member(plan, "status").c_str(), makespan);
    if (makespan == 0.0) return;

    // The robots drive. A real fleet tells where they are, too: "states" or "poses".
    std::string moment = R"({"request": )" + request + R"(, "plans": )" + member(plan, "plans");
    moment += R"(, "at": )" + std::to_string(kPeriod) + R"(, "commit": 0.5)";
    if (now + kPeriod == kNewOrderAt) moment += std::string(", ") + kNewOrder;
    request = asked(Endpoint::advance, moment + "}");
  }
  throw std::runtime_error("the robots do not arrive");
}

}  // namespace

int main() {
  try {
    loop();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  std::puts("everybody has arrived");
}

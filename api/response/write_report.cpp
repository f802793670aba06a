#include <algorithm>
#include <string_view>

#include "api/json/json_writer.h"
#include "api/response/write_response.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::api {

namespace {

constexpr std::size_t kMostWritten = 20;

std::string_view kind_name(core::Violation::Kind kind) {
  switch (kind) {
    case core::Violation::Kind::robot_collision:
      return "robot_collision";
    case core::Violation::Kind::obstacle_collision:
      return "obstacle_collision";
    case core::Violation::Kind::discontinuity:
      return "discontinuity";
    case core::Violation::Kind::speed:
      return "speed";
    case core::Violation::Kind::profile:
      return "profile";
    case core::Violation::Kind::wrong_start:
      return "wrong_start";
    case core::Violation::Kind::wrong_goal:
      return "wrong_goal";
    case core::Violation::Kind::wrong_visit:
      return "wrong_visit";
    case core::Violation::Kind::committed_changed:
      return "committed_changed";
    case core::Violation::Kind::margin:
      return "margin";
    case core::Violation::Kind::moving_obstacle:
      return "moving_obstacle";
    case core::Violation::Kind::zone:
      break;
  }
  return "zone";
}

}  // namespace

std::optional<double> reported_clearance(const core::VerifyReport& report) {
  if (!report.min_clearance) return std::nullopt;
  const bool contact =
      *report.min_clearance >= -core::kContactTolerance && *report.min_clearance <= core::kSamePosition;
  return contact ? 0.0 : *report.min_clearance;
}

std::string write_report(const core::VerifyReport& report, const std::vector<core::Robot>& robots,
                         const std::vector<core::MovingObstacle>& obstacles,
                         const std::vector<core::Zone>& zones) {
  const std::size_t written = std::min(report.violations.size(), kMostWritten);
  JsonWriter json;
  json.begin_object();
  json.member("valid", report.valid());
  json.key("violations").begin_array();
  // Bounded: at most kMostWritten violations.
  for (std::size_t index = 0; index < written; ++index) {
    const core::Violation& violation = report.violations[index];
    json.begin_object();
    json.member("kind", kind_name(violation.kind));
    json.key("robots").begin_array();
    for (const std::size_t robot : violation.robots) json.value(robots[robot].id);
    json.end_array();
    if (violation.obstacle) json.member("obstacle", obstacles[*violation.obstacle].id);
    if (violation.zone) json.member("zone", zones[*violation.zone].id);
    json.member("t", violation.t).member("distance", violation.distance);
    json.member("required", violation.required).member("detail", violation.detail);
    json.end_object();
  }
  json.end_array();
  json.member("min_clearance", reported_clearance(report));
  json.member("violations_total", report.violation_count);
  if (written < report.violation_count) json.member("truncated", true);
  json.end_object();
  return json.take();
}

}  // namespace fleetplan::api

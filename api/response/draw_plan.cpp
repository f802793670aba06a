#include "api/response/draw_plan.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace fleetplan::api {

namespace {

using core::Pose;
using core::Position;
using core::Robot;

/// Writes the elements of a picture. Its y axis points down, that of the map up.
class Picture {
 public:
  Picture(const core::Problem& problem, const core::StopCondition& stop)
      : problem_(problem), stop_(stop), height_(problem.grid().height()) {
    constexpr double kLongerSide = 1200;  // pixels, at first; a viewer scales it
    const double width = problem.grid().width();
    const double scale = kLongerSide / std::max(width, height_);
    text_ << std::setprecision(6) << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width * scale
          << "\" height=\"" << height_ * scale << "\" viewBox=\"0 0 " << width << ' ' << height_ << "\">\n"
          << "<rect width=\"" << width << "\" height=\"" << height_
          << "\" fill=\"#fff\" stroke=\"#555\" stroke-width=\"" << std::max(width, height_) / 500 << "\"/>\n";
  }

  /// Draws the blocked cells; those beside each other in a row become one rectangle.
  void add_map() {
    const core::OccupancyGrid& grid = problem_.grid();
    const double side = grid.resolution();
    text_ << "<path fill=\"#555\" d=\"";
    for (int row = 0; row < grid.rows() && !stop_.met(); ++row) {
      const auto cells = grid.row(row);
      for (auto begin = std::find(cells.begin(), cells.end(), 1); begin != cells.end();) {
        const auto end = std::find(begin, cells.end(), 0);
        text_ << 'M' << static_cast<double>(begin - cells.begin()) * side << ' ' << height_ - (row + 1) * side
              << 'h' << static_cast<double>(end - begin) * side << 'v' << side << 'H'
              << static_cast<double>(begin - cells.begin()) * side << 'z';
        begin = std::find(end, cells.end(), 1);
      }
    }
    text_ << "\"/>\n";
  }

  void add_zones() {
    for (const core::Zone& zone : problem_.zones()) {
      if (stop_.met()) return;
      const bool is_blocked = zone.type == core::Zone::Type::blocked;
      text_ << "<polygon fill=\"" << (is_blocked ? "#d33" : "#36c") << "\" fill-opacity=\"0.2\" points=\"";
      for (const Position& corner : zone.polygon) add(corner);
      text_ << "\">";
      add_title(zone.id);
      text_ << "</polygon>\n";
    }
  }

  void add_planned(const core::RobotPlan& plan) {
    const Robot& robot = problem_.robots()[plan.robot];
    // Hues go on by the golden angle, so that neighbours in the list differ.
    const double hue = std::fmod(137.508 * static_cast<double>(plan.robot), 360.0);
    std::ostringstream colour;
    colour << "hsl(" << std::setprecision(4) << hue << ",70%,40%)";
    const Pose end = plan.actions.empty() ? robot.start : plan.actions.back().to;
    text_ << "<g stroke=\"" << colour.str() << "\" fill=\"none\" stroke-width=\"" << robot.radius / 6
          << "\">";
    add_title(robot.id);
    add_disk(robot.start.position, robot.radius, "none");
    text_ << "<polyline points=\"";
    add(robot.start.position);
    for (const core::Action& action : plan.actions) {
      if (action.type == core::Action::Type::translate) add(action.to.position);
    }
    text_ << "\"/>";
    add_standing(end, robot.radius, colour.str());
    text_ << "</g>\n";
  }

  void add_unplanned(const Robot& robot) {
    text_ << "<g stroke=\"#888\" fill=\"none\" stroke-width=\"" << robot.radius / 6 << "\">";
    add_title(robot.id + " has no plan");
    add_standing(robot.committed_end(), robot.radius, "#bbb");
    text_ << "</g>\n";
  }

  std::string take() {
    text_ << "</svg>\n";
    return text_.str();
  }

 private:
  void add(const Position& position) { text_ << position.x() << ',' << height_ - position.y() << ' '; }

  void add_disk(const Position& centre, double radius, const std::string& fill) {
    text_ << "<circle cx=\"" << centre.x() << "\" cy=\"" << height_ - centre.y() << "\" r=\"" << radius
          << "\" fill=\"" << fill << "\"/>";
  }

  /// Draws a disk with a line from its centre in the direction of its heading.
  void add_standing(const Pose& pose, double radius, const std::string& fill) {
    add_disk(pose.position, radius, fill);
    text_ << "<path stroke=\"#fff\" d=\"M" << pose.position.x() << ' ' << height_ - pose.position.y() << 'l'
          << radius * std::cos(pose.theta) << ' ' << -radius * std::sin(pose.theta) << "\"/>";
  }

  void add_title(const std::string& title) {
    text_ << "<title>";
    for (const char c : title) {
      switch (c) {
        case '&':
          text_ << "&amp;";
          break;
        case '<':
          text_ << "&lt;";
          break;
        default:
          text_ << c;
      }
    }
    text_ << "</title>";
  }

  const core::Problem& problem_;
  const core::StopCondition& stop_;
  const double height_;  // metres
  std::ostringstream text_;
};

}  // namespace

std::optional<std::string> draw_plan(const core::Problem& problem, const core::Plan& plan,
                                     const core::StopCondition& stop) {
  Picture picture(problem, stop);
  picture.add_map();
  picture.add_zones();
  for (const core::Unplanned& unplanned : plan.unplanned) {
    if (stop.met()) break;
    picture.add_unplanned(problem.robots()[unplanned.robot]);
  }
  for (const core::RobotPlan& robot_plan : plan.plans) {
    if (stop.met()) return std::nullopt;
    picture.add_planned(robot_plan);
  }
  return stop.met() ? std::nullopt : std::optional(picture.take());
}

}  // namespace fleetplan::api

#include "api/response/draw_plan.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <sstream>
#include <vector>

#include "api/json/printable.h"
#include "core/geometry/elementary_functions.h"

namespace fleetplan::api {

namespace {

using core::Pose;
using core::Position;
using core::Robot;

/// Writes the elements of a picture. Its y axis points down; the map's y axis points up.
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

  /// Draws the blocked cells. Cells beside each other in a row become one rectangle.
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
    const Position ahead = radius * core::unit_vector(pose.theta);
    text_ << "<path stroke=\"#fff\" d=\"M" << pose.position.x() << ' ' << height_ - pose.position.y() << 'l'
          << ahead.x() << ' ' << -ahead.y() << "\"/>";
  }

  void add_title(const std::string& title) {
    text_ << "<title>";
    for (const char c : printable(title)) {
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

namespace {

using Colour = std::array<double, 3>;  // red, green and blue, 0 to 255

constexpr Colour kWall{85, 85, 85};
constexpr Colour kBlockedZone{221, 51, 51};
constexpr Colour kOtherZone{51, 102, 204};
constexpr Colour kUnplanned{170, 170, 170};
constexpr Colour kHeading{255, 255, 255};
constexpr double kZoneOpacity = 0.2;
constexpr double kThinnest = 0.7;  // pixels: half the width of a line, so that it has no gaps

/// Returns the colour of a robot, of 70 % saturation and 40 % lightness. Hues go on by the golden angle, so
/// that neighbours in the list differ.
Colour colour_of(std::size_t robot) {
  const double sixths = std::fmod(137.508 * static_cast<double>(robot), 360.0) / 60.0;
  const auto channel = [&](double shift) {
    const double from_peak = std::abs(std::fmod(sixths + shift, 6.0) - 3.0);
    return 255.0 * (0.4 + 0.28 * (2.0 * std::clamp(from_peak - 1.0, 0.0, 1.0) - 1.0));
  };
  return {channel(0.0), channel(4.0), channel(2.0)};
}

/// Pixels, the top row first, over the map, whose y axis points up. Positions are in metres.
class Canvas {
 public:
  Canvas(const core::OccupancyGrid& grid, const core::StopCondition& stop)
      : stop_(stop),
        scale_(kPaintedSide / std::max(grid.width(), grid.height())),
        columns_(std::max(1, static_cast<int>(std::lround(grid.width() * scale_)))),
        rows_(std::max(1, static_cast<int>(std::lround(grid.height() * scale_)))),
        top_(grid.height()),
        pixels_(std::size_t{3} * static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 255) {}

  double pixel() const { return 1.0 / scale_; }
  bool stopped() const { return stop_.met(); }

  /// Paints the pixels, at least one, of a box whose centres `inside` accepts.
  template <typename Inside>
  void paint(const Position& low, const Position& high, const Colour& colour, const Inside& inside) {
    const int left = std::clamp(static_cast<int>(std::floor(low.x() * scale_)), 0, columns_ - 1);
    const int right = std::clamp(static_cast<int>(std::ceil(high.x() * scale_)), left + 1, columns_);
    const int first = std::clamp(static_cast<int>(std::floor((top_ - high.y()) * scale_)), 0, rows_ - 1);
    const int last = std::clamp(static_cast<int>(std::ceil((top_ - low.y()) * scale_)), first + 1, rows_);
    for (int row = first; row < last && !stop_.met(); ++row) {
      for (int column = left; column < right; ++column) {
        if (inside(centre(column, row))) blend(column, row, colour, 1.0);
      }
    }
  }

  /// Paints the inside of a polygon, row by row between its sides.
  void paint(const std::vector<Position>& polygon, const Colour& colour, double opacity) {
    std::vector<double> sides;  // columns where sides cross the row
    for (int row = 0; row < rows_ && !stop_.met(); ++row) {
      const double y = centre(0, row).y();
      sides.clear();
      for (std::size_t index = 0; index < polygon.size(); ++index) {
        const Position& a = polygon[index];
        const Position& b = polygon[(index + 1) % polygon.size()];
        if ((a.y() <= y) != (b.y() <= y))
          sides.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      }
      std::sort(sides.begin(), sides.end());
      for (std::size_t side = 0; side + 1 < sides.size(); side += 2) {
        const int end = column_from(sides[side + 1]);
        for (int column = column_from(sides[side]); column < end; ++column)
          blend(column, row, colour, opacity);
      }
    }
  }

  /// Returns the image as a file; empty if the library fails.
  std::string png() const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(columns_);
    image.height = static_cast<png_uint_32>(rows_);
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string file(bytes, '\0');
    if (png_image_write_to_memory(&image, file.data(), &bytes, 0, pixels_.data(), 0, nullptr) == 0) return {};
    file.resize(bytes);
    return file;
  }

 private:
  Position centre(int column, int row) const {
    return {(column + 0.5) / scale_, top_ - (row + 0.5) / scale_};
  }

  /// Returns the first column whose centre is not left of x.
  int column_from(double x) const {
    return static_cast<int>(std::clamp(std::ceil(x * scale_ - 0.5), 0.0, static_cast<double>(columns_)));
  }

  void blend(int column, int row, const Colour& colour, double opacity) {
    const auto place =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    for (std::size_t channel = 0; channel < colour.size(); ++channel) {
      std::uint8_t& value = pixels_[3 * place + channel];
      value = static_cast<std::uint8_t>(std::lround(value + opacity * (colour[channel] - value)));
    }
  }

  const core::StopCondition& stop_;
  double scale_;  // pixels per metre
  int columns_;
  int rows_;
  double top_;  // metres
  std::vector<std::uint8_t> pixels_;
};

/// Paints a line with round ends, in pieces so small that their boxes have few pixels outside of it.
/// Bounded: asks the stop condition of the canvas; a line has at most as many pieces as the canvas pixels.
void paint_line(Canvas& canvas, const Position& from, const Position& to, double width,
                const Colour& colour) {
  const double reach = std::max(width / 2.0, kThinnest * canvas.pixel());
  const double longest = std::max(reach, 8.0 * canvas.pixel());
  const double pieces = std::floor((to - from).norm() / longest) + 1.0;
  const Position step = (to - from) / pieces;
  const Position margin(reach, reach);
  for (double piece = 0.0; piece < pieces && !canvas.stopped(); ++piece) {
    const Position a = from + piece * step;
    const Position b = a + step;
    const auto inside = [&](const Position& p) {
      const double along =
          step.squaredNorm() > 0.0 ? std::clamp((p - a).dot(step) / step.squaredNorm(), 0.0, 1.0) : 0.0;
      return (p - a - along * step).squaredNorm() <= reach * reach;
    };
    canvas.paint(a.cwiseMin(b) - margin, a.cwiseMax(b) + margin, colour, inside);
  }
}

/// Paints a disk without its inside up to `hole` metres from the centre.
void paint_disk(Canvas& canvas, const Position& centre, double radius, double hole, const Colour& colour) {
  const Position margin(radius, radius);
  canvas.paint(centre - margin, centre + margin, colour, [&](const Position& p) {
    const double square = (p - centre).squaredNorm();
    return square <= radius * radius && square >= hole * hole;
  });
}

void paint_standing(Canvas& canvas, const Pose& pose, double radius, const Colour& colour) {
  paint_disk(canvas, pose.position, std::max(radius, canvas.pixel()), 0.0, colour);
  const Position tip = pose.position + radius * core::unit_vector(pose.theta);
  paint_line(canvas, pose.position, tip, radius / 6.0, kHeading);
}

void paint_map(Canvas& canvas, const core::OccupancyGrid& grid) {
  const double side = grid.resolution();
  for (int row = 0; row < grid.rows() && !canvas.stopped(); ++row) {
    const auto cells = grid.row(row);
    for (auto begin = std::find(cells.begin(), cells.end(), 1); begin != cells.end();) {
      const auto end = std::find(begin, cells.end(), 0);
      const Position low(static_cast<double>(begin - cells.begin()) * side, row * side);
      const Position high(static_cast<double>(end - cells.begin()) * side, (row + 1) * side);
      // The inset is less than a pixel, so that rounding does not add one.
      const Position inset = Position::Constant(1e-6 * canvas.pixel());
      canvas.paint(low + inset, high - inset, kWall, [](const Position& /*p*/) { return true; });
      begin = std::find(end, cells.end(), 1);
    }
  }
}

void paint_planned(Canvas& canvas, const Robot& robot, const core::RobotPlan& plan) {
  const Colour colour = colour_of(plan.robot);
  const double width = robot.radius / 6.0;
  const double ring = std::max(width, 2.0 * kThinnest * canvas.pixel());
  paint_disk(canvas, robot.start.position, robot.radius + ring / 2.0,
             std::max(0.0, robot.radius - ring / 2.0), colour);
  for (const core::Action& action : plan.actions) {
    if (canvas.stopped()) return;
    if (action.type != core::Action::Type::translate) continue;
    paint_line(canvas, action.from.position, action.to.position, width, colour);
  }
  paint_standing(canvas, plan.actions.empty() ? robot.start : plan.actions.back().to, robot.radius, colour);
}

}  // namespace

std::optional<std::string> paint_plan(const core::Problem& problem, const core::Plan& plan,
                                      const core::StopCondition& stop) {
  Canvas canvas(problem.grid(), stop);
  paint_map(canvas, problem.grid());
  for (const core::Zone& zone : problem.zones()) {
    const bool is_blocked = zone.type == core::Zone::Type::blocked;
    canvas.paint(zone.polygon, is_blocked ? kBlockedZone : kOtherZone, kZoneOpacity);
  }
  for (const core::Unplanned& unplanned : plan.unplanned) {
    const Robot& robot = problem.robots()[unplanned.robot];
    paint_standing(canvas, robot.committed_end(), robot.radius, kUnplanned);
  }
  for (const core::RobotPlan& planned : plan.plans) {
    paint_planned(canvas, problem.robots()[planned.robot], planned);
  }
  if (stop.met()) return std::nullopt;
  std::string png = canvas.png();
  return png.empty() ? std::nullopt : std::optional(std::move(png));
}

}  // namespace fleetplan::api

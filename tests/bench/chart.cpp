#include "tests/bench/chart.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace fleetplan::bench {
namespace {

// Pixels.
constexpr double kPanelWidth = 300.0;
constexpr double kPanelHeight = 220.0;
constexpr double kLeft = 52.0;    // for the labels of y
constexpr double kRight = 16.0;   // between panels
constexpr double kTop = 64.0;     // for the titles
constexpr double kBottom = 48.0;  // for the labels of x
constexpr double kLegendRow = 20.0;

/// A range of values and the places in it that get a label.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;
  std::vector<double> ticks;

  /// 0 at `low`, 1 at `high`.
  double share(double value) const {
    if (logarithmic) return std::log(value / low) / std::log(high / low);
    return (value - low) / (high - low);
  }
};

/// A step of 1, 2 or 5 times a power of ten that parts `span` into about five.
double round_step(double span) {
  const double rough = span / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

Axis linear_axis(double low, double high) {
  if (!(high > low)) high = low + 1.0;
  const double step = round_step(high - low);
  Axis axis{std::floor(low / step) * step, std::ceil(high / step) * step, false, {}};
  const auto count = std::lround((axis.high - axis.low) / step);
  for (long i = 0; i <= count; ++i) axis.ticks.push_back(axis.low + static_cast<double>(i) * step);
  return axis;
}

Axis decades(double low, double high) {
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(high))));
  Axis axis{std::pow(10.0, first), std::pow(10.0, last), true, {}};
  for (int power = first; power <= last; ++power) axis.ticks.push_back(std::pow(10.0, power));
  return axis;
}

std::vector<ChartPoint> drawn_points(const std::vector<ChartPanel>& panels) {
  std::vector<ChartPoint> points;
  for (const ChartPanel& panel : panels) {
    for (const ChartLine& line : panel.lines) {
      for (const ChartPoint& point : line.points) {
        if (std::isfinite(point.x) && std::isfinite(point.y)) points.push_back(point);
      }
    }
  }
  return points;
}

Axis x_axis(const std::vector<ChartPoint>& points) {
  double high = 0.0;
  for (const ChartPoint& point : points) high = std::max(high, point.x);
  return linear_axis(0.0, high);
}

Axis y_axis(const ChartPanel& panel) {
  const std::vector<ChartPoint> points = drawn_points({panel});
  if (points.empty()) return linear_axis(0.0, 1.0);
  const auto [low, high] = std::minmax_element(points.begin(), points.end(),
                                               [](const auto& a, const auto& b) { return a.y < b.y; });
  if (panel.logarithmic) return decades(low->y, high->y);
  return linear_axis(std::min(panel.low.value_or(low->y), low->y), high->y);
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

class Drawing {
 public:
  Drawing(double width, double height) {
    text_.precision(6);
    text_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << ' ' << height
          << "\" width=\"" << width << "\" height=\"" << height
          << "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"" << width << "\" height=\""
          << height << "\" fill=\"#ffffff\"/>\n";
  }

  void label(double x, double y, const std::string& text, const std::string& anchor,
             const std::string& more = "") {
    text_ << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\" fill=\"#333333\""
          << more << ">" << escaped(text) << "</text>\n";
  }

  void rule(double x1, double y1, double x2, double y2, const std::string& colour, double width = 1.0,
            bool dashed = false) {
    text_ << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2 << "\" stroke=\""
          << escaped(colour) << "\" stroke-width=\"" << width << "\"" << dash(dashed) << "/>\n";
  }

  /// A line through points in pixels, a dot at each.
  void polyline(const std::vector<ChartPoint>& points, const ChartLine& line) {
    const std::string colour = escaped(line.colour);
    text_ << "<polyline fill=\"none\" stroke=\"" << colour << "\" stroke-width=\"2\"" << dash(line.dashed)
          << " points=\"";
    for (const ChartPoint& point : points) text_ << point.x << ',' << point.y << ' ';
    text_ << "\"/>\n";
    if (line.dashed) return;
    for (const ChartPoint& point : points) {
      text_ << "<circle cx=\"" << point.x << "\" cy=\"" << point.y << "\" r=\"2.5\" fill=\"" << colour
            << "\"/>\n";
    }
  }

  std::string take() {
    text_ << "</svg>\n";
    return text_.str();
  }

 private:
  static const char* dash(bool dashed) { return dashed ? " stroke-dasharray=\"5 4\"" : ""; }

  std::ostringstream text_;
};

std::string tick_text(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

void draw_panel(Drawing& drawing, const ChartPanel& panel, const Axis& x, const std::string& x_title,
                double left) {
  const Axis y = y_axis(panel);
  const double bottom = kTop + kPanelHeight;
  const auto to_pixels = [&](const ChartPoint& point) {
    return ChartPoint{left + x.share(point.x) * kPanelWidth, bottom - y.share(point.y) * kPanelHeight};
  };
  drawing.label(left, kTop - 12.0, panel.title, "start", " font-weight=\"bold\"");
  for (const double tick : y.ticks) {
    const double at = to_pixels({x.low, tick}).y;
    drawing.rule(left, at, left + kPanelWidth, at, "#e3e3e3");
    drawing.label(left - 6.0, at + 4.0, tick_text(tick), "end");
  }
  for (const double tick : x.ticks) {
    const double at = to_pixels({tick, y.low}).x;
    drawing.rule(at, bottom, at, bottom + 4.0, "#999999");
    drawing.label(at, bottom + 18.0, tick_text(tick), "middle");
  }
  drawing.rule(left, bottom, left + kPanelWidth, bottom, "#999999");
  drawing.label(left + kPanelWidth / 2.0, bottom + 36.0, x_title, "middle");
  for (const ChartLine& line : panel.lines) {
    std::vector<ChartPoint> points;
    for (const ChartPoint& point : line.points) {
      if (std::isfinite(point.x) && std::isfinite(point.y)) points.push_back(to_pixels(point));
    }
    if (!points.empty()) drawing.polyline(points, line);
  }
}

std::vector<ChartLine> legend_of(const std::vector<ChartPanel>& panels) {
  std::vector<ChartLine> legend;
  for (const ChartPanel& panel : panels) {
    for (const ChartLine& line : panel.lines) {
      const auto same = [&](const ChartLine& other) { return other.name == line.name; };
      if (std::none_of(legend.begin(), legend.end(), same)) legend.push_back(line);
    }
  }
  return legend;
}

}  // namespace

std::string svg_chart(const std::string& title, const std::string& x_title,
                      const std::vector<ChartPanel>& panels) {
  const std::vector<ChartLine> legend = legend_of(panels);
  const double pitch = kLeft + kPanelWidth + kRight;
  const double legend_top = kTop + kPanelHeight + kBottom;
  Drawing drawing(pitch * static_cast<double>(panels.size()),
                  legend_top + kLegendRow * static_cast<double>(legend.size()) + 8.0);
  drawing.label(kLeft, 24.0, title, "start", " font-size=\"15\" font-weight=\"bold\"");
  const Axis x = x_axis(drawn_points(panels));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    draw_panel(drawing, panels[i], x, x_title, kLeft + pitch * static_cast<double>(i));
  }
  for (std::size_t i = 0; i < legend.size(); ++i) {
    const double at = legend_top + kLegendRow * (static_cast<double>(i) + 0.5);
    drawing.rule(kLeft, at, kLeft + 28.0, at, legend[i].colour, 2.0, legend[i].dashed);
    drawing.label(kLeft + 36.0, at + 4.0, legend[i].name, "start");
  }
  return drawing.take();
}

}  // namespace fleetplan::bench

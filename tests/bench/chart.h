#pragma once

// Small line charts as SVG: panels side by side with one legend below. Light background, fixed.

#include <optional>
#include <string>
#include <vector>

namespace fleetplan::bench {

struct ChartPoint {
  double x = 0.0;
  double y = 0.0;
};

struct ChartLine {
  std::string name;    // in the legend, once for each name
  std::string colour;  // as SVG knows it
  bool dashed = false;
  std::vector<ChartPoint> points;  // by x
};

struct ChartPanel {
  std::string title;  // what y is
  bool logarithmic = false;
  std::optional<double> low = {};  // the range of y reaches down to this, if it is not logarithmic
  std::vector<ChartLine> lines;
};

/// The chart. Every panel finds its own range of y (a logarithmic one whole decades, and its points are
/// positive); x is labelled `x_title` and shared. Points that are not finite are left out.
std::string svg_chart(const std::string& title, const std::string& x_title,
                      const std::vector<ChartPanel>& panels);

}  // namespace fleetplan::bench

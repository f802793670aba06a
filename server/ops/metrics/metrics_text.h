#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/ops/metrics/metric_types.h"

namespace fleetplan::server {

inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Writes metrics in the text format of Prometheus, version 0.0.4. Written here because Debian's
/// prometheus-cpp would bring another web server and curl's development files along for these few lines.
class MetricsText {
 public:
  using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

  /// Begins a metric; its samples follow. `type`: counter, gauge or histogram.
  MetricsText& metric(std::string_view name, std::string_view type, std::string_view help);

  MetricsText& sample(double value, const Labels& labels = {});

  /// All samples of a histogram.
  MetricsText& histogram(const Histogram& values, const Labels& labels = {});

  std::string take() { return std::move(text_); }

 private:
  void line(std::string_view suffix, double value, const Labels& labels);

  std::string text_;
  std::string name_;
};

}  // namespace fleetplan::server

#include "server/ops/metrics/metrics_text.h"

#include <array>
#include <charconv>

namespace fleetplan::server {

namespace {

/// Returns the shortest text that reads back as the same number.
std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string escaped(std::string_view label) {
  std::string text;
  for (const char c : label) {
    if (c == '\\' || c == '"') text += '\\';
    if (c == '\n') {
      text += "\\n";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

MetricsText& MetricsText::metric(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  text_ += "# HELP " + name_ + ' ';
  text_ += help;
  text_ += "\n# TYPE " + name_ + ' ';
  text_ += type;
  text_ += '\n';
  return *this;
}

MetricsText& MetricsText::sample(double value, const Labels& labels) {
  line("", value, labels);
  return *this;
}

MetricsText& MetricsText::histogram(const Histogram& values, const Labels& labels) {
  double total = 0.0;
  for (std::size_t bucket = 0; bucket <= Histogram::kBounds.size(); ++bucket) {
    total += static_cast<double>(values.count(bucket));
    const bool last = bucket == Histogram::kBounds.size();
    const std::string bound = last ? "+Inf" : number_text(Histogram::kBounds[bucket]);
    Labels with_bound = labels;
    with_bound.emplace_back("le", bound);
    line("_bucket", total, with_bound);
  }
  line("_sum", values.sum(), labels);
  line("_count", total, labels);
  return *this;
}

void MetricsText::line(std::string_view suffix, double value, const Labels& labels) {
  text_ += name_;
  text_ += suffix;
  char before = '{';
  for (const auto& [label, of] : labels) {
    text_ += before;
    text_ += label;
    text_ += "=\"" + escaped(of) + '"';
    before = ',';
  }
  if (!labels.empty()) text_ += '}';
  text_ += ' ' + number_text(value) + '\n';
}

}  // namespace fleetplan::server

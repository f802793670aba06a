#include "tests/bench/result_table.h"

#include <charconv>
#include <istream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace fleetplan::bench {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> values(1);
  for (const char c : line) {
    if (c == ',') {
      values.emplace_back();
    } else if (c != '\r') {
      values.back() += c;
    }
  }
  return values;
}

/// One line of values, by the names of the columns.
class Line {
 public:
  Line(const std::vector<std::string>& names, const std::string& line, std::size_t number) : number_(number) {
    const std::vector<std::string> values = split(line);
    if (values.size() != names.size()) fail("as many values as columns are expected");
    for (std::size_t i = 0; i < names.size(); ++i) values_[names[i]] = values[i];
  }

  const std::string& text(const std::string& column) const {
    const auto found = values_.find(column);
    if (found == values_.end()) fail("there is no column " + column);
    return found->second;
  }

  template <typename Number>
  Number number(const std::string& column) const {
    const std::string& value = text(column);
    Number read{};
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), read);
    if (error != std::errc() || end != value.data() + value.size())
      fail("'" + value + "' is no number of column " + column);
    return read;
  }

  std::optional<double> optional_number(const std::string& column) const {
    if (text(column).empty()) return std::nullopt;
    return number<double>(column);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("line " + std::to_string(number_) + ": " + what);
  }

  std::size_t number_;
  std::map<std::string, std::string> values_;
};

std::string text(const std::optional<double>& value) {
  if (!value) return {};
  std::ostringstream made;
  made.precision(9);
  made << *value;
  return made.str();
}

}  // namespace

std::string csv_header() {
  return "file,robots,solved,attempts,seconds,flowtime,makespan,cpu_seconds,peak_memory,planned,lower_bound,"
         "expansions,improvements,"
         "deterministic,valid\n";
}

std::string csv_row(const Measurement& measurement) {
  const Result& result = measurement.result;
  std::ostringstream row;
  row << result.file << ',' << result.robots << ',' << result.solved << ',' << result.attempts << ','
      << text(result.seconds) << ',' << text(result.flowtime) << ',' << text(result.makespan) << ','
      << text(measurement.cpu_seconds) << ',' << measurement.peak_memory << ',' << measurement.planned << ','
      << text(measurement.lower_bound) << ',' << measurement.expansions << ',' << measurement.improvements
      << ',' << measurement.deterministic << ',' << measurement.fault.empty() << '\n';
  return row.str();
}

std::vector<Result> read_results(std::istream& csv) {
  std::string text;
  std::getline(csv, text);
  const std::vector<std::string> names = split(text);
  std::vector<Result> results;
  for (std::size_t number = 2; std::getline(csv, text); ++number) {
    if (text.empty()) continue;
    const Line line(names, text, number);
    results.push_back({line.text("file"), line.number<std::size_t>("robots"), line.number<int>("solved") != 0,
                       line.number<std::int64_t>("attempts"), line.number<double>("seconds"),
                       line.optional_number("flowtime"), line.optional_number("makespan")});
  }
  return results;
}

}  // namespace fleetplan::bench

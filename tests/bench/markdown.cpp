#include "tests/bench/markdown.h"

#include <algorithm>
#include <cstddef>
#include <iomanip>
#include <sstream>

namespace fleetplan::bench {
namespace {

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string padding(width - std::min(width, text.size()), ' ');
  return left ? text + padding : padding + text;
}

std::string line(const TableRow& row, const std::vector<std::size_t>& widths) {
  std::string made = "|";
  for (std::size_t i = 0; i < row.size(); ++i) {
    made += ' ';
    made += padded(row[i], widths[i], i == 0);
    made += " |";
  }
  made += '\n';
  return made;
}

}  // namespace

std::string markdown_table(const TableRow& head, const std::vector<TableRow>& rows) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < head.size(); ++i) {
    std::size_t width = head[i].size();
    for (const TableRow& row : rows) width = std::max(width, row[i].size());
    widths.push_back(width);
  }
  std::string table = line(head, widths);
  table += '|';
  for (std::size_t i = 0; i < widths.size(); ++i) {
    table.append(widths[i] + 1, '-');
    table += i == 0 ? "-|" : ":|";
  }
  table += '\n';
  for (const TableRow& row : rows) table += line(row, widths);
  return table;
}

std::string decimal(const std::optional<double>& value, int decimals) {
  if (!value) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << *value;
  return text.str();
}

std::string seconds_text(const std::optional<double>& value) {
  if (!value) return "-";
  int decimals = 4;
  for (double limit = 0.1; decimals > 1 && *value >= limit; limit *= 10.0) --decimals;
  return decimal(value, decimals);
}

std::string mebibytes(std::size_t bytes) {
  constexpr std::size_t kMebibyte = 1u << 20;
  return std::to_string((bytes + kMebibyte - 1) / kMebibyte);
}

}  // namespace fleetplan::bench

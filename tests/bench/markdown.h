#pragma once

// Tables for people, in Markdown, aligned also as plain text.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fleetplan::bench {

using TableRow = std::vector<std::string>;

/// A table of equally long rows; the first column is flush left, the others right.
std::string markdown_table(const TableRow& head, const std::vector<TableRow>& rows);

/// With so many decimals; "-" for nothing.
std::string decimal(const std::optional<double>& value, int decimals);
/// Seconds with three significant digits, but not below a tenth of a millisecond; "-" for nothing.
std::string seconds_text(const std::optional<double>& value);
/// Bytes in MiB, rounded up.
std::string mebibytes(std::size_t bytes);

}  // namespace fleetplan::bench

// A table of comma-separated values with a line of names.
#pragma once

#include "dicot/base/status.h"

#include <optional>
#include <string>
#include <vector>

namespace dicot::app {

/// As in RFC 4180: cells may stand in quotes, lines may end in CRLF; blanks around a cell are left out, and so are
/// empty lines.
struct CsvTable
{
    std::vector<std::string> names;
    std::vector<std::vector<std::string>> rows; ///< each as long as the names
    std::vector<int> lines;                     ///< of the file, where each row begins

    /// Index of the column of this name.
    std::optional<std::size_t> column(const std::string& name) const;
};

/// At most 1 MiB. Fault::kNoInput: missing or unreadable; kBadData: empty, larger, a quote without its end, a line with
/// more or fewer cells than names.
Result<CsvTable> read_csv(const std::string& path);

/// A cell as a finite number; nothing when it is none.
std::optional<double> number_in(const std::string& cell);

} // namespace dicot::app

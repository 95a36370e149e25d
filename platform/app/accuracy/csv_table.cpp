#include "csv_table.h"

#include "dicot/os/input_file.h"
#include "dicot/os/shown_path.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

namespace dicot::app {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;

Result<std::string> whole_text(const std::string& path)
{
    InputFile file;
    TRY(file.open(path.c_str()));
    if (file.size_bytes() > kMostBytes)
        return failure(Fault::kBadData, "%s: larger than 1 MiB: a table of distances is not", shown_path(path.c_str()));
    std::string text(static_cast<std::size_t>(file.size_bytes()), '\0');
    text.resize(TRY(file.read(std::as_writable_bytes(std::span{text.data(), text.size()}))));
    constexpr const char* kMark = "\xEF\xBB\xBF"; // spreadsheets put it in front
    return text.starts_with(kMark) ? text.substr(3) : text;
}

void trim(std::string& cell)
{
    const auto blank = [](char c) { return c == ' ' || c == '\t'; };
    cell.erase(cell.begin(), std::find_if_not(cell.begin(), cell.end(), blank));
    while (!cell.empty() && blank(cell.back()))
        cell.pop_back();
}

/// One record from `at`, which moves behind it. False: a quote has no end.
bool next_record(const std::string& text, std::size_t& at, int& line, std::vector<std::string>& cells)
{
    cells.assign(1, "");
    bool quoted = false;
    for (; at < text.size(); ++at) {
        const char c = text[at];
        line += c == '\n' ? 1 : 0;
        if (quoted && c == '"' && at + 1 < text.size() && text[at + 1] == '"')
            cells.back() += text[++at];
        else if (c == '"')
            quoted = !quoted;
        else if (quoted)
            cells.back() += c;
        else if (c == ',')
            cells.emplace_back();
        else if (c == '\n') {
            ++at;
            break;
        } else if (c != '\r')
            cells.back() += c;
    }
    std::ranges::for_each(cells, trim);
    return !quoted;
}

} // namespace

std::optional<std::size_t> CsvTable::column(const std::string& name) const
{
    const auto found = std::ranges::find(names, name);
    return found == names.end() ? std::nullopt
                                : std::optional(static_cast<std::size_t>(std::distance(names.begin(), found)));
}

Result<CsvTable> read_csv(const std::string& path)
{
    const char* shown = shown_path(path.c_str());
    const std::string text = TRY(whole_text(path));
    CsvTable table;
    std::vector<std::string> cells;
    int line = 1;
    for (std::size_t at = 0; at < text.size();) {
        const int first_line = line;
        if (!next_record(text, at, line, cells))
            return failure(Fault::kBadData, "%s: line %d: a quote without its end", shown, first_line);
        if (cells.size() == 1 && cells.front().empty())
            continue;
        if (table.names.empty()) {
            table.names = cells;
            continue;
        }
        if (cells.size() != table.names.size())
            return failure(Fault::kBadData, "%s: line %d has %zu cells, and the first line names %zu columns", shown,
                           first_line, cells.size(), table.names.size());
        table.rows.push_back(cells);
        table.lines.push_back(first_line);
    }
    if (table.names.empty())
        return failure(Fault::kBadData, "%s: is empty: its first line names the columns", shown);
    return table;
}

std::optional<double> number_in(const std::string& cell)
{
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    const bool whole = error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(value);
    return whole ? std::optional(value) : std::nullopt;
}

} // namespace dicot::app

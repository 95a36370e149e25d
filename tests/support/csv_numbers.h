// Tables of numbers by the names of their columns.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace dicot::test {

/// The lines after the first, which names the columns; what is no number counts as 0.
inline std::vector<std::map<std::string, double>> csv_numbers(const std::string& path)
{
    std::ifstream file(path);
    std::vector<std::string> names;
    std::vector<std::map<std::string, double>> rows;
    for (std::string line; std::getline(file, line);) {
        std::erase(line, '\r');
        std::istringstream cells(line);
        std::vector<std::string> row;
        for (std::string cell; std::getline(cells, cell, ',');)
            row.push_back(cell);
        if (names.empty()) {
            names = row;
            continue;
        }
        auto& numbers = rows.emplace_back();
        for (std::size_t i = 0; i < row.size() && i < names.size(); ++i)
            numbers[names[i]] = std::strtod(row[i].c_str(), nullptr);
    }
    return rows;
}

} // namespace dicot::test

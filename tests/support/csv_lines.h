// Tables of expected values.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace dicot::test {

/// The fields of every line but the first, which names them.
inline std::vector<std::vector<std::string>> csv_lines(const std::string& path)
{
    std::ifstream file{path};
    std::vector<std::vector<std::string>> lines;
    std::string line;
    EXPECT_TRUE(std::getline(file, line)) << path;
    while (std::getline(file, line)) {
        std::istringstream fields{line};
        lines.emplace_back();
        for (std::string field; std::getline(fields, field, ',');)
            lines.back().push_back(field);
    }
    return lines;
}

} // namespace dicot::test

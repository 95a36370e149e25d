// What an archive holds of one board, for people and for programs.
#pragma once

#include "dicot/pull_archive/archive_look.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <string>

namespace dicot::app {

struct ArchiveSummary
{
    ArchiveLook look;
    std::map<std::string, std::int64_t> reasons; ///< of misses, how many of each; kMostReasons at most

    static constexpr std::size_t kMostReasons = 50;

    void add(const RecordFacts& facts);
};

std::string summary_words(const std::string& device, const ArchiveSummary& summary);
nlohmann::json summary_json(const std::string& device, const ArchiveSummary& summary);

} // namespace dicot::app

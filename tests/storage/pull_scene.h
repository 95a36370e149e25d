// What a test asks an archive, on any medium.
#pragma once

#include "scripted_source.h"

#include "dicot/medium/medium.h"
#include "dicot/pull_archive/archive_look.h"
#include "dicot/pull_archive/board_archive.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace dicot::test {

inline constexpr std::int64_t kNoon = 1'780'315'200'000'000; ///< 2026-06-01T12:00:00Z
inline constexpr const char* kFirstFolder = "2026-06-01/000001_20260601T120000Z";
inline constexpr const char* kFirstPart = "incoming/000001_20260601T120000Z";

inline constexpr auto goes_on = [](std::uint64_t) { return true; };

/// Opens the archive, takes the first snapshot of the source, lets the archive go.
inline Result<Taken> take_first(Medium& medium, ScriptedSource& source, bool verify = false)
{
    const std::unique_ptr<BoardArchive> archive = TRY(BoardArchive::open(medium, source.serial()));
    return archive->take(source, source.all.front().offer, verify, goes_on);
}

inline std::vector<std::string> names_in(Medium& medium, const char* folder)
{
    std::vector<std::string> names;
    (void)medium.list(folder, [&](const MediumEntry& entry) {
        names.emplace_back(entry.name);
        return true;
    });
    std::ranges::sort(names);
    return names;
}

inline bool is_there(Medium& medium, const std::string& path)
{
    EntryKind kind{};
    return medium.kind_of(path.c_str(), kind).ok();
}

inline std::string text_in(Medium& medium, const std::string& path)
{
    Medium::File file = 0;
    std::uint64_t size = 0;
    if (!medium.open(path.c_str(), file, size).ok())
        return "(not there)";
    std::string text(static_cast<std::size_t>(size), '\0');
    std::size_t got = 0;
    (void)medium.read(file, std::as_writable_bytes(std::span(text)), got);
    (void)medium.close(file);
    return text.substr(0, got);
}

/// Byte by byte what the source has, and nothing beside it.
inline bool is_whole_copy(Medium& medium, const std::string& folder, const ScriptedSnapshot& snapshot)
{
    bool same = names_in(medium, folder.c_str()).size() == snapshot.files.size();
    for (const auto& [name, bytes] : snapshot.files)
        same = same && text_in(medium, folder + "/" + name) == bytes;
    return same;
}

} // namespace dicot::test

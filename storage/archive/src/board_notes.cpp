#include "board_notes.h"

#include "disk_words.h"

#include "card.h"

#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"

#include <cerrno>
#include <vector>

namespace dicot {
namespace {

constexpr std::size_t kMostSerialBytes = 126;
constexpr std::size_t kMostNoteBytes = std::size_t{1} << 20;
constexpr std::string_view kBoardWord = "serial ";
constexpr std::string_view kTimeWord = "pulled ";
constexpr std::string_view kHadWord = "had ";

std::string new_of(const char* path)
{
    return std::string{path} + ".new";
}

/// Empty: there is none. Fault::kBadData, kIoError: it cannot be read.
Result<std::string> read_text(Medium& medium, const char* path)
{
    const std::string fresh = new_of(path);
    // Between the two steps of write_text() only the new one is there.
    const char* const there = is_there(medium, path) ? path : fresh.c_str();
    if (!is_there(medium, there))
        return std::string{};
    std::string text;
    std::vector<std::byte> chunk(4096);
    TRY(read_file(medium, there, kMostNoteBytes, chunk, [&](std::span<const std::byte> bytes) {
        text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }));
    return text;
}

Status remove_if_there(Medium& medium, const char* path)
{
    const Errno removed = medium.remove_file(path);
    return removed.number() == ENOENT ? Status{} : on_disk(removed, path, "removing it");
}

/// The old one goes when the new one lasts: Medium::rename() replaces nothing.
Status write_text(Medium& medium, const char* path, std::string_view text)
{
    const std::string fresh = new_of(path);
    if (is_there(medium, path))
        TRY(remove_if_there(medium, fresh.c_str()));
    else if (is_there(medium, fresh.c_str())) // what a cut left is the only one
        TRY(on_disk(medium.rename(fresh.c_str(), path), path, "renaming"));
    Medium::File file = 0;
    TRY(on_disk(medium.create(fresh.c_str(), file), fresh.c_str(), "making it"));
    const Errno written = medium.write(file, std::as_bytes(std::span(text)));
    const Errno closed = medium.close(file);
    TRY(on_disk(written.ok() ? closed : written, fresh.c_str(), "writing"));
    TRY(on_disk(medium.sync_all(), fresh.c_str(), "syncing"));
    TRY(remove_if_there(medium, path));
    return on_disk(medium.rename(fresh.c_str(), path), path, "renaming");
}

/// What stands behind `word` on the first line of `text`, which is taken away.
std::optional<std::string_view> take_line(std::string_view& text, std::string_view word)
{
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos || !text.starts_with(word))
        return {};
    const std::string_view line = text.substr(word.size(), end - word.size());
    text.remove_prefix(end + 1);
    return line;
}

bool is_serial(std::string_view serial)
{
    return !serial.empty() && serial.size() <= kMostSerialBytes && is_printable(serial);
}

} // namespace

Status mark_archive(Medium& medium)
{
    if (is_there(medium, kArchiveMark))
        return {};
    Medium::File file = 0;
    TRY(on_disk(medium.create(kArchiveMark, file), kArchiveMark, "making it"));
    TRY(on_disk(medium.close(file), kArchiveMark, "closing it"));
    return on_disk(medium.sync_folder(""), kArchiveMark, "syncing");
}

Result<std::string> read_board(Medium& medium)
{
    const std::string text = TRY(read_text(medium, kBoardFile));
    std::string_view rest = text;
    const auto serial = take_line(rest, kBoardWord);
    return serial && rest.empty() && is_serial(*serial) ? std::string{*serial} : std::string{};
}

Status write_board(Medium& medium, std::string_view serial)
{
    if (!is_serial(serial))
        return failure(Fault::kBadData, "the board's serial number is no line of text");
    TRY(write_text(medium, kBoardFile, std::string{kBoardWord} + std::string{serial} + "\n"));
    return on_disk(medium.sync_all(), kBoardFile, "syncing");
}

std::optional<LastPull> read_last_pull(Medium& medium)
{
    const Result<std::string> text = read_text(medium, kLastPullFile);
    if (!text.ok()) // what it explains is not worth more
        return {};
    std::string_view rest = text.value();
    const auto time = take_line(rest, kTimeWord);
    const auto had = time ? take_line(rest, kHadWord) : std::nullopt;
    const auto pulled_us = time ? parse_utc_text(*time) : std::nullopt;
    auto ranges = had ? NumberRanges::parse(*had) : std::nullopt;
    if (!pulled_us || !ranges || !rest.empty())
        return {};
    return LastPull{*pulled_us, std::move(*ranges)};
}

Status write_last_pull(Medium& medium, const LastPull& pull)
{
    std::string text = std::string{kTimeWord} + utc_text(pull.pulled_us).c_str() + "\n";
    text += std::string{kHadWord} + pull.had.text() + "\n";
    if (text.size() > kMostNoteBytes) // a hostile list
        return {};
    return write_text(medium, kLastPullFile, text);
}

} // namespace dicot

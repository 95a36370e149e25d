#include "view_board.h"

#include "../cloud_on_disk.h"
#include "../store/shown.h"
#include "../store/slot_words.h"
#include "../traits/growth_series.h"

#include "dicot/base/utc_time.h"
#include "dicot/medium/disk_medium.h"
#include "dicot/os/input_file.h"
#include "dicot/store/look.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>

namespace dicot::app {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMostFileBytes = kMaxCloudFileBytes;

std::span<std::byte> bytes_of(std::string& text)
{
    return std::as_writable_bytes(std::span{text.data(), text.size()});
}

Status too_large(const std::string& path)
{
    return failure(Fault::kBadData, "%s: larger than any file that dicot writes", shown(path).c_str());
}

Result<std::string> read_from_store(const std::string& store, const std::string& path)
{
    const std::unique_ptr<Medium> medium = TRY(open_disk_medium(store));
    const std::string whole = store + "/" + path;
    Medium::File file{};
    std::uint64_t size = 0;
    if (const Errno opened = medium->open(path.c_str(), file, size); !opened.ok())
        return failure(opened.number() == EIO ? Fault::kIoError : Fault::kNoInput, "%s: %s", shown(whole).c_str(),
                       std::strerror(opened.number()));
    std::string text;
    std::size_t got = 0;
    Errno read = 0;
    if (size <= kMostFileBytes) {
        text.resize(static_cast<std::size_t>(size));
        read = medium->read(file, bytes_of(text), got);
    }
    (void)medium->close(file);
    if (size > kMostFileBytes)
        return too_large(whole);
    if (!read.ok())
        return failure(Fault::kIoError, "%s: %s", shown(whole).c_str(), std::strerror(read.number()));
    text.resize(got);
    return text;
}

Result<std::string> read_file(const std::string& path)
{
    InputFile file;
    TRY(file.open(path.c_str()));
    if (file.size_bytes() > kMostFileBytes)
        return too_large(path);
    std::string text(static_cast<std::size_t>(file.size_bytes()), '\0');
    text.resize(TRY(file.read(bytes_of(text))));
    return text;
}

char state_letter(const SlotRow& row)
{
    const bool here = row.kept == Kept::kHere;
    if (!row.done)
        return here ? 'm' : 'a';
    switch (row.kept) {
    case Kept::kHere:
        return 'd';
    case Kept::kPruned:
        return 'p';
    case Kept::kQuarantined:
        return 'q';
    case Kept::kLost:
        break;
    }
    return 'l';
}

} // namespace

Result<ViewBoard> ViewBoard::of_folder(const DeviceFolder& folder, std::optional<std::int64_t> last)
{
    ViewBoard board;
    board.name_ = folder.device;
    board.folder_ = folder.path;
    ReadStore store = TRY(ReadStore::open(folder.path));
    SlotQuery query;
    query.last = last;
    TRY(store.catalogue->for_each(query, [&board](const SlotRow& row) {
        board.slots_.push_back(row);
        return true;
    }));
    return board;
}

Result<ViewBoard> ViewBoard::of_cloud(const std::string& path)
{
    const CloudOnDisk cloud = TRY(CloudOnDisk::read(path.c_str()));
    const CloudMeta& meta = cloud.meta();
    ViewBoard board;
    board.name_ = meta.device_id.view().empty() ? "cloud" : std::string{meta.device_id.view()};
    board.cloud_ = path;
    const std::optional<std::int64_t> time_us = parse_utc_text(meta.captured_at.view());
    board.time_known_ = time_us.has_value();
    SlotRow row;
    row.sequence = meta.sequence.value_or(1);
    row.began_us = time_us.value_or(0);
    row.done = true;
    row.points = static_cast<std::int64_t>(cloud.cloud().points.size());
    row.bytes = static_cast<std::int64_t>(cloud.file_bytes());
    row.clock_trust = meta.clock_trust.view();
    board.slots_.push_back(row);
    return board;
}

const SlotRow* ViewBoard::find(std::int64_t sequence) const
{
    const auto at = std::ranges::lower_bound(slots_, sequence, {}, &SlotRow::sequence);
    return at != slots_.end() && at->sequence == sequence ? &*at : nullptr;
}

Result<std::string> ViewBoard::read(const SlotRow& row, const char* file) const
{
    if (!folder_.empty())
        return read_from_store(folder_, std::string{folder_of(row.sequence, row.began_us).view()} + "/" + file);
    if (std::string_view{file} == "cloud.drc")
        return read_file(cloud_);
    return failure(Fault::kNoInput, "%s: there is the cloud alone", shown(cloud_).c_str());
}

json ViewBoard::snapshot_json(const SlotRow& row) const
{
    json told = {{"slot", slot_json(row)}, {"record", json()}, {"files", json::object()}};
    const Result<std::unique_ptr<Medium>> medium =
        folder_.empty() ? failure(Fault::kNoInput, "a cloud alone") : open_disk_medium(folder_);
    if (!medium.ok() || row.kept != Kept::kHere)
        return told;
    if (const Result<std::string> text = read_record_text(*medium.value(), row); text.ok())
        told["record"] = json::parse(text.value(), nullptr, false);
    else
        told["files"]["record.json"] = text.status().message();
    (void)check_snapshot(*medium.value(), row, [&told](const char* name, const Status& outcome) {
        told["files"][name] = outcome.ok() ? "ok" : outcome.message();
    });
    if (!told["record"].is_object())
        told["record"] = json();
    return told;
}

json ViewBoard::slots_json() const
{
    json sequence = json::array(), time_s = json::array(), reason = json::array(), reasons = json::array();
    std::string state;
    std::map<std::string, std::size_t, std::less<>> known;
    for (const SlotRow& row : slots_) {
        sequence.push_back(row.sequence);
        time_s.push_back(time_known_ && is_dated(row) ? json(row.began_us / 1'000'000) : json());
        state += state_letter(row);
        if (row.reason.view().empty()) {
            reason.push_back(-1);
            continue;
        }
        const auto [at, is_new] = known.try_emplace(std::string{row.reason.view()}, reasons.size());
        if (is_new)
            reasons.push_back(row.reason.view());
        reason.push_back(at->second);
    }
    return {{"sequence", sequence}, {"time_s", time_s}, {"state", state}, {"reason", reason}, {"reasons", reasons}};
}

} // namespace dicot::app

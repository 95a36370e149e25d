#include "store_words.h"

#include "shown.h"

#include "dicot/base/utc_time.h"
#include "dicot/medium/disk_medium.h"
#include "dicot/record/record.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

namespace dicot::app {
namespace {

namespace fs = std::filesystem;

/// As utc_day() has it.
bool is_day(const std::string& name)
{
    return parse_utc_text(name + "T00:00:00Z").has_value();
}

bool is_folder(const fs::directory_entry& entry)
{
    std::error_code error;
    return fs::is_directory(entry.symlink_status(error)) && !error;
}

/// "b-3" of "/srv/snapshots/b-3/".
std::string last_part(const std::string& path)
{
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(path, error);
    return error || !whole.has_filename() ? path : whole.filename().string();
}

Status cannot_read(const std::string& root, const std::error_code& error)
{
    return failure(Fault::kNoInput,
                   "%s: %s: name the folder of the snapshots with --store, or output.folder in the configuration",
                   shown(root).c_str(), error ? error.message().c_str() : "this is no folder");
}

Status find_devices(FoundStores& found)
{
    std::error_code error;
    fs::directory_iterator entry(found.root, error);
    for (; !error && entry != fs::directory_iterator{}; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!is_folder(*entry) || name == "lost+found") // the file system's own, which root alone may read
            continue;
        const Result<bool> is_device = is_device_folder(entry->path().string());
        if (!is_device.ok())
            found.unread.push_back({name, is_device.status()});
        else if (is_device.value())
            found.devices.push_back({name, entry->path().string()});
    }
    if (error)
        return cannot_read(found.root, error);
    std::ranges::sort(found.devices, {}, &DeviceFolder::device);
    std::ranges::sort(found.unread, {}, &UnreadFolder::name);
    return {};
}

} // namespace

Result<bool> is_device_folder(const std::string& path)
{
    int rooms = 0; // together: a board may be called "incoming"
    std::error_code error;
    for (fs::directory_iterator entry(path, error); !error && entry != fs::directory_iterator{};
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name == Store::kCatalogueName || (is_day(name) && is_folder(*entry)))
            return true;
        if ((name == "incoming" || name == "leaving") && is_folder(*entry) && ++rooms == 2)
            return true;
    }
    if (error)
        return failure(Fault::kNoInput, "%s: it cannot be read (%s), so nothing of it is told", shown(path).c_str(),
                       error.message().c_str());
    return false;
}

CLI::Validator slot_number()
{
    return {[](std::string& text) -> std::string {
                std::int64_t number = 0;
                const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
                if (error != std::errc{} || end != text.data() + text.size() || number < 1 || number > kMaxSequence)
                    return "give a number from 1 to 999,999,999";
                text = std::to_string(number); // what begins with 0 would be read as octal
                return {};
            },
            "1 to 999999999", "slot number"};
}

void StoreWords::add_to(CLI::App& command)
{
    command
        .add_option("--store", root,
                    "folder of the snapshots: of one board, or around the folders of several (default: output.folder)")
        ->type_name("DIR");
    command.add_option("--device", device, "this board's alone")->type_name("NAME");
    config.add_to(command);
}

Result<FoundStores> StoreWords::find() const
{
    FoundStores found;
    found.output = TRY(config.load()).config.output;
    found.root = root.empty() ? found.output.folder : root;
    std::error_code error;
    if (!fs::is_directory(found.root, error))
        return cannot_read(found.root, error);
    if (TRY(is_device_folder(found.root)))
        found.devices.push_back({last_part(found.root), found.root});
    else
        TRY(find_devices(found));
    if (device.empty())
        return found;
    std::erase_if(found.devices, [this](const DeviceFolder& one) { return one.device != device; });
    std::erase_if(found.unread, [this](const UnreadFolder& one) { return one.name != device; });
    if (found.devices.empty() && found.unread.empty())
        return failure(Fault::kNoInput, "%s: there are no snapshots of a board called %s: dicot list names the boards",
                       shown(found.root).c_str(), shown(device).c_str());
    return found;
}

StoreRules rules_of(const OutputConfig& output)
{
    StoreRules rules;
    rules.reserve_bytes = static_cast<std::uint64_t>(output.reserve_mib) << 20U;
    rules.prune = output.prune == "never" ? Prune::kNever : output.prune == "all" ? Prune::kAll : Prune::kPulled;
    return rules;
}

Result<std::optional<std::int64_t>> newest_time(Catalogue& catalogue)
{
    const std::int64_t last = TRY(catalogue.last_sequence());
    const std::optional<SlotRow> newest = TRY(catalogue.find(last));
    return newest ? std::optional{newest->began_us} : std::nullopt;
}

Result<ReadStore> ReadStore::open(const std::string& path)
{
    ReadStore read;
    read.medium = TRY(open_disk_medium(path));
    read.catalogue = TRY(read_catalogue(*read.medium, path + "/" + Store::kCatalogueName));
    return read;
}

Status all_days_told(const std::string& path)
{
    if (Catalogue::open(path + "/" + Store::kCatalogueName, Catalogue::Access::kRead).ok())
        return {};
    std::error_code error;
    for (fs::directory_iterator entry(path, error); !error && entry != fs::directory_iterator{};
         entry.increment(error)) {
        std::error_code closed;
        if (is_day(entry->path().filename().string()) && is_folder(*entry))
            (void)fs::directory_iterator(entry->path(), closed);
        if (closed)
            return failure(Fault::kIoError,
                           "%s: it cannot be read (%s), and there is no catalogue: its slots are not told",
                           shown(entry->path().string()).c_str(), closed.message().c_str());
    }
    return {};
}

Result<WrittenStore> WrittenStore::open(const std::string& path, const StoreRules& rules)
{
    WrittenStore written;
    written.medium = TRY(open_disk_medium(path));
    written.store = TRY(Store::open(*written.medium, rules, path + "/" + Store::kCatalogueName));
    return written;
}

} // namespace dicot::app

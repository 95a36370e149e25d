#include "diag_members.h"

#include "../store/slot_words.h"

#include "dicot/store/look.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <vector>

namespace dicot::app {
namespace {

/// What would stay out of sight of the catalogue: entries by folder, and of the day folders their number.
nlohmann::json folders(Medium& medium)
{
    nlohmann::json told = nlohmann::json::object();
    const auto count = [&medium](const char* path, auto counted) {
        int entries = 0;
        const Errno listed = medium.list(path, [&](const MediumEntry& entry) {
            entries += counted(entry) ? 1 : 0;
            return true;
        });
        return listed.ok() ? nlohmann::json(entries) : nlohmann::json();
    };
    const auto any = [](const MediumEntry&) { return true; };
    for (const char* name : {"incoming", "leaving", "quarantine"})
        told[name] = count(name, any);
    told["days"] = count(
        "", [](const MediumEntry& entry) { return entry.kind == EntryKind::kFolder && entry.name.starts_with("20"); });
    for (const char* name : {"writing", "ballast", "catalogue.sqlite", "catalogue.sqlite-wal"}) {
        EntryKind kind{};
        Medium::File file{};
        std::uint64_t bytes = 0;
        nlohmann::json size; // null: it is not there
        if (medium.kind_of(name, kind).ok() && kind == EntryKind::kFile && medium.open(name, file, bytes).ok()) {
            size = bytes;
            (void)medium.close(file);
        }
        told[std::string(name) + "_bytes"] = size;
    }
    MediumSpace space;
    if (medium.space(space).ok())
        told["free_bytes"] = space.free_bytes;
    return told;
}

/// A board's folder may be called anything.
std::string plain_name(const std::string& name)
{
    constexpr std::size_t kMost = 32;
    std::string plain;
    for (const char letter : name.substr(0, kMost)) {
        const bool fits = (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
                          (letter >= 'A' && letter <= 'Z') || letter == '-' || letter == '_';
        plain += fits ? letter : '_';
    }
    return plain.empty() ? "_" : plain;
}

} // namespace

Status add_board(DiagMembers& members, const DeviceFolder& device, std::int64_t records)
{
    const std::string folder = "boards/" + plain_name(device.device) + "/";
    const Result<ReadStore> opened = ReadStore::open(device.path);
    if (!opened.ok())
        return members.missing(folder + "store.json", opened.status().message());
    const ReadStore& store = opened.value();
    nlohmann::json facts = folders(*store.medium);
    facts["device"] = device.device;
    facts["path"] = device.path;
    TRY(members.put(folder + "store.json", json_text(facts) + "\n"));
    SlotQuery newest;
    newest.last = records;
    std::vector<SlotRow> rows;
    const Status listed = store.catalogue->for_each(newest, [&rows](const SlotRow& row) {
        rows.push_back(row);
        return true;
    });
    if (!listed.ok())
        return members.missing(folder + "records", listed.message());
    for (const SlotRow& row : rows) {
        char name[40];
        std::snprintf(name, sizeof name, "records/%06lld.json", static_cast<long long>(row.sequence));
        const Result<std::string> text = read_record_text(*store.medium, row);
        TRY(text.ok() ? members.put(folder + name, text.value())
                      : members.missing(folder + name, text.status().message()));
    }
    return {};
}

} // namespace dicot::app

#include "device_talk.h"

#include "dicot/store/snapshot_name.h"
#include "dicot/store/store.h"

#include <algorithm>

namespace dicot::app {

DeviceTalk::DeviceTalk(std::unique_ptr<mtp::UsbPipe> pipe, const mtp::MtpListed& listed,
                       const mtp::Initiator::Patience& patience)
    : pipe_(std::move(pipe)), initiator_(*pipe_, patience), serial_(listed.serial.view()),
      where_("USB " + std::string{listed.port.view()})
{
}

Status DeviceTalk::open()
{
    TRY(initiator_.open());
    if (serial_.empty())
        serial_ = initiator_.facts().serial.view();
    return {};
}

Status DeviceTalk::for_each_in(std::uint32_t storage, std::uint32_t folder, bool folders_alone, std::size_t most,
                               FunctionRef<bool(std::uint32_t, const mtp::ObjectFacts&)> visit)
{
    std::vector<std::uint32_t> handles;
    TRY(initiator_.children(storage, folder, folders_alone, handles));
    if (handles.size() > most)
        return failure(Fault::kBadData, "%s: a folder of the device holds %zu objects where at most %zu belong",
                       where_.c_str(), handles.size(), most);
    for (const std::uint32_t handle : handles) {
        if (++looks_ > kMostLooks)
            return failure(Fault::kBadData, "%s: the device shows more than %zu objects", where_.c_str(), kMostLooks);
        mtp::ObjectFacts facts;
        const Status asked = initiator_.object(handle, facts);
        if (asked.fault() == Fault::kNoInput)
            continue;
        TRY(asked);
        if (!visit(handle, facts))
            return {};
    }
    return {};
}

Status DeviceTalk::files_in(std::uint32_t storage, std::uint32_t folder, FunctionRef<bool(const OfferedFile&)> visit)
{
    constexpr std::size_t kMostFiles = Store::kMaxFiles + 1; // SHA256SUMS too
    begin_question();
    std::vector<OfferedFile> files;
    bool twice = false;
    TRY(for_each_in(storage, folder, false, kMostInSnapshot, [&](std::uint32_t handle, const mtp::ObjectFacts& facts) {
        const std::string_view name = facts.name.view();
        if (facts.folder || !is_file_name(name) || name == kPulledMark)
            return true; // of whoever copied the folder
        twice = twice || std::ranges::any_of(files, [&](const OfferedFile& file) { return file.name.view() == name; });
        files.push_back({name, facts.bytes, handle});
        return true;
    }));
    if (files.size() > kMostFiles || twice)
        return failure(Fault::kBadData, "%s: a snapshot's folder on the device holds %zu files%s", where_.c_str(),
                       files.size(), twice ? ", one of them twice" : "");
    for (const OfferedFile& file : files)
        if (!visit(file))
            return {};
    return {};
}

} // namespace dicot::app

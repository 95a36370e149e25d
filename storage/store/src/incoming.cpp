#include "incoming.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/sha256.h"

#include <cerrno>

namespace dicot {
namespace {

/// Hashes and counts what goes by.
class HashingSink final : public ByteSink
{
public:
    explicit HashingSink(ByteSink& file) : file_(file) {}

    Status write(std::span<const std::byte> bytes) noexcept override
    {
        stream_.update(bytes);
        count_ += bytes.size();
        return file_.write(bytes);
    }
    std::array<char, 65> digest() { return hex_of(stream_.finish()); }
    std::uint64_t count() const { return count_; }

private:
    ByteSink& file_;
    Sha256Stream stream_;
    std::uint64_t count_ = 0;
};

} // namespace

void Incoming::name_it(const PartName& part)
{
    const SnapshotName& name = part.name;
    part_ = join(kIncoming, part_name(part).view());
    day_ = utc_day(name.began_us).view();
    target_ = folder_of(name.sequence, name.began_us).view();
    sums_ = {};
    begun_ = false;
    whole_ = false;
}

void Incoming::adopt(const PartName& part, bool whole)
{
    name_it(part);
    begun_ = true;
    whole_ = whole;
}

Status Incoming::begin(const PartName& part)
{
    name_it(part);
    TRY(on_card(medium_.make_folder(part_.c_str()), part_.c_str(), "making a folder"));
    begun_ = true;
    return on_card(medium_.sync_folder(kIncoming), kIncoming, "syncing");
}

Status Incoming::add(const char* name, FunctionRef<Status(ByteSink&)> fill)
{
    if (!begun_ || !is_file_name(name) || std::string_view(name) == kSums || std::string_view(name) == kPulledMark)
        return failure(Fault::kSoftware, "%s: no snapshot is begun, or no file of it can be called so", name);
    const StorePath path = join(part_.view(), name);
    CardFile file(medium_);
    TRY(file.create(path));
    HashingSink sink(file);
    Status status = fill(sink);
    if (status.ok())
        status = file.close();
    if (status.ok() && !sums_.add(name, sink.digest().data()))
        status = failure(Fault::kSoftware, "%s: a snapshot has %d files at most", name, kMaxSums);
    if (status.ok())
        bytes_[static_cast<std::size_t>(sums_.count - 1)] = sink.count();
    else
        (void)medium_.remove_file(path.c_str()); // what is listed in no SHA256SUMS is not to stay
    return status;
}

void Incoming::for_each_added(FunctionRef<void(const Store::Added&)> visit) const
{
    for (std::size_t i = 0; i < static_cast<std::size_t>(sums_.count); ++i)
        visit({sums_.files[i].name, sums_.files[i].sha256, bytes_[i]});
}

Status Incoming::take_back()
{
    sums_ = {};
    return begun_ ? empty_folder(medium_, part_) : Status{};
}

Result<Incoming::Settled> Incoming::settle()
{
    if (!begun_ || (!whole_ && sums_.find(kRecord) == nullptr))
        return failure(Fault::kSoftware, "a snapshot is stored with its record.json, and after it was begun");
    Settled settled;
    TRY(write_sums(settled));
    TRY(sync_files());
    TRY(prepare_day());
    TRY(move_into_place());
    const Status synced = sync_day();
    if (!synced.ok())
        move_back();
    TRY(synced);
    return settled;
}

Status Incoming::write_sums(Settled& settled)
{
    if (whole_)
        return {};
    char text[kMaxSumsBytes + 1];
    const auto bytes = std::as_bytes(std::span(text, print_sums(sums_, text)));
    settled.sums = hex_of(sha256_of(bytes)).data();
    settled.bytes = static_cast<std::int64_t>(bytes.size());
    for_each_added([&](const Store::Added& added) { settled.bytes += static_cast<std::int64_t>(added.bytes); });
    const StorePath path = join(part_.view(), kSums);
    if (is_there(medium_, path.c_str())) // of an attempt that failed
        TRY(on_card(medium_.remove_file(path.c_str()), path.c_str(), "removing it"));
    return write_file(medium_, path, bytes);
}

/// One for all files.
Status Incoming::sync_files()
{
    return on_card(medium_.sync_all(), part_.c_str(), "syncing");
}

Status Incoming::prepare_day()
{
    const Errno made = medium_.make_folder(day_.c_str());
    if (made.number() == EEXIST)
        return {};
    TRY(on_card(made, day_.c_str(), "making a folder"));
    return on_card(medium_.sync_folder(""), "", "syncing");
}

Status Incoming::move_into_place()
{
    TRY(on_card(medium_.rename(part_.c_str(), target_.c_str()), target_.c_str(), "renaming"));
    begun_ = false;
    return {};
}

/// What may not last is not to be seen; it can be taken back.
void Incoming::move_back()
{
    begun_ = medium_.rename(target_.c_str(), part_.c_str()).ok();
}

Status Incoming::sync_day()
{
    return on_card(medium_.sync_folder(day_.c_str()), day_.c_str(), "syncing");
}

} // namespace dicot

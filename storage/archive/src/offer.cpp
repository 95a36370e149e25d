#include "offer.h"

#include "digest.h"

#include "dicot/os/sha256.h"
#include "dicot/pull_archive/board_archive.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace dicot {
namespace {

constexpr std::size_t kMostListed = 64; ///< whatever else lies in the folder

char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_on_any_disk(std::string_view a, std::string_view b)
{
    return std::ranges::equal(a, b, {}, lower, lower);
}

/// FAT knows no cases and forgets a dot at the end: names that would meet there are no names of a snapshot.
Status names_are_distinct(const Sums& sums)
{
    const auto files = sums.all();
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string_view name = files[i].name.view();
        bool meets = name.ends_with('.') || same_on_any_disk(name, kSums) || same_on_any_disk(name, kPulledMark);
        for (std::size_t k = 0; k < i; ++k)
            meets = meets || same_on_any_disk(name, files[k].name.view());
        if (meets)
            return failure(Fault::kBadData, "%s: %s: a name that cannot stand on every disk", kSums, name.data());
    }
    return {};
}

const OfferedFile* find(const std::vector<OfferedFile>& listed, std::string_view name)
{
    const auto at = std::ranges::find_if(listed, [&](const OfferedFile& file) { return file.name.view() == name; });
    return at == listed.end() ? nullptr : &*at;
}

Result<std::vector<OfferedFile>> list_files(PullSource& source, const OfferedSnapshot& offered)
{
    std::vector<OfferedFile> listed;
    bool too_many = false;
    TRY(source.files(offered, [&](const OfferedFile& file) {
        too_many = listed.size() == kMostListed;
        if (!too_many)
            listed.push_back(file);
        return !too_many;
    }));
    if (too_many)
        return failure(Fault::kBadData, "more than %zu files lie in the folder", kMostListed);
    return listed;
}

/// All of a small file.
Result<std::string> read_small(PullSource& source, const OfferedFile& file)
{
    if (file.bytes > kMaxSumsBytes)
        return failure(Fault::kBadData, "%s: it is larger than such a file can be", kSums);
    std::string text(static_cast<std::size_t>(file.bytes), '\0');
    const auto bytes = std::as_writable_bytes(std::span(text));
    for (std::size_t got = 0; got < bytes.size();) {
        const std::size_t more = TRY(source.read(file, got, bytes.subspan(got)));
        if (more == 0 || more > bytes.size() - got)
            return failure(Fault::kBadData, "%s: it ends too early", kSums);
        got += more;
    }
    return text;
}

} // namespace

Result<SnapshotName> name_of(const OfferedSnapshot& offered)
{
    const SnapshotName name{offered.sequence, offered.began_us};
    if (offered.sequence > 0 && parse_snapshot_name(snapshot_name(name).view()) == name)
        return name;
    return failure(Fault::kBadData, "number %lld: no snapshot has such a number and time",
                   static_cast<long long>(offered.sequence));
}

Result<Offer> read_offer(PullSource& source, const OfferedSnapshot& offered)
{
    const std::vector<OfferedFile> listed = TRY(list_files(source, offered));
    const OfferedFile* const sums_file = find(listed, kSums);
    if (sums_file == nullptr)
        return failure(Fault::kBadData, "%s: it is not there", kSums);
    Offer offer;
    offer.sums_text = TRY(read_small(source, *sums_file));
    offer.sums_sha256 = hex_of(sha256_of(std::as_bytes(std::span(offer.sums_text)))).data();
    if (offered.sums && digest_text(*offered.sums) != offer.sums_sha256)
        return failure(Fault::kBadData, "%s: its bytes are not those that were stored", kSums);
    Result<Sums> sums = parse_sums(offer.sums_text);
    if (!sums.ok())
        return failure(Fault::kBadData, "%s: %s", kSums, sums.status().message());
    offer.sums = sums.value();
    TRY(names_are_distinct(offer.sums));
    for (std::size_t k = 0; k < offer.sums.all().size(); ++k) {
        const std::string_view name = offer.sums.files[k].name.view();
        const OfferedFile* const file = find(listed, name);
        if (file == nullptr)
            return failure(Fault::kBadData, "%s: it is not there", name.data());
        if (file->bytes > BoardArchive::kMostFileBytes)
            return failure(Fault::kBadData, "%s: it is larger than such a file can be", name.data());
        offer.files[k] = *file;
        offer.bytes += file->bytes;
    }
    return offer;
}

} // namespace dicot

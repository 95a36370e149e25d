// Any bytes at all as the file of a catalogue, or as its write-ahead log.
#include "dicot/base/printable.h"
#include "dicot/catalogue/catalogue.h"
#include "dicot/record/record.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace {

using namespace dicot;

void require(bool promise)
{
    if (!promise)
        std::abort();
}

/// A folder in memory, if there is one.
const std::string& folder()
{
    static const std::string path = [] {
        struct stat status = {};
        std::string made =
            stat("/dev/shm", &status) == 0 ? "/dev/shm/dicot-fuzz-XXXXXX" : P_tmpdir "/dicot-fuzz-XXXXXX";
        require(mkdtemp(made.data()) != nullptr);
        static std::string kept = made;
        std::atexit([] {
            for (const char* const end : {"/c", "/c-wal", "/c-shm", "/c-journal", ""})
                (void)std::remove((kept + end).c_str());
        });
        return made;
    }();
    return path;
}

void put_file(const std::string& path, const std::uint8_t* data, std::size_t size)
{
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    require(file >= 0 && write(file, data, size) == static_cast<ssize_t>(size) && close(file) == 0);
}

void require_sound(const Status& status)
{
    require(status.ok() || status.fault() == Fault::kBadData || status.fault() == Fault::kIoError ||
            status.fault() == Fault::kOsError);
}

void ask(Catalogue& catalogue)
{
    std::int64_t last = INT64_MIN;
    const Status walked = catalogue.for_each({}, [&](const SlotRow& row) {
        require(row.sequence > last && row.sequence >= 1 && row.sequence <= kMaxSequence);
        require(row.bytes >= 0 && row.points >= 0 && is_printable(row.reason.view()));
        require(row.sums.empty() || row.sums.view().size() == 64);
        last = row.sequence;
        return true;
    });
    require_sound(walked);
    SlotQuery newest;
    newest.last = 3;
    newest.missed_only = true;
    require_sound(catalogue.for_each(newest, [](const SlotRow&) { return true; }));
    require_sound(catalogue.find(3).status());
    require_sound(catalogue.totals().status());
    require_sound(catalogue.pace().status());
    require_sound(catalogue.check());
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size == 0)
        return 0;
    // The first byte: how much of the rest is the file, in 255th; what remains is its log.
    const std::string path = folder() + "/c";
    const std::size_t of_file = (size - 1) * data[0] / 255;
    for (const auto access : {Catalogue::Access::kRead, Catalogue::Access::kWrite}) {
        for (const char* const end : {"-wal", "-shm", "-journal"})
            (void)std::remove((path + end).c_str());
        put_file(path, data + 1, of_file);
        if (of_file < size - 1)
            put_file(path + "-wal", data + 1 + of_file, size - 1 - of_file);
        const auto catalogue = Catalogue::open(path, access);
        require_sound(catalogue.status());
        if (!catalogue.ok())
            continue;
        ask(*catalogue.value());
        if (access == Catalogue::Access::kRead)
            continue;
        SlotRow row;
        row.sequence = 4;
        require_sound(catalogue.value()->put(row));
        const auto found = catalogue.value()->find(4);
        require(!found.ok() || (found.value() && *found.value() == row));
        ask(*catalogue.value());
    }
    return 0;
}

#include "record_sax.h"

#include "dicot/os/lent_heap.h"
#include "dicot/os/shown_path.h"

#include <exception>

namespace dicot {

Result<RecordFacts> read_record(std::span<const std::byte> text, const char* name, std::span<std::byte> heap)
{
    const auto refused = [&](const char* why) {
        return failure(Fault::kBadData, "%s: not a record that can be used (%s): dicot verify says what to do",
                       shown_path(name), why);
    };
    if (text.size() > kMaxRecordBytes)
        return refused("it is longer than 256 KiB");
    const LentHeap lent{heap};
    try {
        RecordSax sax;
        const auto* const begin = reinterpret_cast<const char*>(text.data());
        nlohmann::json::sax_parse(begin, begin + text.size(), &sax);
        if (const char* complaint = sax.complaint(); complaint != nullptr)
            return refused(complaint);
        return sax.facts();
    } catch (const std::exception&) { // only of memory: the reader's own errors come as a call
        return refused("reading it takes more memory than a record does");
    }
}

} // namespace dicot

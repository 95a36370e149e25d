// Any bytes at all as a record.json.
#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"
#include "dicot/record/record.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

namespace {

void require(bool promise)
{
    if (!promise)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    static std::vector<std::byte> heap(kRecordHeapBytes);
    const Result<RecordFacts> read = read_record(std::as_bytes(std::span{data, size}), "fuzz", heap);
    if (!read.ok()) {
        require(read.status().fault() == Fault::kBadData);
        require(std::strncmp(read.status().message(), "fuzz: ", 6) == 0);
        return 0;
    }
    const RecordFacts& facts = read.value();
    require(facts.sequence >= 1 && facts.sequence <= kMaxSequence);
    require(facts.points >= 0 && facts.points <= kMaxRecordPoints);
    require(facts.began_us >= kFirstUtcUs && facts.began_us <= kLastUtcUs);
    require(is_printable(facts.reason.view()) && is_printable(facts.clock_trust.view()));

    // What was understood can be said in dicot's own words, and is understood again.
    char text[kMaxPlainRecordBytes];
    const std::size_t written = write_plain_record(facts, "fuzz", text);
    require(written > 0);
    const Result<RecordFacts> again = read_record(std::as_bytes(std::span{text, written}), "fuzz", heap);
    RecordFacts expected = facts;
    if (!facts.done)
        expected.points = 0; // a miss has no cloud
    require(again.ok() && again.value() == expected);
    return 0;
}

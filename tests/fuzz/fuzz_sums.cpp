// Any text as SHA256SUMS, as the mark of a pull and as a folder's name: refused, or exactly what dicot would write, and
// never a name that leads out of its folder.
#include "folder_name.h"
#include "pulled_mark.h"

#include "dicot/base/utc_time.h"
#include "dicot/store/sums.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

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
    const std::string_view text{static_cast<const char*>(static_cast<const void*>(data)), size};
    if (const Result<Sums> sums = parse_sums(text); sums.ok()) {
        char printed[kMaxSumsBytes + 1];
        require(std::string_view(printed, print_sums(sums.value(), printed)) == text);
        for (const Sum& sum : sums.value().all())
            require(sum.name.view().find('/') == std::string_view::npos && sum.name.view()[0] != '.');
    }
    if (const Result<PulledMark> mark = parse_pulled(text); mark.ok())
        require(print_pulled(mark.value()).view() == text);
    if (const auto name = parse_snapshot_name(text)) {
        require(snapshot_name(*name).view() == text);
        require(is_day_name(utc_day(name->began_us).view()));
    }
    if (const auto part = parse_part_name(text))
        require(part_name(*part).view() == text);
    if (is_day_name(text))
        require(text.find('/') == std::string_view::npos);
    return 0;
}

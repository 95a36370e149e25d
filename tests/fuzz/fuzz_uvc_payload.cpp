// Any bytes at all as payloads of a stream. The first four bytes choose the rules; then every chunk has a byte of its
// own in front: its length (low 7 bits), and whether it ends a payload (bit 7); length 127 is a loss, 126 no buffer for
// once.
#include "dicot/uvc_parse/payload.h"
#include "dicot/uvc_parse/stream_control.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

namespace {

void require(bool promise)
{
    if (!promise)
        std::abort();
}

constexpr std::size_t kRoom = 64;
constexpr std::byte kGuard{0xA5};

struct Desk
{
    std::array<std::byte, kRoom + 32> memory{};
    std::size_t room = kRoom;
    bool has_buffer = false;

    std::span<std::byte> buffer() { return std::span{memory}.first(room); }
    bool guarded() const
    {
        return std::all_of(memory.begin() + static_cast<std::ptrdiff_t>(room), memory.end(),
                           [](std::byte one) { return one == kGuard; });
    }
};

void require_sound(const dicot::AssembledFrame& frame, const Desk& desk, const dicot::PayloadRules& rules)
{
    using namespace dicot;
    require(frame.bytes <= desk.room);
    require(std::memchr(frame.flaw, 0, sizeof frame.flaw) != nullptr);
    require((frame.verdict == FrameVerdict::kWhole) == (frame.flaw[0] == '\0'));
    if (frame.verdict != FrameVerdict::kWhole)
        return;
    require(frame.bytes > 0);
    require(rules.exact_bytes == 0 || frame.bytes == rules.exact_bytes);
    require(!rules.jpeg ||
            (frame.bytes >= 4 && desk.memory[0] == std::byte{0xFF} && desk.memory[1] == std::byte{0xD8}));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    const auto all = std::as_bytes(std::span{data, size});
    static_cast<void>(read_stream_control(all).ok());
    if (size < 4)
        return 0;
    const PayloadRules rules{(data[0] & 1) != 0, data[1] % (kRoom + 8u), data[2], data[3] * 1'000'000u};
    Desk desk;
    desk.memory.fill(kGuard);
    desk.room = kRoom - (data[0] >> 1) % kRoom;
    FrameAssembler assembler;
    assembler.restart(rules);
    bool withhold = false;
    std::int64_t now_us = 1'000'000'000;
    for (std::size_t at = 4; at < size;) {
        const std::size_t length = data[at] & 0x7Fu;
        const bool last = (data[at] & 0x80) != 0;
        ++at;
        if (length == 127) {
            assembler.lose("lost packet");
            continue;
        }
        if (length == 126) {
            withhold = true;
            continue;
        }
        const auto chunk = all.subspan(at, std::min(length, size - at));
        at += chunk.size();
        now_us += 125;
        int rounds = 0;
        for (;;) {
            require(++rounds <= 2); // a payload closes one frame before it at most
            if (!withhold)
                assembler.use(desk.buffer());
            const FrameAssembler::Fed fed = assembler.feed(chunk, last, now_us);
            require(desk.guarded());
            if (fed != FrameAssembler::Fed::kMore) {
                require_sound(assembler.closed(), desk, rules);
                require(assembler.closed().start_us <= now_us);
                require(!assembler.under_way());
                withhold = false;
            }
            if (fed != FrameAssembler::Fed::kClosedBefore)
                break;
        }
    }
    const bool under_way = assembler.under_way();
    require((assembler.cancel("the end") == FrameAssembler::Fed::kClosed) == under_way);
    require(!under_way || assembler.closed().verdict == FrameVerdict::kCancelled);
    return 0;
}

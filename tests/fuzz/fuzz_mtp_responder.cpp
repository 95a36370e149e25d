// Any bytes at all as what a host sends, and any moment at which it cancels, resets or goes.
#include "dicot/mtp/responder.h"

#include "mtp_memory_shelf.h"

#include <cstdlib>

namespace {

using namespace dicot;

void require(bool promise)
{
    if (!promise)
        std::abort();
}

/// The input is a row of: what happens (1 byte), how much of it (2 bytes, little-endian), bytes.
class FuzzLink final : public mtp::DeviceLink
{
public:
    explicit FuzzLink(std::span<const std::byte> script) : script_(script) {}

    Result<std::size_t> receive(std::span<std::byte> into, int patience_ms) override
    {
        require(into.size() % 512 == 0 && !into.empty());
        require(current_.empty()); // nobody listens with half a transfer on its way
        if (rest_.empty() && !next_step(patience_ms < 0))
            return fault_;
        const std::size_t size = std::min(rest_.size(), into.size());
        std::copy_n(rest_.begin(), size, into.begin());
        if (size >= 12 && into[4] == std::byte{1} && into[5] == std::byte{0})
            ++commands_;
        rest_ = rest_.subspan(size);
        return size;
    }
    Status send(std::span<const std::byte> bytes, bool last) override
    {
        require(last || (bytes.size() % 512 == 0 && !bytes.empty()));
        require(bytes.size() <= mtp::Exchange::kPieceBytes);
        if (cancel_in_ >= 0 && cancel_in_-- == 0) {
            interrupted_ = true;
            current_ = {};
            return failure(Fault::kIoError, "cancelled");
        }
        if (current_.bytes == 0) {
            require(bytes.size() >= 12);
            current_ = {mtp::read_header(bytes).value(), 0};
        }
        current_.bytes += bytes.size();
        const mtp::Header& header = current_.header;
        require(header.is(mtp::ContainerType::kData) || header.is(mtp::ContainerType::kResponse));
        require(header.length == mtp::kUnknownLength || current_.bytes <= header.length);
        if (last)
            end_of_transfer();
        return {};
    }
    void post_event(std::span<const std::byte> container) override
    {
        require(container.size() == 16 && container[4] == std::byte{4});
        ++events;
    }
    bool interrupted() const override { return interrupted_; }
    void begin_transaction(std::uint32_t id) override
    {
        id_ = id;
        interrupted_ = false;
        data_phases_ = responses_ = 0;
        require(!in_transaction_ && commands_ > 0);
        in_transaction_ = true;
    }
    void end_transaction() override
    {
        require(in_transaction_);
        in_transaction_ = interrupted_ = false;
        current_ = {};
    }
    bool take_reset() override { return std::exchange(reset_, false); }

    std::uint64_t events = 0, responses = 0;
    std::uint64_t commands() const { return commands_; }

private:
    struct Transfer
    {
        mtp::Header header;
        std::uint64_t bytes = 0;
        bool empty() const { return bytes == 0; }
    };

    void end_of_transfer()
    {
        const mtp::Header& header = current_.header;
        require(in_transaction_ && header.transaction == id_ && responses_ == 0);
        if (header.is(mtp::ContainerType::kResponse)) {
            require(current_.bytes == header.length && header.length <= mtp::kMostBlockBytes);
            // Data that fell short of what was announced are never called good.
            require(!short_ || header.code != mtp::response::kOk);
            ++responses_;
            ++responses;
        } else {
            require(data_phases_ == 0);
            ++data_phases_;
            short_ = header.length != mtp::kUnknownLength && current_.bytes < header.length;
        }
        if (responses_ > 0)
            short_ = false;
        current_ = {};
    }

    bool next_step(bool waits)
    {
        while (script_.size() >= 3) {
            const auto what = static_cast<unsigned>(script_[0]);
            const std::size_t size = static_cast<std::size_t>(script_[1]) | static_cast<std::size_t>(script_[2]) << 8;
            script_ = script_.subspan(3);
            switch (what % 8) {
            case 5: // silence, then nothing: only where the wait has an end
                if (waits)
                    continue;
                fault_ = failure(Fault::kTryAgain, "silence");
                return false;
            case 6:
                cancel_in_ = static_cast<int>(size % 8);
                continue;
            case 7:
                reset_ = true;
                interrupted_ = in_transaction_;
                fault_ = failure(Fault::kIoError, "reset");
                return false;
            default:
                rest_ = script_.first(std::min(size, script_.size()));
                script_ = script_.subspan(rest_.size());
                return true;
            }
        }
        fault_ = failure(Fault::kUnavailable, "unplugged");
        return false;
    }

    std::span<const std::byte> script_, rest_;
    Transfer current_;
    Status fault_;
    std::uint32_t id_ = 0;
    std::uint64_t commands_ = 0;
    int cancel_in_ = -1, data_phases_ = 0, responses_ = 0;
    bool interrupted_ = false, reset_ = false, in_transaction_ = false, short_ = false;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr std::uint32_t kFiles = 20;
    constexpr std::uint64_t kMostCalls = 40 * (kFiles + 3); ///< of one request
    static std::vector<std::byte> room(mtp::Responder::kRoomBytes);
    test::MemoryShelf shelf;
    shelf.folder(1, 0, "board", 1'772'366'400'000'000);
    shelf.folder(0x80005021, 1, "2026-03-01");
    shelf.folder(0x10, 0x80005021, "000001_120000Z");
    for (std::uint32_t i = 0; i < kFiles; ++i)
        shelf.file(0x11 + i, 0x10, i % 2 == 0 ? "left.png" : "record.json", i * i * i * 100);
    shelf.notes.push_back({1, 0, 1, 0x10, 20, false, {}});
    if (size > 0 && data[0] % 4 == 0) {
        shelf.read_fault = data[0] % 8 == 0 ? Fault::kNoInput : Fault::kIoError;
        shelf.read_fault_at = static_cast<std::uint64_t>(data[0]) * 1500;
    }
    FuzzLink link{std::as_bytes(std::span{data, size}).subspan(size > 0 ? 1 : 0)};
    mtp::Responder responder{shelf, link, {"dicot", "stereo", "1", "S", "board"}, room};
    for (;;) {
        shelf.calls = 0;
        shelf.changes.assign(100, {0x11, true});
        const std::uint64_t events = link.events;
        const Status status = responder.serve_one();
        require(shelf.calls <= kMostCalls);
        require(link.events - events <= 2 * (mtp::Responder::kMostEvents + 1));
        if (!status.ok()) {
            require(status.fault() == Fault::kUnavailable && !responder.counts().session_open);
            break;
        }
    }
    require(link.responses <= link.commands() && responder.counts().requests <= link.commands());
    return 0;
}

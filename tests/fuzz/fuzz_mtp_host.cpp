// Any device at all at the other end of the cable. Each record is one transfer of it: a byte of kind (highest two bits)
// and length, and as many bytes. What it says of kind "data" and "response" has a proper header, as only the content is
// then looked at; "raw" is sent as it is; after the last record it is silent.
#include "pull/device_source.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace {

using namespace dicot;

void require(bool promise)
{
    if (!promise)
        std::abort();
}

enum Kind : unsigned
{
    kData,     ///< of the operation that was asked, and a response of OK behind it
    kResponse, ///< with the code 0x2000 + first byte
    kRaw,
    kTrouble, ///< first byte: which
};

class AnyDevice final : public mtp::UsbPipe
{
public:
    AnyDevice(std::span<const std::uint8_t> script, int& receives, int& records)
        : script_(script), receives_(receives), records_(records)
    {
    }

    std::size_t packet_bytes() const override { return 512; }
    Status send(std::span<const std::byte> bytes, int) override
    {
        require(bytes.size() >= 12);
        std::copy_n(bytes.begin(), 12, command_.begin());
        response_due_ = false;
        return {};
    }
    Result<Piece> receive(std::span<std::byte> into, int) override
    {
        ++receives_;
        require(!into.empty() && into.size() % 1024 == 0);
        if (response_due_) {
            response_due_ = false;
            return put(header(3, 0x2001, 12), {}, into);
        }
        if (script_.empty())
            return failure(Fault::kTryAgain, "silence");
        ++records_;
        const unsigned kind = script_[0] >> 6;
        std::size_t length = script_[0] & 0x3Fu;
        script_ = script_.subspan(1);
        if (length == 0x3F && !script_.empty()) { // more than fits the byte
            length = std::size_t{8} * script_[0];
            script_ = script_.subspan(1);
        }
        const auto content = std::as_bytes(script_.first(std::min(length, script_.size())));
        script_ = script_.subspan(content.size());
        const unsigned first = content.empty() ? 1 : std::to_integer<unsigned>(content[0]);
        switch (kind) {
        case kData:
            response_due_ = true;
            return put(header(2, code(), static_cast<std::uint32_t>(12 + content.size())), content, into);
        case kResponse:
            return put(header(3, 0x2000 + first, 12), {}, into);
        case kRaw:
            return put({}, content, into);
        default:
            constexpr Fault kTroubles[] = {Fault::kTryAgain, Fault::kIoError, Fault::kIoError, Fault::kUnavailable};
            return failure(kTroubles[first & 3], "trouble");
        }
    }
    Status cancel(std::uint32_t) override { return {}; }
    Status reset() override { return {}; }
    Result<std::uint16_t> status() override { return std::uint16_t{0x2001}; }
    void clear_halts() override {}

private:
    unsigned code() const
    {
        return std::to_integer<unsigned>(command_[6]) | std::to_integer<unsigned>(command_[7]) << 8;
    }
    std::array<std::byte, 12> header(unsigned kind, unsigned code, std::uint32_t length) const
    {
        std::array<std::byte, 12> bytes = command_; // the transaction
        for (std::size_t i = 0; i < 4; ++i)
            bytes[i] = static_cast<std::byte>(length >> (8 * i) & 0xFF);
        bytes[4] = static_cast<std::byte>(kind);
        bytes[5] = std::byte{0};
        bytes[6] = static_cast<std::byte>(code & 0xFF);
        bytes[7] = static_cast<std::byte>(code >> 8 & 0xFF);
        return bytes;
    }
    static Result<Piece> put(std::span<const std::byte> header, std::span<const std::byte> content,
                             std::span<std::byte> into)
    {
        std::size_t used = 0;
        for (const auto part : {header, content})
            for (const std::byte one : part)
                if (used < into.size())
                    into[used++] = one;
        return Piece{used, used % 512 != 0 || used == 0};
    }

    std::span<const std::uint8_t> script_;
    int& receives_;
    int& records_;
    std::array<std::byte, 12> command_{};
    bool response_due_ = false;
};

bool is_plain(std::string_view name, std::size_t most)
{
    return !name.empty() && name.size() <= most && name[0] != '.' && std::ranges::all_of(name, [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '_' ||
               c == '-';
    });
}

void read_some(PullSource& source, const OfferedFile& file)
{
    std::array<std::byte, 96> room;
    room.fill(std::byte{0xA5});
    const auto into = std::span{room}.first(64);
    for (const std::uint64_t offset : {0u, 40u, 3u}) {
        const Result<std::size_t> got = source.read(file, offset, into);
        require(!got.ok() || got.value() <= 64);
        require(!got.ok() || got.value() == std::min<std::uint64_t>(64, file.bytes - std::min(file.bytes, offset)));
        require(std::ranges::all_of(std::span{room}.subspan(64), [](std::byte one) { return one == std::byte{0xA5}; }));
    }
}

void pull(PullSource& source)
{
    require(is_plain(source.device(), 63));
    std::vector<OfferedSnapshot> offers;
    std::int64_t last = 0;
    const Status listed = source.snapshots(1, [&](const OfferedSnapshot& offer) {
        require(offer.sequence >= 1 && offer.sequence >= last && offer.sequence <= 999'999'999);
        require(offer.began_us % 1'000'000 == 0);
        last = offer.sequence;
        offers.push_back(offer);
        return offers.size() < 8;
    });
    static_cast<void>(listed.ok());
    for (const OfferedSnapshot& offer : offers) {
        std::vector<OfferedFile> files;
        const Status told = source.files(offer, [&](const OfferedFile& file) {
            require(is_plain(file.name.view(), 31));
            files.push_back(file);
            return true;
        });
        require(files.size() <= 9);
        if (told.fault() == Fault::kUnavailable)
            return;
        for (const OfferedFile& file : files)
            read_some(source, file);
    }
    const PullSource::Pulled mark{last, {}};
    static_cast<void>(source.mark({&mark, 1}).ok());
    static_cast<void>(source.offer_time(0).ok());
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    int receives = 0, records = 0, calls = 1;
    {
        auto device = std::make_unique<AnyDevice>(std::span{data, size}, receives, records);
        Result<app::PullSources> sources = app::sources_behind(std::move(device), {}, {1000, 0, 0});
        if (sources.ok())
            for (const auto& source : sources.value()) {
                calls += 8 * 4 * 9 + 16;
                pull(*source);
            }
    }
    // Whoever is silent is asked a bounded number of times for each thing that he said, and for each that is wanted.
    require(receives <= 40 * (records + calls));
    return 0;
}

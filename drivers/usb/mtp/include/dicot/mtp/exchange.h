// One transaction's transfers: commands in, data one way, a response out; in memory that was lent.
#pragma once

#include "dicot/base/byte_sink.h"
#include "dicot/mtp/container.h"
#include "dicot/mtp/device_link.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot::mtp {

/// Three pieces of the room go round on their way to the host, the fourth takes what it sends. Never sends more data
/// than it announced. After a fault of the link nothing more is sent until the next command.
class Exchange final : public ByteSink
{
public:
    static constexpr std::size_t kPieceBytes = std::size_t{128} << 10;
    static constexpr std::size_t kPieces = DeviceLink::kMostUnderWay + 1;
    static constexpr std::size_t kRoomBytes = (kPieces + 1) * kPieceBytes;

    Exchange(DeviceLink& link, std::span<std::byte> room) noexcept;

    /// What the host sent where a command is expected. Data that nobody waits for (of an operation that was refused)
    /// and packets of none are passed over.
    enum class Came
    {
        kCommand,
        kBroken, ///< says that it is a command, and is not sound: command() has its transaction and code 0
        kNothing,
    };
    Result<Came> next(int patience_ms);
    const Block& command() const noexcept { return command_; }

    /// The data that the host sends after the command. Response code: kOk; what is wrong with it (all of it is taken in
    /// then); 0: there is nobody to answer, for the link failed, or the next command came in its place.
    std::uint16_t take_data(std::size_t most_bytes, std::span<const std::byte>& data);

    /// `bytes` of data will follow.
    void begin_data(std::uint64_t bytes) noexcept;
    /// Where the next bytes may be put, never empty before all of them are there; filled() tells how many were.
    std::span<std::byte> place() noexcept;
    Status filled(std::size_t bytes);
    /// The same for bytes that lie elsewhere. More than was announced: Fault::kSoftware, and the rest is left out.
    Status write(std::span<const std::byte> bytes) noexcept override;
    /// Where data may be put whose size is not known before: begin_data() and filled() follow, of the same size.
    std::span<std::byte> aside() noexcept { return piece().subspan(kHeaderBytes); }
    /// Forgets data of which nothing has left; false: some has.
    bool take_back() noexcept;
    /// Whether the host gets all that was announced. If not, its transfer ends early, with a short packet.
    bool end_data();

    void respond(const Block& response);

    /// The link's fault since the command came, or that the host has cancelled it.
    const Status& fault() noexcept;
    std::uint64_t bytes_sent() const noexcept { return bytes_sent_; }
    /// The host is gone.
    void forget() noexcept;

private:
    std::span<std::byte> piece() const noexcept;
    std::span<std::byte> inbox() const noexcept;
    Result<std::size_t> receive(std::size_t at, std::size_t bytes);
    void pass_over(const Header& header, std::size_t came);
    Status flush(bool last);

    DeviceLink& link_;
    std::span<std::byte> room_;
    Block command_;
    std::optional<Block> next_command_; ///< came in place of data
    std::size_t piece_ = 0;             ///< the one that is filled
    std::size_t used_ = 0;              ///< of it
    std::uint64_t left_ = 0;            ///< announced, and not yet in a piece
    bool left_already_ = false;         ///< some of this data has left
    std::uint64_t bytes_sent_ = 0;
    Status fault_;
};

} // namespace dicot::mtp

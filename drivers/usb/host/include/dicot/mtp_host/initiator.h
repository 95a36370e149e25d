// Picture Transfer Protocol with Microsoft's extension for media, the computer's side, for reading alone.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/mtp/snapshot_bytes.h"
#include "dicot/mtp_host/usb_pipe.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace dicot::mtp {

class Conversation;

/// What a device says of itself; texts are printable.
struct DeviceFacts
{
    ShortText<63> manufacturer, model, version, serial;
    bool partial = false;                                                  ///< GetPartialObject
    bool partial_64 = false;                                               ///< Android's GetPartialObject64
    bool lists_snapshots = false, takes_marks = false, takes_time = false; ///< dicot's own operations
};

struct ObjectFacts
{
    std::uint32_t parent = 0;
    bool folder = false;
    std::uint64_t bytes = 0; ///< of a file; kTooLarge: 4 GiB or more
    ShortText<255> name;     ///< UTF-8, cut; as it came: not checked
};

/// One conversation. The device is hostile: whatever it sends, every call ends, in memory that is stated here. A
/// transaction that breaks is cancelled, the device reset and the session opened anew, kMostRecoveries times in a row;
/// then Fault::kBadData (it answers nonsense), kUnavailable (it is gone, or silent). Other faults: kNoInput (no such
/// object), kTryAgain (busy; or, where handles belong to the session, the session broke: session() is another one now),
/// kUsage (it cannot, or may not; or a person asked for the end), kIoError (it says that it failed).
class Initiator
{
public:
    static constexpr std::size_t kPieceBytes = std::size_t{1} << 20; ///< of an object at once
    static constexpr std::size_t kRoomBytes = kPieceBytes + 4096;
    static constexpr std::size_t kMostHandles = std::size_t{1} << 18; ///< in one folder
    static constexpr std::size_t kMostStorages = 16;
    static constexpr std::size_t kMostNotes = 1024; ///< snapshots asked for at once
    static constexpr std::size_t kMostMarks = kMostPulledNotes;
    static constexpr std::uint64_t kTooLarge = 0xFFFFFFFF;
    static constexpr int kPatienceMs = 60'000; ///< without a byte
    static constexpr int kMostRecoveries = 3;

    /// What it waits for, in milliseconds; tests and fuzzers have less.
    struct Patience
    {
        int answer_ms = kPatienceMs;
        int drain_ms = 200;   ///< for what is left of a transaction that broke
        int pause_ms = 100;   ///< between two questions whether a reset device is ready
        int open_ms = 15'000; ///< for OpenSession: who is silent then is not there
    };

    explicit Initiator(UsbPipe& pipe, const Patience& patience);
    explicit Initiator(UsbPipe& pipe) : Initiator(pipe, Patience{}) {}
    Initiator(const Initiator&) = delete;
    Initiator& operator=(const Initiator&) = delete;
    ~Initiator();

    /// Opens the session, whatever somebody else left behind, and asks what the device is.
    Status open();
    /// As far as the device still answers.
    void close() noexcept;

    const DeviceFacts& facts() const noexcept { return facts_; }
    /// Counts sessions: in another one, handles of devices that are not ours may mean something else.
    unsigned session() const noexcept { return sessions_; }

    Status storages(std::vector<std::uint32_t>& into);
    /// The handles in a folder, `parent` 0: at the top of the storage; folders alone if the device can tell them apart.
    Status children(std::uint32_t storage, std::uint32_t parent, bool folders_alone, std::vector<std::uint32_t>& into);
    Status object(std::uint32_t handle, ObjectFacts& into);
    /// Of a file of `bytes` bytes from `offset` on; fewer than asked for only at its end. A device that knows no
    /// partial reads is read as a whole, and one call goes on where the one before it ended.
    Result<std::size_t> read(std::uint32_t handle, std::uint64_t bytes, std::uint64_t offset,
                             std::span<std::byte> into);

    /// Complete snapshots from number `first` on, in ascending order, at most kMostNotes of them; none: that is all.
    Status list_snapshots(std::int64_t first, std::vector<SnapshotNote>& into);
    /// At most kMostMarks.
    Status mark_pulled(std::span<const PulledNote> pulled);
    Status offer_time(const TimeOffer& offer);

private:
    struct Request;
    struct Answer;

    Status hear(Answer& answer);
    Status say(const Request& request, Answer& answer);
    Status ask(const Request& request, Answer& answer);
    Status ask_well(const Request& request, Answer& answer);
    Status open_session();
    Status say_open_session();
    Status recover(const Status& why);
    Status await_ready();
    Status learn();
    Status go_on_in_new_session() const;
    Status read_part(std::uint32_t handle, std::uint64_t offset, std::span<std::byte> into, std::size_t& got);
    Status read_stream(std::uint32_t handle, std::uint64_t bytes, std::uint64_t offset, std::span<std::byte> into);
    Status try_stream(std::uint32_t handle, std::uint64_t bytes, std::uint64_t offset, std::span<std::byte> into);
    bool goes_on(std::uint32_t handle, std::uint64_t bytes, std::uint64_t offset) const;
    Status take_stream(std::span<std::byte> into);
    Status begin_stream(std::uint32_t handle, std::uint64_t bytes);
    Status end_stream();
    std::span<std::byte> table() const noexcept;

    /// A whole object on its way: the transaction stays open between two calls.
    struct Stream
    {
        std::uint32_t handle = 0; ///< 0: none
        std::uint64_t bytes = 0, at = 0;
    };

    UsbPipe& pipe_;
    Patience patience_;
    std::unique_ptr<Conversation> talk_;
    std::unique_ptr<std::byte[]> table_; ///< the dataset that was read last
    DeviceFacts facts_;
    Stream stream_;
    unsigned sessions_ = 0;
    int failures_ = 0; ///< in a row
    bool filters_ = true;
};

} // namespace dicot::mtp

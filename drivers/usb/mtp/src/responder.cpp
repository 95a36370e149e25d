#include "dicot/mtp/responder.h"

namespace dicot::mtp {
namespace {

/// A host that asks without a pause keeps no events waiting for longer than so many requests.
constexpr int kRequestsBetweenLooks = 256;

/// FNV-1a: tells boards apart, no more.
std::uint64_t mark_of(std::string_view text) noexcept
{
    std::uint64_t mark = 0xCBF29CE484222325;
    for (const char c : text)
        mark = (mark ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    return mark;
}

} // namespace

Responder::Responder(ObjectSource& objects, DeviceLink& link, const DeviceWords& words,
                     std::span<std::byte> room) noexcept
    : objects_(objects), link_(link), words_(words), exchange_(link, room),
      persistent_half_(mark_of(words.serial.view()))
{
}

void Responder::forget() noexcept
{
    session_ = 0;
    counts_.session_open = false;
    exchange_.forget();
}

Status Responder::serve_one()
{
    if (link_.take_reset())
        forget();
    const Result<Exchange::Came> came = exchange_.next(kIdleMs);
    Status fault = came.status();
    if (fault.fault() == Fault::kTryAgain) {
        tell_changes();
        return {};
    }
    if (came.ok() && came.value() != Exchange::Came::kNothing) {
        serve(exchange_.command());
        fault = exchange_.fault();
    }
    if (link_.take_reset())
        forget();
    if (fault.ok() || fault.fault() == Fault::kIoError)
        return {};
    forget();
    return failure(Fault::kUnavailable, "%s", fault.message());
}

void Responder::serve(const Block& command)
{
    ++counts_.requests;
    link_.begin_transaction(command.transaction);
    const Reply reply = command.code == 0 ? Reply{response::kGeneralError, {}} : answer(command);
    if (reply.code != response::kOk && reply.code != 0)
        ++counts_.refused;
    if (reply.code != 0 && exchange_.fault().ok()) {
        Block block{reply.code, command.transaction, {reply.parameter.value_or(0)}, reply.parameter ? 1u : 0u};
        exchange_.respond(block);
    }
    if (exchange_.fault().fault() == Fault::kIoError)
        ++counts_.cancelled;
    counts_.bytes_sent = exchange_.bytes_sent();
    link_.end_transaction();
}

Responder::Reply Responder::answer(const Block& command)
{
    const bool before_session = command.code == operation::kGetDeviceInfo || command.code == operation::kOpenSession;
    if (session_ == 0 && !before_session)
        return refuse(command);
    if (++requests_since_look_ >= kRequestsBetweenLooks)
        tell_changes();
    for (const Operation& one : operations())
        if (one.code == command.code)
            return (this->*one.answer)(command);
    return refuse(command);
}

Responder::Reply Responder::refuse(const Block& command)
{
    // What the host sends after the command would stand where the next command is looked for.
    std::span<const std::byte> unwanted;
    if (takes_data(command.code) && exchange_.take_data(0, unwanted) == 0)
        return {0, {}};
    if (session_ == 0)
        return {response::kSessionNotOpen, {}};
    return {writes_to_store(command.code) ? response::kStoreReadOnly : response::kOperationNotSupported, {}};
}

void Responder::tell_changes()
{
    requests_since_look_ = 0;
    int told = 0;
    const auto post = [&](std::uint16_t code, std::uint32_t parameter) {
        std::array<std::byte, kMostBlockBytes> bytes;
        const std::size_t size = write_block(ContainerType::kEvent, {code, kNoTransaction, {parameter}, 1}, bytes);
        link_.post_event(std::span{bytes}.first(size));
    };
    // A look that fails is the source's to tell; the next one finds what it missed.
    static_cast<void>(objects_.refresh([&](const ObjectSource::Change& change) {
        if (session_ == 0 || told > kMostEvents)
            return;
        if (++told > kMostEvents)
            post(event::kStorageInfoChanged, kStorage);
        else
            post(change.added ? event::kObjectAdded : event::kObjectRemoved, change.handle);
    }));
}

std::uint16_t Responder::code_of(const Status& status) noexcept
{
    switch (status.fault()) {
    case Fault::kOk:
        return response::kOk;
    case Fault::kNoInput:
        return response::kInvalidObjectHandle;
    case Fault::kUsage:
        return response::kAccessDenied;
    case Fault::kBadData:
        return response::kInvalidDataset;
    case Fault::kTryAgain:
        return response::kDeviceBusy;
    default:
        return response::kGeneralError;
    }
}

Responder::Reply Responder::send_data(std::uint64_t bytes, FunctionRef<Status(DataWriter&)> write)
{
    exchange_.begin_data(bytes);
    DataWriter out{exchange_};
    const Status written = write(out);
    const bool whole = exchange_.end_data();
    return {written.ok() && out.status().ok() && whole ? response::kOk : response::kIncompleteTransfer, {}};
}

Responder::Reply Responder::send_dataset(FunctionRef<Status(DataWriter&)> write)
{
    CountSink count;
    DataWriter counted{count};
    if (const Status status = write(counted); !status.ok())
        return {code_of(status), {}};
    return send_data(count.count(), write);
}

} // namespace dicot::mtp

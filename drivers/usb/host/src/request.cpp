#include "request.h"

#include "dicot/mtp/codes.h"

namespace dicot::mtp {
namespace {

constexpr std::uint16_t kStoreNotAvailable = 0x2013; ///< ISO 15740, clause 11

} // namespace

Status refusal(std::uint16_t answered, std::uint16_t operation)
{
    const auto say = [&](Fault fault, const char* what) {
        return failure(fault, "the device %s (operation %04X: %04X)", what, operation, answered);
    };
    switch (answered) {
    case response::kOk:
        return {};
    case response::kInvalidObjectHandle:
    case response::kInvalidParentObject:
    case kStoreNotAvailable:
        return say(Fault::kNoInput, "has no such object");
    case response::kDeviceBusy:
    case response::kTransactionCancelled:
        return say(Fault::kTryAgain, "is busy");
    case response::kOperationNotSupported:
        return say(Fault::kUsage, "cannot do this");
    case response::kAccessDenied:
        return say(Fault::kUsage, "does not allow this");
    default:
        return say(Fault::kIoError, "says that it failed");
    }
}

} // namespace dicot::mtp

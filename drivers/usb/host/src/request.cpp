#include "request.h"

#include "codes.h"

namespace dicot::mtp {

Status refusal(std::uint16_t response, std::uint16_t operation)
{
    const auto say = [&](Fault fault, const char* what) {
        return failure(fault, "the device %s (operation %04X: %04X)", what, operation, response);
    };
    switch (response) {
    case code::kOk:
        return {};
    case code::kInvalidObjectHandle:
    case code::kInvalidParentObject:
    case code::kStoreNotAvailable:
        return say(Fault::kNoInput, "has no such object");
    case code::kDeviceBusy:
    case code::kTransactionCancelled:
        return say(Fault::kTryAgain, "is busy");
    case code::kOperationNotSupported:
        return say(Fault::kUsage, "cannot do this");
    case code::kAccessDenied:
        return say(Fault::kUsage, "does not allow this");
    default:
        return say(Fault::kIoError, "says that it failed");
    }
}

} // namespace dicot::mtp

#include "dicot/mtp/codes.h"

namespace dicot::mtp {

bool takes_data(std::uint16_t code) noexcept
{
    switch (code) {
    case operation::kSendObjectInfo:
    case operation::kSendObject:
    case operation::kSetDevicePropValue:
    case operation::kSendPartialObject:
    case operation::kSetObjectPropValue:
    case operation::kSetObjectPropList:
    case operation::kSendObjectPropList:
    case operation::kSetObjectReferences:
    case operation::kMarkPulled:
    case operation::kOfferTime:
        return true;
    default:
        return false;
    }
}

bool writes_to_store(std::uint16_t code) noexcept
{
    switch (code) {
    case operation::kDeleteObject:
    case operation::kSendObjectInfo:
    case operation::kSendObject:
    case operation::kFormatStore:
    case operation::kSetObjectProtection:
    case operation::kMoveObject:
    case operation::kCopyObject:
    case operation::kSendPartialObject:
    case operation::kTruncateObject:
    case operation::kBeginEditObject:
    case operation::kEndEditObject:
    case operation::kSetObjectPropValue:
    case operation::kSetObjectPropList:
    case operation::kSendObjectPropList:
    case operation::kSetObjectReferences:
        return true;
    default:
        return false;
    }
}

} // namespace dicot::mtp

// Numbers of ISO 15740, of MTP 1.0 and of its users, as far as this side says or hears them.
#pragma once

#include <cstdint>

namespace dicot::mtp::code {

enum Container : std::uint16_t
{
    kCommand = 1,
    kData = 2,
    kResponse = 3,
};

enum Operation : std::uint16_t
{
    kGetDeviceInfo = 0x1001,
    kOpenSession = 0x1002,
    kCloseSession = 0x1003,
    kGetStorageIDs = 0x1004,
    kGetObjectHandles = 0x1007,
    kGetObjectInfo = 0x1008,
    kGetObject = 0x1009,
    kGetPartialObject = 0x101B,
    kGetPartialObject64 = 0x95C1, // Android
    kListSnapshots = 0x9D01,
    kMarkPulled = 0x9D02,
    kOfferTime = 0x9D03,
};

enum Response : std::uint16_t
{
    kOk = 0x2001,
    kSessionNotOpen = 0x2003,
    kInvalidTransactionID = 0x2004,
    kOperationNotSupported = 0x2005,
    kInvalidObjectHandle = 0x2009,
    kAccessDenied = 0x200F,
    kStoreNotAvailable = 0x2013,
    kSpecificationByFormatUnsupported = 0x2014,
    kDeviceBusy = 0x2019,
    kInvalidParentObject = 0x201A,
    kInvalidParameter = 0x201D,
    kSessionAlreadyOpen = 0x201E,
    kTransactionCancelled = 0x201F,
};

constexpr std::uint16_t kAssociation = 0x3001;  ///< the format of a folder
constexpr std::uint32_t kAtTheTop = 0xFFFFFFFF; ///< the parent to ask for what stands in no folder

} // namespace dicot::mtp::code

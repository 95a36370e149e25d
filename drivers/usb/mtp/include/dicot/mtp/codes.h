// The numbers of the protocol. ISO 15740:2013 (PIMA 15740:2000) clauses 10 to 13, MTP 1.0 appendices A to H; ours at
// the end of each list.
#pragma once

#include <cstdint>

namespace dicot::mtp {

/// Operation codes.
namespace operation {
inline constexpr std::uint16_t kGetDeviceInfo = 0x1001;
inline constexpr std::uint16_t kOpenSession = 0x1002;
inline constexpr std::uint16_t kCloseSession = 0x1003;
inline constexpr std::uint16_t kGetStorageIds = 0x1004;
inline constexpr std::uint16_t kGetStorageInfo = 0x1005;
inline constexpr std::uint16_t kGetNumObjects = 0x1006;
inline constexpr std::uint16_t kGetObjectHandles = 0x1007;
inline constexpr std::uint16_t kGetObjectInfo = 0x1008;
inline constexpr std::uint16_t kGetObject = 0x1009;
inline constexpr std::uint16_t kGetThumb = 0x100A;
inline constexpr std::uint16_t kDeleteObject = 0x100B;
inline constexpr std::uint16_t kSendObjectInfo = 0x100C;
inline constexpr std::uint16_t kSendObject = 0x100D;
inline constexpr std::uint16_t kFormatStore = 0x100F;
inline constexpr std::uint16_t kResetDevice = 0x1010;
inline constexpr std::uint16_t kSetObjectProtection = 0x1012;
inline constexpr std::uint16_t kGetDevicePropDesc = 0x1014;
inline constexpr std::uint16_t kGetDevicePropValue = 0x1015;
inline constexpr std::uint16_t kSetDevicePropValue = 0x1016;
inline constexpr std::uint16_t kMoveObject = 0x1019;
inline constexpr std::uint16_t kCopyObject = 0x101A;
inline constexpr std::uint16_t kGetPartialObject = 0x101B;
// Android's, which libmtp and what is built on it use wherever they are listed.
inline constexpr std::uint16_t kGetPartialObject64 = 0x95C1; ///< handle, offset low, offset high, most bytes
inline constexpr std::uint16_t kSendPartialObject = 0x95C2;
inline constexpr std::uint16_t kTruncateObject = 0x95C3;
inline constexpr std::uint16_t kBeginEditObject = 0x95C4;
inline constexpr std::uint16_t kEndEditObject = 0x95C5;
// MTP
inline constexpr std::uint16_t kGetObjectPropsSupported = 0x9801;
inline constexpr std::uint16_t kGetObjectPropDesc = 0x9802;
inline constexpr std::uint16_t kGetObjectPropValue = 0x9803;
inline constexpr std::uint16_t kSetObjectPropValue = 0x9804;
inline constexpr std::uint16_t kGetObjectPropList = 0x9805;
inline constexpr std::uint16_t kSetObjectPropList = 0x9806;
inline constexpr std::uint16_t kSendObjectPropList = 0x9808;
inline constexpr std::uint16_t kGetObjectReferences = 0x9810;
inline constexpr std::uint16_t kSetObjectReferences = 0x9811;
// dicot's own; snapshot_bytes.h has their data.
inline constexpr std::uint16_t kListSnapshots = 0x9D01; ///< first sequence low, high, most notes (0: no wish)
inline constexpr std::uint16_t kMarkPulled = 0x9D02;    ///< data from the host
inline constexpr std::uint16_t kOfferTime = 0x9D03;     ///< data from the host
} // namespace operation

/// Response codes.
namespace response {
inline constexpr std::uint16_t kOk = 0x2001;
inline constexpr std::uint16_t kGeneralError = 0x2002;
inline constexpr std::uint16_t kSessionNotOpen = 0x2003;
inline constexpr std::uint16_t kInvalidTransactionId = 0x2004;
inline constexpr std::uint16_t kOperationNotSupported = 0x2005;
inline constexpr std::uint16_t kParameterNotSupported = 0x2006;
inline constexpr std::uint16_t kIncompleteTransfer = 0x2007;
inline constexpr std::uint16_t kInvalidStorageId = 0x2008;
inline constexpr std::uint16_t kInvalidObjectHandle = 0x2009;
inline constexpr std::uint16_t kDevicePropNotSupported = 0x200A;
inline constexpr std::uint16_t kInvalidObjectFormatCode = 0x200B;
inline constexpr std::uint16_t kStoreReadOnly = 0x200E;
inline constexpr std::uint16_t kAccessDenied = 0x200F;
inline constexpr std::uint16_t kNoThumbnailPresent = 0x2010;
inline constexpr std::uint16_t kDeviceBusy = 0x2019;
inline constexpr std::uint16_t kInvalidParentObject = 0x201A;
inline constexpr std::uint16_t kInvalidParameter = 0x201D;
inline constexpr std::uint16_t kSessionAlreadyOpen = 0x201E;
inline constexpr std::uint16_t kTransactionCancelled = 0x201F;
inline constexpr std::uint16_t kInvalidObjectPropCode = 0xA801;
inline constexpr std::uint16_t kInvalidDataset = 0xA806;
inline constexpr std::uint16_t kSpecificationByGroupUnsupported = 0xA807;
inline constexpr std::uint16_t kSpecificationByDepthUnsupported = 0xA808;
inline constexpr std::uint16_t kObjectPropNotSupported = 0xA80A;
} // namespace response

/// Event codes.
namespace event {
inline constexpr std::uint16_t kCancelTransaction = 0x4001;
inline constexpr std::uint16_t kObjectAdded = 0x4002;        ///< handle
inline constexpr std::uint16_t kObjectRemoved = 0x4003;      ///< handle
inline constexpr std::uint16_t kStorageInfoChanged = 0x400C; ///< storage
} // namespace event

/// Object formats.
namespace format {
inline constexpr std::uint16_t kUndefined = 0x3000;
inline constexpr std::uint16_t kAssociation = 0x3001; ///< a folder
inline constexpr std::uint16_t kExifJpeg = 0x3801;
inline constexpr std::uint16_t kPng = 0x380B;
} // namespace format

/// Object properties.
namespace object_property {
inline constexpr std::uint16_t kStorageId = 0xDC01;        ///< u32
inline constexpr std::uint16_t kObjectFormat = 0xDC02;     ///< u16
inline constexpr std::uint16_t kProtectionStatus = 0xDC03; ///< u16
inline constexpr std::uint16_t kObjectSize = 0xDC04;       ///< u64
inline constexpr std::uint16_t kObjectFileName = 0xDC07;   ///< text
inline constexpr std::uint16_t kDateCreated = 0xDC08;      ///< text
inline constexpr std::uint16_t kDateModified = 0xDC09;     ///< text
inline constexpr std::uint16_t kParentObject = 0xDC0B;     ///< u32
inline constexpr std::uint16_t kPersistentId = 0xDC41;     ///< u128
inline constexpr std::uint16_t kName = 0xDC44;             ///< text
} // namespace object_property

/// Device properties.
namespace device_property {
inline constexpr std::uint16_t kFriendlyName = 0xD402;        ///< text
inline constexpr std::uint16_t kPerceivedDeviceType = 0xD407; ///< u32
} // namespace device_property

/// Data types of properties.
namespace data_type {
inline constexpr std::uint16_t kU16 = 0x0004;
inline constexpr std::uint16_t kU32 = 0x0006;
inline constexpr std::uint16_t kU64 = 0x0008;
inline constexpr std::uint16_t kU128 = 0x000A;
inline constexpr std::uint16_t kText = 0xFFFF;
} // namespace data_type

/// In a command: every handle, storage, property ("all"), or the top of the tree, as the operation has it.
inline constexpr std::uint32_t kEvery = 0xFFFFFFFF;
/// The parent that GetObjectHandles is given for what stands at the top; 0 there means everything.
inline constexpr std::uint32_t kTop = 0xFFFFFFFF;
/// Our only storage: the first logical one of the first physical one.
inline constexpr std::uint32_t kStorage = 0x00010001;

/// DeviceInfo: Microsoft's extension, MTP 1.00, and what says that dicot's own operations are there.
inline constexpr std::uint32_t kMicrosoftExtension = 6;
inline constexpr std::uint16_t kProtocolVersion = 100;
inline constexpr char kExtensionWords[] = "microsoft.com: 1.0; dicot.example: 1.0;";
inline constexpr char kOwnExtension[] = "dicot.example: 1.0";

/// Class requests on the control pipe (Still Image Capture Device Definition 1.0, clause 5).
namespace class_request {
inline constexpr std::uint8_t kCancel = 0x64;
inline constexpr std::uint8_t kGetExtendedEventData = 0x65;
inline constexpr std::uint8_t kDeviceReset = 0x66;
inline constexpr std::uint8_t kGetDeviceStatus = 0x67;
} // namespace class_request

/// Whether the host sends data after the command: what of it is not wanted has to be taken in before an answer.
bool takes_data(std::uint16_t operation) noexcept;
/// Whether it would change, make or remove an object or the store: never done here.
bool writes_to_store(std::uint16_t operation) noexcept;

} // namespace dicot::mtp

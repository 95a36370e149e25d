#include "camera_memory.h"

#include "camera_choice.h"
#include "rig_stream.h"

#include "dicot/os/lent_heap.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/memory_reserve.h"
#include "dicot/uvc/uvc_camera.h"
#include "dicot/uvc/uvc_list.h"
#include "dicot/v4l2/v4l2_camera.h"

#include <algorithm>
#include <new>

namespace dicot::app {
namespace {

constexpr std::size_t kMostNamesBytes = std::size_t{8} << 20; ///< of 10,000 recorded pairs

/// Eight transfers of 32 packets of 3072 bytes each, the most of a high-speed endpoint (USB 2.0, 5.6.3).
constexpr std::size_t kHighSpeedTransferBytes = std::size_t{8} * 32 * 3072;

Result<CameraMemory> of_recorded(const Config& config)
{
    const MemoryBlock names = TRY(MemoryBlock::map(kMostNamesBytes));
    const LentHeap office{names.bytes()};
    try {
        const RigStream rig = TRY(RigStream::open(config, Pace::kAtOnce));
        return CameraMemory{rig.reserved_bytes(), 0, office.peak_bytes()};
    } catch (const std::bad_alloc&) {
        return failure(Fault::kConfig, "%s holds more recorded pictures than %zu MiB can name: move some away",
                       config.cameras.left.what.c_str(), kMostNamesBytes >> 20);
    }
}

CameraMemory of_usb(const Config& config)
{
    UvcOptions options;
    options.slot_bytes = largest_frame(config.cameras);
    std::size_t most = static_cast<std::size_t>(options.slots) * (options.slot_bytes + Arena::kAlignment) +
                       kHighSpeedTransferBytes + kMostUsbDescriptorBytes;
    if (const Result<std::vector<UvcListed>> listed = list_uvc_cameras(); listed.ok())
        for (const UvcListed& one : listed.value())
            most = std::max(most, UvcCamera::memory_bytes(one.device, options));
    const bool through_kernel = config.cameras.driver == "v4l2";
    const std::size_t kernels = config.cameras.driver == "uvc" ? 0 : V4l2Camera::kSlots * options.slot_bytes;
    return {through_kernel ? 0 : 2 * MemoryReserve::bytes_for(most), 2 * kernels, 0};
}

} // namespace

Result<CameraMemory> CameraMemory::measure(const Config& config)
{
    return config.cameras.left.by == BoundBy::kReplay ? of_recorded(config) : Result<CameraMemory>{of_usb(config)};
}

} // namespace dicot::app

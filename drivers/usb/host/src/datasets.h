// What a device tells in the data of its answers.
#pragma once

#include "dicot/mtp_host/initiator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dicot::mtp {

/// All of them: false if the bytes end too early; what stands behind is passed over, as later versions may add to it.
bool read_device_info(std::span<const std::byte> bytes, DeviceFacts& into);
bool read_object_info(std::span<const std::byte> bytes, ObjectFacts& into);
bool read_words(std::span<const std::byte> bytes, std::size_t most, std::vector<std::uint32_t>& into);

/// False too if a note is nonsense, or they do not ascend from `first` on.
bool read_notes(std::span<const std::byte> bytes, std::int64_t first, std::vector<SnapshotNote>& into);
/// 8 bytes.
std::span<const std::byte> write_time(const TimeOffer& offer, std::span<std::byte> room);
/// Into kMostMarks * 40 + 4 bytes at least.
std::span<const std::byte> write_marks(std::span<const PulledNote> pulled, std::span<std::byte> room);

} // namespace dicot::mtp

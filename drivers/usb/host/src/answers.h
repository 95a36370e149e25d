// What a device tells in the data of its answers, as far as it is of use here.
#pragma once

#include "dicot/mtp_host/initiator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dicot::mtp {

/// False: the bytes end too early, or there are more than `most` of them.
bool read_facts(std::span<const std::byte> bytes, DeviceFacts& into);
bool read_facts(std::span<const std::byte> bytes, ObjectFacts& into);
bool read_numbers(std::span<const std::byte> bytes, std::size_t most, std::vector<std::uint32_t>& into);
/// False too if there are numbers that no snapshot has, or they do not ascend from `first` on.
bool read_notes(std::span<const std::byte> bytes, std::int64_t first, std::vector<SnapshotNote>& into);

} // namespace dicot::mtp

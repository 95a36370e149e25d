// dicot's own data on the cable. README.md has the bytes.
#pragma once

#include "dicot/mtp/data_reader.h"
#include "dicot/mtp/data_writer.h"
#include "dicot/mtp/snapshot_note.h"

namespace dicot::mtp {

inline constexpr std::size_t kSnapshotNoteBytes = 64;
inline constexpr std::size_t kPulledNoteBytes = 40;
inline constexpr std::size_t kTimeOfferBytes = 8;
/// In one answer of ListSnapshots; the host asks again, from the sequence behind the last one on.
inline constexpr std::size_t kMostSnapshotNotes = 2047;
/// In one MarkPulled.
inline constexpr std::size_t kMostPulledNotes = 512;

/// The three are of fixed size; what is too short leaves `in` not ok().
SnapshotNote read_snapshot_note(DataReader& in) noexcept;
PulledNote read_pulled_note(DataReader& in) noexcept;
TimeOffer read_time_offer(DataReader& in) noexcept;

void write(DataWriter& out, const SnapshotNote& note) noexcept;
void write(DataWriter& out, const PulledNote& note) noexcept;
void write(DataWriter& out, const TimeOffer& offer) noexcept;

} // namespace dicot::mtp

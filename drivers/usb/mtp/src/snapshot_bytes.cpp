#include "dicot/mtp/snapshot_bytes.h"

#include <algorithm>
#include <limits>

namespace dicot::mtp {
namespace {

constexpr std::uint16_t kPulledFlag = 1;

Sha256 read_sums(DataReader& in) noexcept
{
    Sha256 sums{};
    const auto bytes = in.bytes(sums.size());
    std::copy(bytes.begin(), bytes.end(), sums.begin());
    return sums;
}

} // namespace

SnapshotNote read_snapshot_note(DataReader& in) noexcept
{
    SnapshotNote note;
    note.sequence = in.i64();
    note.began_us = in.i64();
    note.bytes = in.u64();
    note.folder = in.u32();
    note.files = in.u16();
    note.pulled = (in.u16() & kPulledFlag) != 0;
    note.sums = read_sums(in);
    return note;
}

void write(DataWriter& out, const SnapshotNote& note) noexcept
{
    constexpr std::uint32_t kMostFiles = std::numeric_limits<std::uint16_t>::max();
    out.i64(note.sequence);
    out.i64(note.began_us);
    out.u64(note.bytes);
    out.u32(note.folder);
    out.u16(static_cast<std::uint16_t>(std::min(note.files, kMostFiles)));
    out.u16(note.pulled ? kPulledFlag : 0);
    out.bytes(note.sums);
}

PulledNote read_pulled_note(DataReader& in) noexcept
{
    PulledNote note;
    note.sequence = in.i64();
    note.sums = read_sums(in);
    return note;
}

void write(DataWriter& out, const PulledNote& note) noexcept
{
    out.i64(note.sequence);
    out.bytes(note.sums);
}

TimeOffer read_time_offer(DataReader& in) noexcept
{
    return {in.i64()};
}

void write(DataWriter& out, const TimeOffer& offer) noexcept
{
    out.i64(offer.now_us);
}

} // namespace dicot::mtp

#include "datasets.h"

#include "codes.h"
#include "little_endian.h"

#include "dicot/base/printable.h"

#include <algorithm>
#include <cstring>

namespace dicot::mtp {
namespace {

constexpr std::size_t kNoteBytes = 64;
constexpr std::int64_t kMostSequence = 999'999'999;

void put_utf8(std::uint32_t c, std::string& text)
{
    const auto put = [&](std::uint32_t byte) { text.push_back(static_cast<char>(byte)); };
    if (c < 0x80) {
        put(c);
    } else if (c < 0x800) {
        put(0xC0 | c >> 6);
        put(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
        put(0xE0 | c >> 12);
        put(0x80 | (c >> 6 & 0x3F));
        put(0x80 | (c & 0x3F));
    } else {
        put(0xF0 | c >> 18);
        put(0x80 | (c >> 12 & 0x3F));
        put(0x80 | (c >> 6 & 0x3F));
        put(0x80 | (c & 0x3F));
    }
}

/// A count of UTF-16 units, the last of them 0, and the units; up to the first 0.
std::string take_text(LittleEndian& bytes)
{
    LittleEndian units(bytes.skip(std::size_t{2} * bytes.take<std::uint8_t>()));
    std::string text;
    while (units.left() > 0) {
        const std::uint32_t unit = units.take<std::uint16_t>();
        if (unit == 0)
            break;
        std::uint32_t c = unit;
        if (unit >= 0xD800 && unit < 0xE000) {
            LittleEndian ahead = units;
            const std::uint32_t second = ahead.take<std::uint16_t>();
            const bool pair = unit < 0xDC00 && second >= 0xDC00 && second < 0xE000;
            c = pair ? 0x10000 + ((unit - 0xD800) << 10) + (second - 0xDC00) : 0xFFFD;
            if (pair)
                units = ahead;
        }
        put_utf8(c, text);
    }
    return text;
}

template <typename Visit>
void for_each_code(LittleEndian& bytes, Visit visit)
{
    const auto count = bytes.take<std::uint32_t>();
    LittleEndian codes(bytes.skip(std::min<std::size_t>(count, bytes.left() + 1) * 2));
    while (codes.left() > 0)
        visit(codes.take<std::uint16_t>());
}

} // namespace

bool read_device_info(std::span<const std::byte> bytes, DeviceFacts& into)
{
    into = {};
    LittleEndian in(bytes);
    in.skip(2 + 4 + 2); // of the standard, of the extension
    const std::string extensions = take_text(in);
    const bool ours = extensions.find("dicot") != std::string::npos; // what 0x9D01 means elsewhere, nobody knows
    in.skip(2);                                                      // functional mode
    for_each_code(in, [&](std::uint16_t operation) {
        into.partial = into.partial || operation == code::kGetPartialObject;
        into.partial_64 = into.partial_64 || operation == code::kGetPartialObject64;
        into.lists_snapshots = into.lists_snapshots || (ours && operation == code::kListSnapshots);
        into.takes_marks = into.takes_marks || (ours && operation == code::kMarkPulled);
        into.takes_time = into.takes_time || (ours && operation == code::kOfferTime);
    });
    for (int list = 0; list < 4; ++list) // events, properties, formats of capture, formats of objects
        for_each_code(in, [](std::uint16_t) {});
    into.manufacturer = printable<63>(take_text(in));
    into.model = printable<63>(take_text(in));
    into.version = printable<63>(take_text(in));
    into.serial = printable<63>(take_text(in));
    return !in.short_of_bytes();
}

bool read_object_info(std::span<const std::byte> bytes, ObjectFacts& into)
{
    LittleEndian in(bytes);
    in.skip(4); // storage
    into.folder = in.take<std::uint16_t>() == code::kAssociation;
    in.skip(2); // protection
    into.bytes = in.take<std::uint32_t>();
    in.skip(2 + 4 + 4 + 4 + 4 + 4 + 4); // of a picture and its small copy
    into.parent = in.take<std::uint32_t>();
    in.skip(2 + 4 + 4); // kind of folder, its description, number in a row
    into.name = take_text(in);
    return !in.short_of_bytes();
}

bool read_words(std::span<const std::byte> bytes, std::size_t most, std::vector<std::uint32_t>& into)
{
    LittleEndian in(bytes);
    const auto count = in.take<std::uint32_t>();
    into.clear();
    if (count > most || count > in.left() / 4 || in.short_of_bytes())
        return false;
    into.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i)
        into.push_back(in.take<std::uint32_t>());
    return true;
}

bool read_notes(std::span<const std::byte> bytes, std::int64_t first, std::vector<SnapshotNote>& into)
{
    LittleEndian in(bytes);
    const auto count = in.take<std::uint32_t>();
    into.clear();
    if (in.short_of_bytes() || count > Initiator::kMostNotes || in.left() != count * kNoteBytes)
        return false;
    std::int64_t least = first;
    for (std::uint32_t i = 0; i < count; ++i) {
        SnapshotNote note;
        note.sequence = in.take<std::int64_t>();
        note.began_us = in.take<std::int64_t>();
        note.bytes = in.take<std::uint64_t>();
        note.folder = in.take<std::uint32_t>();
        const auto flags = in.take<std::uint32_t>();
        note.files = flags & 0xFF;
        note.pulled = (flags & 0x100) != 0;
        const auto sums = in.skip(note.sums.size());
        std::ranges::copy(sums, note.sums.begin());
        if (note.sequence < std::max<std::int64_t>(least, 1) || note.sequence > kMostSequence)
            return false;
        least = note.sequence + 1;
        into.push_back(note);
    }
    return true;
}

std::span<const std::byte> write_marks(std::span<const PulledNote> pulled, std::span<std::byte> room)
{
    LittleEndianWriter out(room);
    out.put(static_cast<std::uint32_t>(pulled.size()));
    for (const PulledNote& note : pulled) {
        out.put(note.sequence);
        out.put(std::span<const std::byte>{note.sums});
    }
    return out.written();
}

std::span<const std::byte> write_time(const TimeOffer& offer, std::span<std::byte> room)
{
    LittleEndianWriter out(room);
    out.put(offer.now_us);
    return out.written();
}

} // namespace dicot::mtp

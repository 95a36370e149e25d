// What is to go wrong, and when: the lines of a plan.
#pragma once

#include "dicot/base/status.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dicot::usbip {

enum class FaultKind
{
    // In a frame of a stream.
    kUnplug,
    kSilent,
    kHang,
    kLate,
    kZeroFrame,
    kTruncate,
    kOverlong,
    kNoEof,
    kDrop,
    kShort,
    kBadHeader,
    kWrongFid,
    kErr,
    kHalt,
    // In a control request.
    kStall,
    kMute,
    kShortReply,
    kRefuseInterface,
    // In what the host reads when the camera is plugged in.
    kCutDescriptors,
    kProduct,
};

/// Where a fault can stand.
enum class Place
{
    kFrame,
    kControl,
    kPlug,
};

/// One fault with its numbers. Numbers that a line leaves out have the defaults of the table in fault.cpp.
struct PlannedFault
{
    FaultKind kind = FaultKind::kSilent;
    Place place = Place::kFrame;
    std::string word;
    std::string camera;
    std::uint64_t stream = 0; ///< kFrame: counted from 1 over the camera's life; 0: every one
    bool next_stream = false; ///< the stream after the present one; settled when the line is taken in
    std::int64_t frame = -1;  ///< counted from 0 in its stream; -1: every one
    std::map<std::string, std::int64_t, std::less<>> numbers;
    std::string text;       ///< `text=`, with its escapes resolved
    std::int64_t left = -1; ///< kControl: how often it still happens; -1: without end

    std::int64_t operator[](std::string_view key) const;
};

/// A line that acts at once.
struct Order
{
    enum class Verb
    {
        kUnplug,
        kPlug,
        kForget, ///< the camera's faults that have not happened yet
        kQuit,   ///< the whole program; the camera's name does not matter
    };
    std::string camera;
    Verb verb = Verb::kUnplug;
};

/// What a line says: a fault, an order, or nothing (empty, or `#` and a remark).
struct Line
{
    std::optional<PlannedFault> fault;
    std::optional<Order> order;
};

/// Reads one line:
///
///     CAMERA STREAM FRAME WORD [key=number ...]    in a frame; STREAM: a number from 1, next, *; FRAME: a number from
///     0, * CAMERA control WORD [key=number ...] CAMERA plug WORD [key=number ...] CAMERA now unplug | plug | forget |
///     quit
///
/// The words and their numbers are in README.md. Fault::kConfig with the line's number and what it should have been.
Result<Line> read_line(std::string_view line, int number);

/// Whether packet `index` is one of those that the fault's `packet` and `count` name; count 0: all from `packet` on.
bool touches_packet(const PlannedFault& fault, std::int64_t index);

} // namespace dicot::usbip

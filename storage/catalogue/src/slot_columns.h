// How a row of a slot stands in the table.
#pragma once

#include "statement.h"

#include "dicot/catalogue/catalogue.h"

namespace dicot {

/// The table, as it is created and as it must be found.
extern const char* const kSlotTable;
/// Its columns in the order of read_slot() and bind_slot(), comma between them.
#define DICOT_SLOT_COLUMNS "sequence, began_us, due_us, done, reason, clock_trust, points, bytes, sums, pulled_us, kept"
constexpr int kSlotColumns = 11;

/// What a row must be made of to be put. Fault::kSoftware: a number is out of its range. Text is not looked at.
Status check_slot(const SlotRow& row);
/// Of text, what is printable.
class BoundSlot
{
public:
    /// The text and the bytes that `statement` then refers to live here.
    BoundSlot(const SlotRow& row, Statement& statement);
    BoundSlot(const BoundSlot&) = delete;
    BoundSlot& operator=(const BoundSlot&) = delete;

private:
    ShortText<255> reason_;
    ShortText<31> clock_trust_;
    unsigned char sums_[32] = {};
};
/// Every value in its range, or nothing.
std::optional<SlotRow> read_slot(const Statement& statement);

} // namespace dicot

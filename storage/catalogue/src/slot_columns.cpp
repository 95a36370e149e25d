#include "slot_columns.h"

#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"
#include "dicot/record/record.h"

#include <cstring>

namespace dicot {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;

static_assert(kFirstUtcUs == -62167219200000000 && kLastUtcUs == 253402300799999999 && kMaxSequence == 999999999 &&
              kMaxRecordPoints == 4294967295 && kMaxSlotBytes == 1099511627776);

#define DICOT_TIME(name) "typeof(" name ")='integer' AND " name " BETWEEN -62167219200000000 AND 253402300799999999"
#define DICOT_TEXT(name, most)                                                                                         \
    name " TEXT NOT NULL CHECK(typeof(" name ")='text' AND length(CAST(" name " AS BLOB))<=" most ")"
#define DICOT_NUMBER(name, most)                                                                                       \
    name " INTEGER NOT NULL CHECK(typeof(" name ")='integer' AND " name " BETWEEN 0 AND " most ")"

bool is_time(std::int64_t us)
{
    return us >= kFirstUtcUs && us <= kLastUtcUs;
}

bool is_sound(const SlotRow& row)
{
    const auto kept = static_cast<int>(row.kept);
    return row.sequence >= 1 && row.sequence <= kMaxSequence && is_time(row.began_us) &&
           row.began_us % kSecondUs == 0 && (!row.due_us || is_time(*row.due_us)) &&
           (!row.pulled_us || is_time(*row.pulled_us)) && row.points >= 0 && row.points <= kMaxRecordPoints &&
           row.bytes >= 0 && row.bytes <= kMaxSlotBytes && kept >= 0 && kept <= static_cast<int>(Kept::kLost);
}

int digit_of(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

bool bytes_of(std::string_view digits, std::span<unsigned char, 32> bytes)
{
    if (digits.size() != 2 * bytes.size())
        return false;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const int high = digit_of(digits[2 * i]);
        const int low = digit_of(digits[2 * i + 1]);
        if (high < 0 || low < 0)
            return false;
        bytes[i] = static_cast<unsigned char>(16 * high + low);
    }
    return true;
}

ShortText<64> digits_of(std::span<const unsigned char> bytes)
{
    char digits[64];
    for (std::size_t i = 0; i < 32; ++i) {
        digits[2 * i] = "0123456789abcdef"[bytes[i] >> 4];
        digits[2 * i + 1] = "0123456789abcdef"[bytes[i] & 15];
    }
    return std::string_view{digits, sizeof digits};
}

template <std::size_t Capacity>
bool read_text(const Statement& statement, int column, ShortText<Capacity>& into)
{
    const std::optional<std::string_view> text = statement.text(column);
    if (!text || text->size() > Capacity || !is_printable(*text))
        return false;
    into = *text;
    return true;
}

bool read_optional(const Statement& statement, int column, std::optional<std::int64_t>& into)
{
    into = statement.number(column);
    return into || statement.is_null(column);
}

} // namespace

// Binary digests and no index: a row is what a card has to write for each snapshot, and 10,000 rows are read at once.
// clang-format off
const char* const kSlotTable =
    "CREATE TABLE slot("
    "sequence INTEGER PRIMARY KEY CHECK(sequence BETWEEN 1 AND 999999999), "
    "began_us INTEGER NOT NULL CHECK(" DICOT_TIME("began_us") " AND began_us%1000000=0), "
    "due_us INTEGER CHECK(due_us IS NULL OR (" DICOT_TIME("due_us") ")), "
    DICOT_NUMBER("done", "1") ", "
    DICOT_TEXT("reason", "255") ", "
    DICOT_TEXT("clock_trust", "31") ", "
    DICOT_NUMBER("points", "4294967295") ", "
    DICOT_NUMBER("bytes", "1099511627776") ", "
    "sums BLOB CHECK(sums IS NULL OR (typeof(sums)='blob' AND length(sums)=32)), "
    "pulled_us INTEGER CHECK(pulled_us IS NULL OR (" DICOT_TIME("pulled_us") ")), "
    DICOT_NUMBER("kept", "3") ")";
// clang-format on

Status check_slot(const SlotRow& row)
{
    unsigned char sums[32];
    if (!is_sound(row) || (!row.sums.empty() && !bytes_of(row.sums.view(), sums)))
        return failure(Fault::kSoftware, "a row of the catalogue was to be made of numbers that are out of range");
    return {};
}

BoundSlot::BoundSlot(const SlotRow& row, Statement& statement)
    : reason_(printable<255>(row.reason.view())), clock_trust_(printable<31>(row.clock_trust.view()))
{
    const bool has_sums = bytes_of(row.sums.view(), sums_);
    statement.bind(1, row.sequence);
    statement.bind(2, row.began_us);
    statement.bind(3, row.due_us);
    statement.bind(4, std::int64_t{row.done});
    statement.bind_text(5, reason_.view());
    statement.bind_text(6, clock_trust_.view());
    statement.bind(7, row.points);
    statement.bind(8, row.bytes);
    statement.bind_bytes(9, has_sums ? std::span<const unsigned char>{sums_} : std::span<const unsigned char>{});
    statement.bind(10, row.pulled_us);
    statement.bind(11, std::int64_t{static_cast<int>(row.kept)});
}

std::optional<SlotRow> read_slot(const Statement& statement)
{
    SlotRow row;
    const std::optional<std::int64_t> sequence = statement.number(0), began_us = statement.number(1),
                                      done = statement.number(3), points = statement.number(6),
                                      bytes = statement.number(7), kept = statement.number(10);
    if (!sequence || !began_us || !done || !points || !bytes || !kept)
        return {};
    if (*done < 0 || *done > 1 || *kept < 0 || *kept > static_cast<int>(Kept::kLost))
        return {};
    row.sequence = *sequence;
    row.began_us = *began_us;
    row.done = *done == 1;
    row.points = *points;
    row.bytes = *bytes;
    row.kept = static_cast<Kept>(*kept);
    if (!read_optional(statement, 2, row.due_us) || !read_optional(statement, 9, row.pulled_us) ||
        !read_text(statement, 4, row.reason) || !read_text(statement, 5, row.clock_trust) || !is_sound(row))
        return {};
    if (!statement.is_null(8)) {
        const std::optional<std::span<const unsigned char>> sums = statement.bytes(8);
        if (!sums || sums->size() != 32)
            return {};
        row.sums = digits_of(*sums);
    }
    return row;
}

} // namespace dicot

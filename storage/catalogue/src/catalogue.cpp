#include "dicot/catalogue/catalogue.h"

#include "open_database.h"
#include "slot_columns.h"
#include "sqlite_heap.h"
#include "statement.h"

#include "dicot/os/clock_trust.h"

#include <algorithm>
#include <limits>

namespace dicot {
namespace {

constexpr std::int64_t kPaceRows = 200;
constexpr double kDayUs = 86'400e6;
/// A longer step between two rows is a clock that was set, or a board that was put away.
constexpr double kLongestStepUs = 31 * kDayUs;
/// Of a series that has just begun, or of trials by hand, nothing follows for a season.
constexpr double kLeastSpanUs = kDayUs / 4;

bool fits(const SlotRow& row, const SlotQuery& query)
{
    return (!query.since_us || row.began_us >= *query.since_us) &&
           (!query.until_us || row.began_us <= *query.until_us) && !(query.missed_only && row.done);
}

class SqlCatalogue final : public Catalogue
{
public:
    explicit SqlCatalogue(Database database) : database_(std::move(database)) {}

    Status prepare();
    Status look_at_rows()
    {
        return walk({}, false, [](const SlotRow&) { return true; });
    }
    Status put(const SlotRow& row) override;
    Result<std::optional<SlotRow>> find(std::int64_t sequence) override;
    Result<std::int64_t> last_sequence() override;
    Status for_each(const SlotQuery& query, FunctionRef<bool(const SlotRow&)> visit) override;
    Result<std::optional<SlotRow>> newest_planned(std::int64_t since_us) override;
    Result<SlotTotals> totals() override;
    Result<SlotPace> pace() override;
    Status begin() override { return database_.run("BEGIN IMMEDIATE"); }
    Status commit() override;
    Status sync() override;
    Status check() override;

private:
    struct Range
    {
        std::int64_t first = std::numeric_limits<std::int64_t>::min(), last = std::numeric_limits<std::int64_t>::max();
    };
    /// Every row of the range, until `visit` returns false. Nothing is left to SQLite that would let it wander through
    /// a forged tree for ever: each step gives a row, and a sequence that turns back ends it.
    Status walk(Range range, bool down, FunctionRef<bool(const SlotRow&)> visit);
    Status damaged_row() const { return database_.damaged("a row holds what no row of dicot's does"); }

    Database database_;
    std::optional<Statement> put_, find_; ///< of each commit
};

Status SqlCatalogue::prepare()
{
    put_.emplace(TRY(Statement::prepare(database_,
                                        "INSERT OR REPLACE INTO slot (" DICOT_SLOT_COLUMNS
                                        ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)",
                                        true)));
    find_.emplace(
        TRY(Statement::prepare(database_, "SELECT " DICOT_SLOT_COLUMNS " FROM slot WHERE sequence=?1", true)));
    return {};
}

Status SqlCatalogue::put(const SlotRow& row)
{
    TRY(check_slot(row));
    const BoundSlot bound{row, *put_};
    const Result<bool> stepped = put_->step();
    put_->reset();
    return stepped.status();
}

Result<std::optional<SlotRow>> SqlCatalogue::find(std::int64_t sequence)
{
    find_->bind(1, sequence);
    const Result<bool> there = find_->step();
    std::optional<SlotRow> row;
    if (there.ok() && there.value())
        row = read_slot(*find_);
    find_->reset();
    if (!there.ok())
        return there.status();
    if (there.value() && (!row || row->sequence != sequence))
        return damaged_row();
    return row;
}

Status SqlCatalogue::walk(Range range, bool down, FunctionRef<bool(const SlotRow&)> visit)
{
    constexpr const char* kUp =
        "SELECT " DICOT_SLOT_COLUMNS " FROM slot WHERE sequence BETWEEN ?1 AND ?2 ORDER BY sequence";
    constexpr const char* kDown =
        "SELECT " DICOT_SLOT_COLUMNS " FROM slot WHERE sequence BETWEEN ?1 AND ?2 ORDER BY sequence DESC";
    Statement statement = TRY(Statement::prepare(database_, down ? kDown : kUp));
    statement.bind(1, range.first);
    statement.bind(2, range.last);
    std::optional<std::int64_t> previous;
    while (TRY(statement.step())) {
        const std::optional<SlotRow> row = read_slot(statement);
        if (!row || row->sequence < range.first || row->sequence > range.last)
            return damaged_row();
        if (previous && (down ? row->sequence >= *previous : row->sequence <= *previous))
            return database_.damaged("its rows are out of order");
        previous = row->sequence;
        if (!visit(*row))
            break;
    }
    return {};
}

Result<std::int64_t> SqlCatalogue::last_sequence()
{
    std::int64_t last = 0;
    TRY(walk({}, true, [&](const SlotRow& row) {
        last = row.sequence;
        return false;
    }));
    return last;
}

Status SqlCatalogue::for_each(const SlotQuery& query, FunctionRef<bool(const SlotRow&)> visit)
{
    Range range;
    range.first = query.first_sequence.value_or(range.first);
    range.last = query.last_sequence.value_or(range.last);
    if (query.last) {
        std::int64_t wanted = *query.last;
        if (wanted <= 0)
            return {};
        std::int64_t oldest = range.last;
        TRY(walk(range, true, [&](const SlotRow& row) {
            if (!fits(row, query))
                return true;
            oldest = row.sequence;
            return --wanted > 0;
        }));
        range.first = std::max(range.first, oldest);
    }
    return walk(range, false, [&](const SlotRow& row) { return !fits(row, query) || visit(row); });
}

Result<std::optional<SlotRow>> SqlCatalogue::newest_planned(std::int64_t since_us)
{
    std::optional<SlotRow> newest;
    TRY(walk({}, true, [&](const SlotRow& row) {
        if (row.due_us && *row.due_us >= since_us && row.clock_trust.view() != name_of(ClockTrust::kNotSet))
            newest = row;
        return !newest;
    }));
    return newest;
}

Result<SlotTotals> SqlCatalogue::totals()
{
    SlotTotals totals;
    TRY(walk({}, false, [&](const SlotRow& row) {
        ++totals.slots;
        ++(row.done ? totals.done : totals.missed);
        totals.pulled += row.pulled_us ? 1 : 0;
        totals.pruned += row.kept == Kept::kPruned ? 1 : 0;
        totals.quarantined += row.kept == Kept::kQuarantined ? 1 : 0;
        totals.lost += row.kept == Kept::kLost ? 1 : 0;
        totals.bytes_here += row.kept == Kept::kHere ? row.bytes : 0; // 2^40 each: more rows than any card holds
        return true;
    }));
    return totals;
}

Result<SlotPace> SqlCatalogue::pace()
{
    SlotPace pace;
    double done = 0;
    double done_bytes = 0;
    double counted_us = 0; // of the steps between neighbours that are believed, and what came after each of them
    double counted_bytes = 0;
    std::optional<std::int64_t> previous_us;
    SlotQuery newest;
    newest.last = kPaceRows;
    TRY(for_each(newest, [&](const SlotRow& row) {
        const auto bytes = static_cast<double>(row.bytes);
        if (row.done) {
            ++done;
            done_bytes += bytes;
            pace.most_bytes = std::max(pace.most_bytes, row.bytes);
        }
        const double step_us = previous_us ? static_cast<double>(row.began_us - *previous_us) : 0;
        if (step_us > 0 && step_us <= kLongestStepUs) {
            counted_us += step_us;
            counted_bytes += bytes;
        }
        previous_us = row.began_us;
        return true;
    }));
    pace.bytes_per_snapshot = done > 0 ? done_bytes / done : 0;
    pace.bytes_per_day = counted_us >= kLeastSpanUs ? counted_bytes / counted_us * kDayUs : 0;
    return pace;
}

Status SqlCatalogue::commit()
{
    if (sqlite3_get_autocommit(database_.connection()) != 0)
        return failure(Fault::kIoError, "%s: the rows were taken back when one of them failed", database_.path());
    const Status committed = database_.run("COMMIT");
    if (!committed.ok() && sqlite3_get_autocommit(database_.connection()) == 0)
        (void)database_.run("ROLLBACK");
    return committed;
}

Status SqlCatalogue::sync()
{
    sqlite3_file* log = nullptr; // in WAL mode: all that is not in its place yet stands in it
    const int code = sqlite3_file_control(database_.connection(), "main", SQLITE_FCNTL_JOURNAL_POINTER, &log);
    if (code != SQLITE_OK)
        return database_.failed(code);
    if (log == nullptr || log->pMethods == nullptr)
        return {}; // in memory, or nothing was written
    const int synced = log->pMethods->xSync(log, SQLITE_SYNC_NORMAL);
    return synced == SQLITE_OK ? Status{} : database_.failed(synced);
}

Status SqlCatalogue::check()
{
    {
        Statement check = TRY(Statement::prepare(database_, "PRAGMA integrity_check(1)"));
        if (!TRY(check.step()))
            return database_.damaged("it does not answer");
        const std::optional<std::string_view> answer = check.text(0);
        if (answer != "ok") {
            const ShortText<120> complaint = answer.value_or("it does not answer");
            return database_.damaged(complaint.c_str());
        }
    }
    return look_at_rows();
}

} // namespace

Result<std::unique_ptr<Catalogue>> Catalogue::open(const std::string& path, Access access, const char* vfs)
{
    TRY(sqlite_heap::start());
    auto catalogue = std::make_unique<SqlCatalogue>(TRY(open_database(path, access, vfs)));
    TRY(catalogue->prepare());
    TRY(catalogue->look_at_rows()); // a row that nobody can read is to be known now, while there is a remedy
    return std::unique_ptr<Catalogue>{std::move(catalogue)};
}

std::size_t Catalogue::peak_heap_bytes() noexcept
{
    return sqlite_heap::peak_bytes();
}

} // namespace dicot

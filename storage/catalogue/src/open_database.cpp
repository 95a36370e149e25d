#include "open_database.h"

#include "catalogue_files.h"
#include "slot_columns.h"
#include "statement.h"

#include "dicot/os/shown_path.h"

#include <cstdio>
#include <utility>

namespace dicot {
namespace {

constexpr int kBusyMs = 3000;
constexpr std::int64_t kSchemaVersion = 1;
constexpr std::int64_t kApplicationId = 0x6469636F; // "dico"

/// What a catalogue needs, with some air; SQLite's own bounds are those of a data centre.
void set_limits(sqlite3* connection)
{
    constexpr std::pair<int, int> kLimits[] = {
        {SQLITE_LIMIT_LENGTH, 8192},        {SQLITE_LIMIT_SQL_LENGTH, 8192},   {SQLITE_LIMIT_COLUMN, 32},
        {SQLITE_LIMIT_EXPR_DEPTH, 64},      {SQLITE_LIMIT_COMPOUND_SELECT, 4}, {SQLITE_LIMIT_VDBE_OP, 5000},
        {SQLITE_LIMIT_FUNCTION_ARG, 8},     {SQLITE_LIMIT_ATTACHED, 0},        {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 64},
        {SQLITE_LIMIT_VARIABLE_NUMBER, 16}, {SQLITE_LIMIT_TRIGGER_DEPTH, 1},   {SQLITE_LIMIT_WORKER_THREADS, 0},
    };
    for (const auto& [limit, value] : kLimits)
        sqlite3_limit(connection, limit, value);
}

/// Nothing that stands in the file is run.
Status distrust(const Database& database)
{
    constexpr std::pair<int, int> kSwitches[] = {
        {SQLITE_DBCONFIG_DEFENSIVE, 1},      {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
        {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0}, {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
        {SQLITE_DBCONFIG_ENABLE_FKEY, 0},    {SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0},
        {SQLITE_DBCONFIG_DQS_DDL, 0},        {SQLITE_DBCONFIG_DQS_DML, 0},
    };
    for (const auto& [name, value] : kSwitches)
        if (const int code = sqlite3_db_config(database.connection(), name, value, nullptr); code != SQLITE_OK)
            return database.failed(code);
    set_limits(database.connection());
    return database.run("PRAGMA cell_size_check=ON;"
                        "PRAGMA mmap_size=0;" // a page that the card does not give would be a signal
                        "PRAGMA temp_store=MEMORY;"
                        "PRAGMA cache_size=-256");
}

Result<std::int64_t> number_of(const Database& database, const char* sql)
{
    Statement statement = TRY(Statement::prepare(database, sql));
    if (!TRY(statement.step()))
        return database.damaged("it does not answer");
    const std::optional<std::int64_t> number = statement.number(0);
    return number ? Result<std::int64_t>{*number} : Result<std::int64_t>{database.damaged("it does not answer")};
}

Status check_schema(const Database& database)
{
    if (TRY(number_of(database, "PRAGMA application_id")) != kApplicationId)
        return database.damaged("another program made it");
    const std::int64_t version = TRY(number_of(database, "PRAGMA user_version"));
    if (version > kSchemaVersion)
        return database.damaged("a later version of dicot made it");
    Statement schema = TRY(Statement::prepare(database, "SELECT type, name, sql FROM sqlite_master"));
    const bool ours = version == kSchemaVersion && TRY(schema.step()) && schema.text(0) == "table" &&
                      schema.text(1) == "slot" && schema.text(2) == kSlotTable && !TRY(schema.step());
    return ours ? Status{} : database.damaged("its table is another one");
}

/// Also of two processes that begin at the same moment.
Status make_schema(const Database& database)
{
    TRY(database.run("BEGIN IMMEDIATE"));
    const Status made = [&]() -> Status {
        if (TRY(number_of(database, "SELECT count(*) FROM sqlite_master")) != 0)
            return {};
        TRY(database.run(kSlotTable));
        char marks[96];
        std::snprintf(marks, sizeof marks, "PRAGMA application_id=%lld; PRAGMA user_version=%lld",
                      static_cast<long long>(kApplicationId), static_cast<long long>(kSchemaVersion));
        TRY(database.run(marks));
        return {};
    }();
    const Status ended = database.run(made.ok() ? "COMMIT" : "ROLLBACK");
    return made.ok() ? ended : made;
}

Status be_ready_to_write(const Database& database)
{
    const bool is_new = TRY(number_of(database, "SELECT count(*) FROM sqlite_master")) == 0 &&
                        TRY(number_of(database, "PRAGMA user_version")) == 0;
    if (!is_new)
        TRY(check_schema(database)); // a file that is not ours is not changed
    else // no journal beside a file that is being made: should power fail now, it is made again
        TRY(database.run("PRAGMA journal_mode=MEMORY"));
    // A checkpoint after 64 pages: each is short, and pages that many rows touched are written to their place once.
    TRY(database.run("PRAGMA journal_mode=WAL;"
                     "PRAGMA synchronous=NORMAL;"
                     "PRAGMA wal_autocheckpoint=64;"
                     "PRAGMA journal_size_limit=524288"));
    return is_new ? make_schema(database) : Status{};
}

/// That an honest page tree stands in the file: rows are put into it from now on.
Status check_structure(const Database& database)
{
    // A page that cannot be read is a complaint like any other: once is no reason to part with the file.
    for (int attempt = 0; attempt < 2; ++attempt) {
        Statement check = TRY(Statement::prepare(database, "PRAGMA quick_check(1)"));
        if (TRY(check.step()) && check.text(0) == "ok")
            return {};
    }
    return database.damaged("its pages contradict each other");
}

} // namespace

Result<Database> open_database(const std::string& path, Catalogue::Access access, const char* vfs)
{
    const bool in_memory = path == ":memory:";
    if (path.empty())
        return failure(Fault::kUsage, "a catalogue without a name");
    if (!in_memory && !TRY(look_at_catalogue_files(path.c_str(), vfs)) && access == Catalogue::Access::kRead)
        return failure(Fault::kNoInput, "%s: there is no catalogue: dicot verify --repair makes it from the folders",
                       shown_path(path.c_str()));
    const int flags =
        (access == Catalogue::Access::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) |
        SQLITE_OPEN_NOMUTEX;
    sqlite3* connection = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &connection, flags, vfs);
    Database database{connection, path}; // also a connection that failed must be closed
    if (code != SQLITE_OK)
        return database.failed(code);
    sqlite3_extended_result_codes(connection, 1);
    sqlite3_busy_timeout(connection, kBusyMs);
    TRY(distrust(database));
    if (access == Catalogue::Access::kWrite)
        TRY(be_ready_to_write(database));
    TRY(check_schema(database));
    if (access == Catalogue::Access::kWrite && !in_memory)
        TRY(check_structure(database));
    return database;
}

} // namespace dicot

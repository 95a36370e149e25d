#include "database.h"

#include "dicot/base/printable.h"
#include "dicot/os/shown_path.h"

#include <utility>

namespace dicot {
namespace {

constexpr const char* kRemedy = "dicot verify --repair makes it again from the folders";

} // namespace

Database::Database(Database&& other) noexcept
    : connection_(std::exchange(other.connection_, nullptr)), path_(std::move(other.path_))
{
}

Database::~Database()
{
    sqlite3_close_v2(connection_);
}

Status Database::run(const char* sql) const
{
    const int code = sqlite3_exec(connection_, sql, nullptr, nullptr, nullptr);
    return code == SQLITE_OK ? Status{} : failed(code);
}

Status Database::damaged(const char* what) const
{
    return failure(Fault::kBadData, "%s: not a catalogue that can be used (%s): %s", shown_path(path()),
                   printable<120>(what).c_str(), kRemedy);
}

Status Database::failed(int code) const
{
    const char* const where = shown_path(path());
    const ShortText<120> why =
        printable<120>(connection_ != nullptr ? sqlite3_errmsg(connection_) : sqlite3_errstr(code));
    if (code == SQLITE_IOERR_NOMEM)
        code = SQLITE_NOMEM;
    switch (code & 0xFF) {
    case SQLITE_NOMEM:
        return failure(Fault::kOsError, "%s: the catalogue's memory is used up: ask for fewer rows, or close others",
                       where);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return failure(Fault::kTryAgain, "%s: another process writes to it: try again", where);
    case SQLITE_FULL:
        return failure(Fault::kIoError, "%s: the card is full: dicot prune makes room", where);
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_AUTH:
        return failure(Fault::kIoError, "%s: it may not be written: the card, or the file, is read-only", where);
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_PROTOCOL:
    case SQLITE_NOLFS:
        return failure(Fault::kIoError, "%s: the card failed (%s): look at it, or take another one", where,
                       why.c_str());
    case SQLITE_CONSTRAINT:
    case SQLITE_MISUSE:
    case SQLITE_RANGE:
        return failure(Fault::kSoftware, "%s: a row that no catalogue takes (%s)", where, why.c_str());
    default: // corrupt, not a database, a schema that cannot be read, text that is too long, ...
        return damaged(why.c_str());
    }
}

} // namespace dicot

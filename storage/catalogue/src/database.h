// A connection of SQLite, and its errors as sentences.
#pragma once

#include "dicot/base/status.h"

#include <sqlite3.h>

#include <string>

namespace dicot {

class Database
{
public:
    Database(sqlite3* connection, std::string path) : connection_(connection), path_(std::move(path)) {}
    Database(Database&& other) noexcept;
    Database& operator=(Database&&) = delete;
    ~Database();

    sqlite3* connection() const { return connection_; }
    const char* path() const { return path_.c_str(); }

    /// Statements that give no row, or whose rows do not matter.
    Status run(const char* sql) const;
    /// What SQLite's `code` means for a person: Fault::kBadData (damaged), kIoError (the card), kTryAgain (in use),
    /// kOsError (the heap is full), kSoftware.
    Status failed(int code) const;
    /// Fault::kBadData with its remedy.
    Status damaged(const char* what) const;

private:
    sqlite3* connection_;
    std::string path_;
};

} // namespace dicot

// One prepared statement.
#pragma once

#include "database.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace dicot {

/// Columns count from 0, parameters from 1. The database outlives it.
class Statement
{
public:
    static Result<Statement> prepare(const Database& database, const char* sql, bool for_long = false);
    Statement(Statement&& other) noexcept
        : database_(other.database_), statement_(std::exchange(other.statement_, nullptr)), code_(other.code_)
    {
    }
    Statement& operator=(Statement&&) = delete;
    ~Statement();

    void bind(int parameter, std::int64_t number);
    void bind(int parameter, std::optional<std::int64_t> number);
    void bind_text(int parameter, std::string_view text);                 ///< that lives until the end of the steps
    void bind_bytes(int parameter, std::span<const unsigned char> bytes); ///< the same; none: NULL

    /// Whether there is a row. Faults of bind() come out here.
    Result<bool> step();
    /// Ready for other parameters; locks that it held are free.
    void reset();

    bool is_null(int column) const;
    /// Nothing when a value of another type stands there.
    std::optional<std::int64_t> number(int column) const;
    std::optional<std::string_view> text(int column) const; ///< until the next step
    std::optional<std::span<const unsigned char>> bytes(int column) const;

private:
    Statement(const Database& database, sqlite3_stmt* statement) : database_(&database), statement_(statement) {}
    void keep(int code);

    const Database* database_;
    sqlite3_stmt* statement_;
    int code_ = SQLITE_OK; ///< first fault of bind()
};

} // namespace dicot

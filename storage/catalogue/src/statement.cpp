#include "statement.h"

namespace dicot {

Result<Statement> Statement::prepare(const Database& database, const char* sql, bool for_long)
{
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v3(database.connection(), sql, -1, for_long ? SQLITE_PREPARE_PERSISTENT : 0,
                                        &statement, nullptr);
    if (code != SQLITE_OK)
        return database.failed(code);
    return Statement{database, statement};
}

Statement::~Statement()
{
    sqlite3_finalize(statement_);
}

void Statement::keep(int code)
{
    if (code_ == SQLITE_OK)
        code_ = code;
}

void Statement::bind(int parameter, std::int64_t number)
{
    keep(sqlite3_bind_int64(statement_, parameter, number));
}

void Statement::bind(int parameter, std::optional<std::int64_t> number)
{
    keep(number ? sqlite3_bind_int64(statement_, parameter, *number) : sqlite3_bind_null(statement_, parameter));
}

void Statement::bind_text(int parameter, std::string_view text)
{
    keep(sqlite3_bind_text(statement_, parameter, text.data(), static_cast<int>(text.size()), nullptr));
}

void Statement::bind_bytes(int parameter, std::span<const unsigned char> bytes)
{
    keep(bytes.empty()
             ? sqlite3_bind_null(statement_, parameter)
             : sqlite3_bind_blob(statement_, parameter, bytes.data(), static_cast<int>(bytes.size()), nullptr));
}

Result<bool> Statement::step()
{
    if (code_ != SQLITE_OK)
        return database_->failed(code_);
    const int code = sqlite3_step(statement_);
    if (code == SQLITE_ROW)
        return true;
    if (code == SQLITE_DONE)
        return false;
    return database_->failed(code);
}

void Statement::reset()
{
    sqlite3_reset(statement_);
    code_ = SQLITE_OK;
}

bool Statement::is_null(int column) const
{
    return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

std::optional<std::int64_t> Statement::number(int column) const
{
    if (sqlite3_column_type(statement_, column) != SQLITE_INTEGER)
        return {};
    return sqlite3_column_int64(statement_, column);
}

std::optional<std::string_view> Statement::text(int column) const
{
    if (sqlite3_column_type(statement_, column) != SQLITE_TEXT)
        return {};
    const unsigned char* const text = sqlite3_column_text(statement_, column); // null: no memory
    if (text == nullptr)
        return {};
    return std::string_view{reinterpret_cast<const char*>(text),
                            static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::optional<std::span<const unsigned char>> Statement::bytes(int column) const
{
    if (sqlite3_column_type(statement_, column) != SQLITE_BLOB)
        return {};
    const auto* const bytes = static_cast<const unsigned char*>(sqlite3_column_blob(statement_, column));
    return std::span{bytes, bytes != nullptr ? static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)) : 0};
}

} // namespace dicot

// The outcome of whatever can fail: a value that nobody can drop.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <new>
#include <type_traits>
#include <utility>

namespace dicot {

/// Why something failed. The numbers are the process exit codes of sysexits(3); `kOk` is 0.
enum class Fault : int
{
    kOk = 0,
    kUsage = 64,        ///< the call's words are wrong
    kBadData = 65,      ///< an input file is damaged, or does not fit the other inputs
    kNoInput = 66,      ///< an input file is missing or cannot be read
    kUnavailable = 69,  ///< a device or a service is not there
    kSoftware = 70,     ///< a fault of dicot itself
    kOsError = 71,      ///< the operating system refused (memory, threads)
    kCannotCreate = 73, ///< an output file cannot be created
    kIoError = 74,      ///< reading or writing failed half-way (full disk, dead card)
    kTryAgain = 75,     ///< a passing fault: the same call may succeed later
    kConfig = 78,       ///< the configuration is wrong, or asks for more than the budget
};

/// A fault and one sentence for a person: what went wrong, with which file, and the remedy. No heap.
class [[nodiscard]] Status
{
public:
    static constexpr int kMessageBytes = 400;

    Status() noexcept = default;

    bool ok() const noexcept { return fault_ == Fault::kOk; }
    Fault fault() const noexcept { return fault_; }
    int exit_code() const noexcept { return static_cast<int>(fault_); }
    const char* message() const noexcept { return message_; }

    friend Status failure(Fault fault, const char* format, ...) noexcept __attribute__((format(printf, 2, 3)));

private:
    Fault fault_ = Fault::kOk;
    char message_[kMessageBytes] = {};
};

/// A failed Status with a printf-formatted sentence; what is longer than Status::kMessageBytes is cut.
inline Status failure(Fault fault, const char* format, ...) noexcept
{
    Status status;
    status.fault_ = fault;
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(status.message_, sizeof status.message_, format, arguments);
    va_end(arguments);
    return status;
}

/// Either a T or the Status that says why there is none.
template <typename T>
class [[nodiscard]] Result
{
    static_assert(!std::is_reference_v<T> && !std::is_same_v<T, Status>);

public:
    Result(T value) noexcept(std::is_nothrow_move_constructible_v<T>) // NOLINT(google-explicit-constructor)
    {
        ::new (static_cast<void*>(&value_)) T(std::move(value));
    }
    Result(const Status& why) noexcept : status_(why) // NOLINT(google-explicit-constructor)
    {
        if (status_.ok())
            status_ = failure(Fault::kSoftware, "a Result was made from a Status that is ok");
    }
    Result(Result&& other) noexcept(std::is_nothrow_move_constructible_v<T>) : status_(other.status_)
    {
        if (ok())
            ::new (static_cast<void*>(&value_)) T(std::move(other.value_));
    }
    Result(const Result&) = delete;
    Result& operator=(const Result&) = delete;
    Result& operator=(Result&&) = delete;
    ~Result()
    {
        if (ok())
            value_.~T();
    }

    bool ok() const noexcept { return status_.ok(); }
    const Status& status() const noexcept { return status_; }
    T& value() & noexcept { return value_; }
    const T& value() const& noexcept { return value_; }
    T&& value() && noexcept { return std::move(value_); }

private:
    Status status_;
    union {
        T value_;
    };
};

namespace detail {
inline const Status& status_of(const Status& status)
{
    return status;
}
template <typename T>
const Status& status_of(const Result<T>& result)
{
    return result.status();
}
inline void value_of(Status&&) {}
template <typename T>
T value_of(Result<T>&& result)
{
    return std::move(result).value();
}
} // namespace detail

} // namespace dicot

/// Evaluates a Status or Result; on failure returns its Status from the enclosing function, else yields the value.
#define TRY(expression)                                                                                                \
    __extension__({                                                                                                    \
        auto dicot_outcome = (expression);                                                                             \
        if (!dicot_outcome.ok())                                                                                       \
            return ::dicot::detail::status_of(dicot_outcome);                                                          \
        ::dicot::detail::value_of(std::move(dicot_outcome));                                                           \
    })

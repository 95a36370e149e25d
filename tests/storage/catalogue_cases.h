// Rows for tests, each another one, and other processes that do something with catalogues.
#pragma once

#include "dicot/catalogue/catalogue.h"

#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace dicot::test {

constexpr std::int64_t kDayUs = 86'400'000'000;
constexpr std::int64_t kFirstDayUs = 1'780'272'000'000'000; // 2026-06-01T00:00:00Z

/// Two hours apart, every seventh one missed.
inline SlotRow slot_row(std::int64_t sequence)
{
    SlotRow row;
    row.sequence = sequence;
    row.began_us = kFirstDayUs + sequence * kDayUs / 12;
    row.due_us = row.began_us - 1;
    row.done = sequence % 7 != 0;
    row.clock_trust = "network";
    if (row.done) {
        row.points = 170'000 + sequence % 1000;
        row.bytes = 700'000 + sequence % 5000;
        std::string digits(64, '0');
        for (std::size_t i = 0; i < digits.size(); ++i)
            digits[i] = "0123456789abcdef"[(static_cast<std::size_t>(sequence) * 31 + i * i) % 16];
        row.sums = std::string_view{digits};
    } else {
        row.reason = "the left camera, port 1-1.2, gave no picture in 10 s: look at its cable";
        row.bytes = 900;
    }
    return row;
}

/// All rows in one transaction, as far as `into`.
inline Status put_rows(Catalogue& catalogue, std::int64_t from, std::int64_t into)
{
    TRY(catalogue.begin());
    for (std::int64_t i = from; i <= into; ++i)
        TRY(catalogue.put(slot_row(i)));
    return catalogue.commit();
}

/// `child` in a process of its own: its exit code, or the signal that ended it, negative.
template <typename Child>
int run_apart(Child child)
{
    const pid_t pid = fork();
    if (pid == 0)
        _exit(child());
    int status = 0;
    waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// A catalogue of so many rows, closed. Whether it worked.
inline bool make_catalogue(const std::string& path, std::int64_t rows)
{
    const auto catalogue = Catalogue::open(path, Catalogue::Access::kWrite);
    return catalogue.ok() && put_rows(*catalogue.value(), 1, rows).ok();
}

} // namespace dicot::test

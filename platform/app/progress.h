// How far a long piece of work has come: a line on a terminal, nothing in a pipe.
#pragma once

#include <atomic>
#include <cstdint>

namespace dicot::app {

class Progress
{
public:
    /// `what` names the work, e.g. "matching".
    explicit Progress(const char* what) noexcept;
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() { wipe(); }

    /// Wipes the line, for something else to be printed; the next done() draws it again.
    void wipe() noexcept;

    /// May be called from any thread; draws at most ten times a second.
    void done(int part, int all) noexcept;

    /// For hooks that take a plain function: `context` is the Progress.
    static void rows_done(void* context, int rows, int all) { static_cast<Progress*>(context)->done(rows, all); }

private:
    const char* what_;
    bool terminal_;
    std::int64_t start_us_;
    std::atomic<std::int64_t> next_us_;
    std::atomic<bool> drawn_{false};
};

} // namespace dicot::app

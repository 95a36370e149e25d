// How far each board's pull has come: a line a board on a terminal, now and then a sentence elsewhere.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace dicot::app {

/// Everything may be called from any thread.
class PullScreen
{
public:
    PullScreen() noexcept;
    PullScreen(const PullScreen&) = delete;
    PullScreen& operator=(const PullScreen&) = delete;
    ~PullScreen();

    /// A board's line. `snapshots`: that are looked at, of which `fresh` are new; `bytes`: of these, 0: nobody knows.
    int begin(const std::string& board, std::int64_t snapshots, std::int64_t fresh, std::uint64_t bytes);
    void arrived(int line, std::uint64_t bytes);
    void one_done(int line);
    void end(int line);
    /// A sentence on stderr, above the lines.
    void say(const std::string& sentence);

private:
    struct Line
    {
        std::string board;
        std::int64_t done = 0, all = 0;
        std::uint64_t bytes_done = 0, bytes_all = 0;
        std::int64_t start_us = 0;
        std::int64_t said_us = 0; ///< elsewhere than on a terminal
        bool ended = false;
    };
    static std::string words_of(const Line& line, std::int64_t now_us);
    void wipe();
    void draw(std::int64_t now_us);
    void tell(Line& line);

    std::mutex mutex_;
    bool terminal_;
    std::vector<Line> lines_;
    std::size_t drawn_ = 0; ///< lines on the terminal
    std::int64_t next_us_ = 0;
};

/// "45 s", "3 min 20 s", "2 h 5 min".
std::string shown_time_left(double seconds);

} // namespace dicot::app

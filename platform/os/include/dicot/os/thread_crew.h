// A Crew of threads that are made once.
#pragma once

#include "dicot/base/status.h"
#include "dicot/base/work.h"

#include <pthread.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace dicot {

/// Threads that sleep until run() has tasks for them. The thread that calls run() works too, so a crew of n makes
/// n - 1 threads. run() allocates nothing; it is called by one thread at a time and never from inside a task.
class ThreadCrew final : public Crew
{
public:
    static constexpr int kMaxThreads = 64;
    static constexpr std::size_t kStackBytes = std::size_t{256} * 1024;

    /// A crew of `threads`, clamped to 1 .. kMaxThreads.
    explicit ThreadCrew(int threads) noexcept;
    ThreadCrew(const ThreadCrew&) = delete;
    ThreadCrew& operator=(const ThreadCrew&) = delete;
    ~ThreadCrew() override;

    /// Fault::kOsError when the system refused a thread; the crew then works with the size() that it has.
    const Status& started() const noexcept { return started_; }

    int size() const override { return helpers_ + 1; }
    void run(int count, TaskRef task) override;

    /// Processors that this process may run on, at least 1.
    static int processors() noexcept;

private:
    static void* serve(void* crew) noexcept;
    void serve_until_dismissed() noexcept;
    void work_off(const TaskRef& task, int count) noexcept;

    std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable done_;
    const TaskRef* task_ = nullptr; ///< null while there is no work
    int count_ = 0;
    std::uint64_t round_ = 0;
    int busy_ = 0;
    bool dismissed_ = false;
    std::atomic<int> next_{0};

    int helpers_ = 0;
    std::array<pthread_t, kMaxThreads - 1> threads_{};
    Status started_;
};

} // namespace dicot

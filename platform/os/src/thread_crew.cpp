#include "dicot/os/thread_crew.h"

#include <algorithm>
#include <cassert>
#include <climits>
#include <cstring>

#include <sched.h>

namespace dicot {

ThreadCrew::ThreadCrew(int threads) noexcept
{
    const int wanted = std::clamp(threads, 1, kMaxThreads) - 1;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes,
                              std::max<std::size_t>(kStackBytes, static_cast<std::size_t>(PTHREAD_STACK_MIN)));
    while (helpers_ < wanted) {
        const int error = pthread_create(&threads_[static_cast<std::size_t>(helpers_)], &attributes, &serve, this);
        if (error != 0) {
            started_ = failure(Fault::kOsError, "the system gives %d of %d threads (%s); ask for fewer threads",
                               helpers_ + 1, wanted + 1, strerrordesc_np(error));
            break;
        }
        ++helpers_;
    }
    pthread_attr_destroy(&attributes);
}

ThreadCrew::~ThreadCrew()
{
    {
        const std::lock_guard lock(mutex_);
        dismissed_ = true;
    }
    wake_.notify_all();
    for (int i = 0; i < helpers_; ++i)
        pthread_join(threads_[static_cast<std::size_t>(i)], nullptr);
}

void ThreadCrew::run(int count, TaskRef task)
{
    if (count <= 0)
        return;
    assert(count <= INT_MAX - kMaxThreads); // each thread draws one number beyond the last
    if (helpers_ == 0 || count == 1) {
        for (int i = 0; i < count; ++i)
            task(i);
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        assert(task_ == nullptr);
        task_ = &task;
        count_ = count;
        next_.store(0, std::memory_order_relaxed);
        ++round_;
    }
    wake_.notify_all();
    work_off(task, count);

    // Every task is taken. A thread that wakes from here on finds no work; those at work are waited for.
    std::unique_lock lock(mutex_);
    task_ = nullptr;
    done_.wait(lock, [this] { return busy_ == 0; });
}

void ThreadCrew::work_off(const TaskRef& task, int count) noexcept
{
    for (int i = next_.fetch_add(1, std::memory_order_relaxed); i < count;
         i = next_.fetch_add(1, std::memory_order_relaxed))
        task(i);
}

void* ThreadCrew::serve(void* crew) noexcept
{
    static_cast<ThreadCrew*>(crew)->serve_until_dismissed();
    return nullptr;
}

void ThreadCrew::serve_until_dismissed() noexcept
{
    std::uint64_t served = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [&] { return dismissed_ || (task_ != nullptr && round_ != served); });
        if (dismissed_)
            return;
        served = round_;
        const TaskRef& task = *task_;
        const int count = count_;
        ++busy_;
        lock.unlock();
        work_off(task, count);
        lock.lock();
        if (--busy_ == 0)
            done_.notify_one();
    }
}

int ThreadCrew::processors() noexcept
{
    cpu_set_t mine;
    CPU_ZERO(&mine);
    if (sched_getaffinity(0, sizeof mine, &mine) != 0)
        return 1;
    return std::max(1, CPU_COUNT(&mine));
}

} // namespace dicot

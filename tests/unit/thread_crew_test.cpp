#include "dicot/os/thread_crew.h"

#include <gtest/gtest.h>

#include <barrier>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace dicot {
namespace {

TEST(ThreadCrew, EveryTaskRunsExactlyOnceInEveryRound)
{
    for (const int threads : {1, 2, 3, 7}) {
        ThreadCrew crew{threads};
        ASSERT_TRUE(crew.started().ok()) << crew.started().message();
        EXPECT_EQ(crew.size(), threads);
        for (int round = 0; round < 400; ++round) {
            const int count = round % 23;
            std::vector<int> runs(static_cast<std::size_t>(count),
                                  0); // plain ints: run() itself must order the accesses
            crew.run(count, [&](int index) { ++runs[static_cast<std::size_t>(index)]; });
            EXPECT_EQ(runs, std::vector<int>(static_cast<std::size_t>(count), 1))
                << threads << " threads, round " << round;
        }
    }
}

TEST(ThreadCrew, AsManyTasksAsItsSizeRunAtTheSameTime)
{
    ThreadCrew crew{4};
    std::barrier all_here{4}; // opens only when four tasks stand at it together
    std::set<std::thread::id> seen;
    std::mutex mutex;
    crew.run(4, [&](int) {
        all_here.arrive_and_wait();
        const std::lock_guard lock(mutex);
        seen.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(seen.size(), 4U);
    EXPECT_TRUE(seen.contains(std::this_thread::get_id()));
}

TEST(ThreadCrew, UnevenTasksAreAllDoneWhenRunReturns)
{
    ThreadCrew crew{3};
    std::vector<unsigned> sums(50, 0);
    crew.run(50, [&](int index) {
        for (unsigned i = 0; i < static_cast<unsigned>(index) * 1000; ++i)
            sums[static_cast<std::size_t>(index)] += i;
    });
    for (unsigned index = 0; index < 50; ++index) {
        const unsigned n = index * 1000;
        EXPECT_EQ(sums[index], n == 0 ? 0 : n * (n - 1) / 2) << index;
    }
}

TEST(ThreadCrew, SizeIsClampedAndADismissedCrewNeedsNoWork)
{
    EXPECT_EQ(ThreadCrew{0}.size(), 1);
    EXPECT_EQ(ThreadCrew{-5}.size(), 1);
    EXPECT_LE(ThreadCrew{1000}.size(), ThreadCrew::kMaxThreads);
    EXPECT_GE(ThreadCrew::processors(), 1);
}

} // namespace
} // namespace dicot

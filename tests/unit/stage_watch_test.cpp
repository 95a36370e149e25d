// The watch over the stages of a slot, with real sockets, timers and processes that are killed.
#include "dicot/os/service_notice.h"
#include "dicot/os/stage_watch.h"

#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dicot {
namespace {

using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::MatchesRegex;

/// The supervisor's end, and what the environment says of it for as long as it lives.
class Supervisor
{
public:
    explicit Supervisor(const std::string& name, const char* watchdog_us = nullptr)
    {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        name.copy(address.sun_path, sizeof address.sun_path - 1);
        if (name[0] == '@')
            address.sun_path[0] = '\0';
        const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size() + (name[0] != '@'));
        bound_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), bytes) == 0;
        ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
        if (watchdog_us != nullptr)
            ::setenv("WATCHDOG_USEC", watchdog_us, 1);
    }
    Supervisor(const Supervisor&) = delete;
    Supervisor& operator=(const Supervisor&) = delete;
    ~Supervisor()
    {
        ::close(socket_);
        for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"})
            ::unsetenv(name);
    }

    bool bound() const { return bound_; }
    std::vector<std::string> heard() const
    {
        std::vector<std::string> words;
        char bytes[512];
        while (true) {
            const ssize_t count = ::recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT);
            if (count < 0)
                return words;
            words.emplace_back(bytes, static_cast<std::size_t>(count));
        }
    }

private:
    int socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    bool bound_ = false;
};

void pause_ms(int ms)
{
    ::usleep(static_cast<useconds_t>(ms) * 1000);
}

TEST(ServiceNotice, ReachesAPathAndAnAbstractName)
{
    const TempFolder folder;
    for (const std::string& name : {folder.path("notify"), "@dicot-test-" + std::to_string(::getpid())}) {
        const Supervisor supervisor{name, "180000000"};
        ASSERT_TRUE(supervisor.bound());
        ServiceNotice notice;
        ASSERT_TRUE(notice.open().ok());
        EXPECT_EQ(notice.most_silence_us(), 180'000'000);
        notice.ready();
        notice.status("slot 17\nWATCHDOG=trigger");
        notice.alive();
        notice.stopping();
        EXPECT_THAT(supervisor.heard(),
                    ElementsAre("READY=1", "STATUS=slot 17 WATCHDOG=trigger", "WATCHDOG=1", "STOPPING=1"));
    }
}

TEST(ServiceNotice, AsksASupervisorThatWatchesToBearASleepAndThenTakesItBack)
{
    const TempFolder folder;
    for (const char* const watchdog_us : {"180000000", static_cast<const char*>(nullptr)}) {
        const Supervisor supervisor{folder.path(watchdog_us != nullptr ? "watches" : "does-not"), watchdog_us};
        ServiceNotice notice;
        ASSERT_TRUE(notice.open().ok());
        notice.bear(600'000'000);
        notice.bear(0);
        const std::vector<std::string> heard = supervisor.heard();
        if (watchdog_us != nullptr)
            EXPECT_THAT(heard, ElementsAre("WATCHDOG_USEC=780000000", "WATCHDOG_USEC=180000000"));
        else
            EXPECT_TRUE(heard.empty());
    }
}

TEST(ServiceNotice, IsSilentWithoutASupervisor)
{
    ServiceNotice notice;
    ASSERT_TRUE(notice.open().ok());
    EXPECT_FALSE(notice.connected());
    notice.ready();
}

TEST(ServiceNotice, RefusesANameThatNoSocketHas)
{
    for (const std::string& name : {std::string{"vsock:2:1"}, std::string{"/"}, "/" + std::string(200, 'a')}) {
        const Supervisor supervisor{name};
        ServiceNotice notice;
        EXPECT_EQ(notice.open().fault(), Fault::kConfig) << name;
    }
}

TEST(ServiceNotice, TakesTheWatchOfAnotherProcessForNone)
{
    const Supervisor supervisor{"@dicot-test-pid", "5000000"};
    ::setenv("WATCHDOG_PID", "1", 1);
    ServiceNotice notice;
    ASSERT_TRUE(notice.open().ok());
    EXPECT_EQ(notice.most_silence_us(), 0);
}

TEST(StageWatch, FeedsByProgressAloneAndAtMostOnceASecond)
{
    const TempFolder folder;
    const Supervisor supervisor{folder.path("notify"), "9000000"};
    {
        StageWatch watch;
        ASSERT_TRUE(watch.open({}).ok());
        EXPECT_EQ(watch.most_silence_us(), 3'000'000) << "a third of what the supervisor bears";
        EXPECT_THAT(supervisor.heard(), ElementsAre("WATCHDOG=1"));
        for (int i = 0; i < 100; ++i)
            StageWatch::progress();
        EXPECT_THAT(supervisor.heard(), ElementsAre());
        pause_ms(1100);
        EXPECT_THAT(supervisor.heard(), ElementsAre()) << "nobody but progress feeds";
        StageWatch::progress();
        EXPECT_THAT(supervisor.heard(), ElementsAre("WATCHDOG=1"));
    }
    EXPECT_THAT(supervisor.heard(), ElementsAre("STOPPING=1"));
}

TEST(StageWatch, StarvesTheWatchdogsOnceAStageIsPastItsBound)
{
    const TempFolder folder;
    const Supervisor supervisor{folder.path("notify")};
    StageWatch watch;
    ASSERT_TRUE(watch.open({}).ok());
    StageWatch::slot(17, 0);
    StageWatch::enter("match", 900'000);
    EXPECT_FALSE(StageWatch::overrun());
    EXPECT_TRUE(StageWatch::what_overran().empty());
    (void)supervisor.heard();
    pause_ms(1100);
    bool (*const asked)() noexcept = StageWatch::overrun;
    EXPECT_TRUE(asked());
    StageWatch::progress();
    EXPECT_THAT(supervisor.heard(), ElementsAre());
    EXPECT_EQ(StageWatch::what_overran().view(), "stage match is past its bound: 1 s of 0 s");
    StageWatch::enter("commit", 60'000'000);
    EXPECT_FALSE(StageWatch::overrun());
    EXPECT_THAT(StageWatch::what_overran().c_str(), HasSubstr("stage match")) << "kept until the next slot";
    StageWatch::slot(18, 0);
    EXPECT_TRUE(StageWatch::what_overran().empty());
}

TEST(StageWatch, IsOneAtATimeAndItsWordsDoNothingWithoutOne)
{
    StageWatch::enter("match", 1);
    StageWatch::progress();
    EXPECT_FALSE(StageWatch::overrun());
    StageWatch first;
    ASSERT_TRUE(first.open({}).ok());
    StageWatch second;
    EXPECT_EQ(second.open({}).fault(), Fault::kSoftware);
}

TEST(StageWatch, FeedsItsSupervisorThoughTheStageFileCannotBeMade)
{
    const TempFolder folder;
    const Supervisor supervisor{folder.path("notify")};
    StageWatchRules rules;
    rules.stage_file = "/nowhere/stage";
    StageWatch watch;
    EXPECT_EQ(watch.open(rules).fault(), Fault::kCannotCreate);
    watch.ready();
    StageWatch::enter("match", 1);
    EXPECT_THAT(supervisor.heard(), ElementsAre("WATCHDOG=1", "READY=1"));
    pause_ms(2);
    EXPECT_TRUE(StageWatch::overrun());
}

TEST(StageWatch, WorksWithoutADeviceThatIsNotThere)
{
    const TempFolder folder;
    const std::string device = folder.path("watchdog");
    StageWatchRules rules;
    rules.device = device.c_str();
    StageWatch watch;
    ASSERT_TRUE(watch.open(rules).ok());
    EXPECT_EQ(watch.device_trouble().fault(), Fault::kUnavailable);
}

/// A child that runs `work` with a watch, its standard error in `said`; how it ended.
template <typename Work>
int child(std::string& said, const std::string& stage_file, Work work)
{
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
        return -1;
    const pid_t pid = ::fork();
    if (pid == 0) {
        ::dup2(ends[1], STDERR_FILENO);
        StageWatchRules rules;
        rules.stage_file = stage_file.c_str();
        rules.grace_us = 200'000;
        StageWatch watch;
        if (watch.open(rules).ok())
            work(ends[1]);
        ::_exit(99);
    }
    ::close(ends[1]);
    char bytes[512];
    bool killed = false;
    for (ssize_t count = 0; (count = ::read(ends[0], bytes, sizeof bytes)) > 0;) {
        said.append(bytes, static_cast<std::size_t>(count));
        if (!killed && said.ends_with("kill me")) {
            killed = true;
            ::kill(pid, SIGKILL);
        }
    }
    ::close(ends[0]);
    int status = -1;
    ::waitpid(pid, &status, 0);
    return status;
}

TEST(StageWatch, EndsAProgramWhoseStageDoesNotHear)
{
    const TempFolder folder;
    std::string said;
    const int status = child(said, folder.path("stage"), [](int) {
        StageWatch::slot(17, 1'780'000'000'000'000);
        StageWatch::enter("match", 100'000);
        for (volatile bool deaf = true; deaf;) {
        }
    });
    ASSERT_TRUE(WIFEXITED(status)) << status;
    EXPECT_EQ(WEXITSTATUS(status), 70);
    EXPECT_THAT(said, MatchesRegex("(<2>)?dicot: stage match does not end: 0 s, its bound is 0 s; the program ends "
                                   "itself, for its supervisor to start it again\n"));
    const auto left = StageFile::read(folder.path("stage").c_str());
    ASSERT_TRUE(left.ok() && left.value());
    EXPECT_TRUE(left.value()->over_bound());
    EXPECT_GE(left.value()->lasted_us, 300'000);
}

TEST(StageWatch, DoesNotEndAStageThatHears)
{
    const TempFolder folder;
    std::string said;
    const int status = child(said, folder.path("stage"), [](int) {
        StageWatch::enter("match", 100'000);
        while (!StageWatch::overrun())
            pause_ms(10);
        StageWatch::leave();
        pause_ms(400); // longer than the grace
        ::_exit(0);
    });
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    EXPECT_EQ(said, "");
}

TEST(StageFile, SaysWhatAKilledProcessWasAt)
{
    const TempFolder folder;
    const std::string file = folder.path("stage");
    std::string said;
    const int status = child(said, file, [](int to) {
        StageWatch::slot(3'000'000'017, 1'780'000'000'000'000);
        StageWatch::enter("shoot", 60'000'000);
        StageWatch::enter("match", 312'000'000);
        pause_ms(1100);
        StageWatch::progress();
        (void)!::write(to, "kill me", 7);
        pause_ms(60'000);
    });
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
    StageWatchRules rules;
    rules.stage_file = file.c_str();
    {
        StageWatch next;
        ASSERT_TRUE(next.open(rules).ok());
        ASSERT_TRUE(next.previous());
        EXPECT_EQ(next.previous()->stage.view(), "match");
        EXPECT_EQ(next.previous()->slot, 3'000'000'017U);
        EXPECT_EQ(next.previous()->due_us, 1'780'000'000'000'000);
        EXPECT_EQ(next.previous()->bound_us, 312'000'000);
        EXPECT_GE(next.previous()->lasted_us, 1'100'000);
        EXPECT_LT(next.previous()->lasted_us, 60'000'000);
        EXPECT_FALSE(next.previous()->over_bound());
        EXPECT_EQ(words_of(*next.previous()).view(), "stage match, after 1 s");
        StageFile second;
        EXPECT_EQ(second.open(file.c_str()).fault(), Fault::kTryAgain) << "one process at a time";
    }
    const auto ended_in_order = StageFile::read(file.c_str());
    ASSERT_TRUE(ended_in_order.ok());
    EXPECT_FALSE(ended_in_order.value());
}

TEST(StageFile, PassesOverAnEntryThatIsNotWhole)
{
    const TempFolder folder;
    const std::string path = folder.path("stage");
    const auto write_two = [&] {
        StageFile file;
        ASSERT_TRUE(file.open(path.c_str()).ok());
        StageEntry entry;
        entry.stage = "first";
        file.write(entry);
        entry.stage = "second";
        file.write(entry);
    };
    write_two();
    const test::Bytes whole = test::bytes_of(path);
    int firsts = 0, nones = 0;
    for (std::size_t place = 0; place < 320; ++place) {
        test::Bytes damaged = whole;
        damaged[place] = static_cast<std::uint8_t>(damaged[place] ^ 0x20U);
        folder.write("stage", damaged);
        const auto read = StageFile::read(path.c_str());
        ASSERT_TRUE(read.ok());
        const std::string_view stage = read.value() ? read.value()->stage.view() : "";
        EXPECT_TRUE(stage == "second" || stage == "first" || stage.empty()) << place;
        firsts += stage == "first";
        nones += stage.empty();
    }
    EXPECT_GT(firsts, 80) << "damage of the second entry leaves the first";
    EXPECT_EQ(nones, 16) << "damage of the mark leaves none";
    folder.write("stage", std::string(100, 'x'));
    EXPECT_FALSE(StageFile::read(path.c_str()).value());
    EXPECT_EQ(StageFile::read(folder.path("none").c_str()).status().fault(), Fault::kNoInput);
}

TEST(StageFile, OfAnotherBootSaysNothing)
{
    const TempFolder folder;
    const std::string path = folder.path("stage");
    {
        StageFile file;
        ASSERT_TRUE(file.open(path.c_str()).ok());
        StageEntry entry;
        entry.stage = "match";
        file.write(entry);
    }
    ASSERT_TRUE(StageFile::read(path.c_str()).value());
    // The same entry with the name of another boot, and a checksum that is right, as a card brings it after a power
    // cut.
    test::Bytes bytes = test::bytes_of(path);
    const std::string text{bytes.begin(), bytes.end()};
    const std::size_t boot = text.find("match") - 40;
    bytes[boot] = bytes[boot] == 'a' ? 'b' : 'a';
    std::uint32_t crc = 0xFFFFFFFF;
    for (std::size_t i = boot; i < boot + 40 + 32 + 24; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    crc = ~crc;
    for (std::size_t i = 0; i < 4; ++i)
        bytes[boot - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
    folder.write("stage", bytes);
    EXPECT_FALSE(StageFile::read(path.c_str()).value());
}

} // namespace
} // namespace dicot
